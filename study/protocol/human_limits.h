#pragma once

#include <string>
#include <vector>

#include "core/base/device_description.h"
#include "study/plan/study_plan.h"
#include "study/protocol/factors.h"

namespace passung::protocol {

/// Adds an error where a condition asks for what no person is fast, calm, exact or sharp enough, a sentence to
/// `warnings` where hardly anybody is. Numbers, all on the side of the study:
///   A simple reaction takes 0.15 s or more, an answer to a choice longer (Woodworth & Schlosberg 1954).
///   A hand at rest trembles at 8 to 12 Hz by a tenth of a millimetre or so (Elble & Koller 1990): by some mm/s.
///   Tilts of a hand are told apart from about half a degree on, whoever judges them by sight (proposed).
/// `stepped`: path of the key that a staircase presents, may be empty; its levels may go beyond what anybody can.
void checkHuman(const StudyTables& tables, const plan::Condition& condition, const DeviceDescription& device,
                const std::string& stepped, Errors& errors, std::vector<std::string>& warnings);

/// Adds an error at `task` if a study compares intervals that are the same in all its pairs, or that differ in nothing
/// that is felt, seen or heard.
void checkComparisons(const plan::StudyPlan& plan, const Node& task, Errors& errors);

/// Sentences about rests that are longer than a session.
std::vector<std::string> restWarnings(const plan::StudyPlan& plan);

}  // namespace passung::protocol
