#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "analysis/truth/pair_truth.h"

namespace passung::truth {

inline constexpr const char* kApproach = "approach";  // first phase of a path

/// A pose and what is true there.
struct JudgedPose {
    Pose X_FS;
    PoseTruth truth;
    const char* phase = "given";  // of a path: kApproach, "pressed", "slide"
};

enum class Truth { Whole, Quick };  // PairTruth::at, PairTruth::quicklyAt

/// Told how much is done, 0 … 1. Called from several threads, never two at a time.
using ProgressReport = std::function<void(double)>;

/// Poses along `paths` paths on which SHELL comes to FIELD, touches it, is pressed in and slides. Even paths begin far
/// outside, by turns with SHELL turned at random and with the parts' frames nearly parallel. Odd ones begin inside
/// FIELD's box where SHELL is free with the frames aligned and moved along an axis (a peg in its bore), if there is
/// such a place. Of each path: three poses before contact, five from shallow to deep, three slid sideways at one depth;
/// all distances are shares of SHELL's longest side, so that parts of every size are treated alike. The same seed gives
/// the same poses. Paths that meet nothing are tried anew, at most kTries times.
std::vector<JudgedPose> contactPath(const PairTruth& truth, int paths, std::uint64_t seed, const ProgressReport& report,
                                    Truth asked = Truth::Whole);

/// What is true at given poses.
std::vector<JudgedPose> judgePoses(const PairTruth& truth, const std::vector<Pose>& poses,
                                   const ProgressReport& report);

/// `count` poses for comparisons with FCL only (no depth, no wrench): half of them `near` ones shaken a little, half
/// anywhere.
std::vector<JudgedPose> shakenPoses(const PairTruth& truth, const std::vector<JudgedPose>& near, int count,
                                    std::uint64_t seed, const ProgressReport& report);

}  // namespace passung::truth
