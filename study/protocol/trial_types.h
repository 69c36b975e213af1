#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "study/plan/task.h"

namespace passung::protocol {

/// A type of trial: what it is told and what it gives. Its parameters are the key table's rows of `keys`; its output
/// columns are its own measures beside those that every trial has.
struct TrialType {
    std::string_view name;  // of task.type
    std::string_view keys;  // id of its table in the key table: "task.peg_in_hole"
    std::span<const std::string_view> measures;
};

/// All types, in the order of Task::form.
std::span<const TrialType> trialTypes();

const TrialType& typeOf(const plan::Task& task);

/// Known measures that a trial of one of these types can have.
std::vector<std::string> measuresOf(std::span<const TrialType* const> types, std::span<const std::string> known);

/// The types whose own measure this is; none: every trial has it.
std::vector<const TrialType*> typesWith(std::string_view measure);

}  // namespace passung::protocol
