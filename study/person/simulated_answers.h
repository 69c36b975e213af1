#pragma once

#include <cstdint>
#include <vector>

#include "study/questionnaire/definition.h"

namespace passung::person {

/// What was rendered in the trials that a form asks about, each from 0 (nothing) to 1. A half where there was no trial.
struct Experience {
    double force = 0.5;    // F / (F + 5 N), F: mean force in contact
    double time = 0.5;     // t / (t + 10 s), t: mean time of a trial
    double failure = 0.5;  // share of trials without success
    double depth = 0.5;    // d / (d + 2 mm), d: mean depth of the hand in the parts
};

/// The experience of a mean force [N], time [s], share of failures and depth [m].
Experience experienceOf(double force, double time, double failure, double depth);

/// How somebody uses rating scales: a trait of the person, proposed here like all traits of simulated people.
struct RatingStyle {
    double extremity = 1.0;  // 1: as meant, more: nearer to the scale's ends; log-normal about 1 with 0.25
    double leaning = 0.0;    // added to every rating, in parts of the scale; normal about 0 with 0.08
    double noise = 0.06;     // of a rating, standard deviation in parts of the scale
};

/// The style of this stream seed; same seed, same style.
RatingStyle drawRatingStyle(std::uint64_t seed);

/// An answer for each item, given in `order`. With u what the item's `felt` names of the experience (Success and
/// Hardness: 1 - Failure, 1 - Depth; 0.5 for an item that names nothing):
/// - a rating stands at 0.5 + extremity · (u - 0.5) + leaning + noise · normal of the scale, kept inside, on the
/// nearest
///   step (of a hundred where any value is admissible);
/// - of a pair wins what was rated higher; equal or unrated ones are tossed for;
/// - a number or one of the options is any of them alike; a text is left out.
/// Software that is fed with these works; nothing about people follows from them.
std::vector<questionnaire::Answer> answerItems(const questionnaire::Definition& definition,
                                               const std::vector<std::size_t>& order, const Experience& experience,
                                               const RatingStyle& style, std::uint64_t seed);

}  // namespace passung::person
