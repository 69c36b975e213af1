#pragma once

#include <span>
#include <string>
#include <vector>

#include "study/plan/study_plan.h"
#include "study/protocol/document.h"

namespace passung::protocol {

/// One key of the study that a level changes.
struct Override {
    std::string path;         // "contact.method", "part.plate.shape.bore_diameter", "task.timeout_s"
    TextPosition path_place;  // where the path is written
    const Node* value;        // in the study's document
};

/// A factor and what each of its levels changes.
struct FactorContent {
    plan::Factor factor;
    std::vector<std::vector<Override>> overrides;  // per level
    std::vector<bool> sound;                       // is a level?
};

/// The tables that a level may change.
struct StudyTables {
    Node scene;
    Node task;
    Node feedback;
    Node secondary;
};

/// Reads the [[factor]] tables. The result borrows from `tables`. `taken_names` are columns that exports have anyway.
std::vector<FactorContent> readFactors(const std::vector<Node>& tables, std::span<const std::string> taken_names,
                                       Errors& errors);

/// Puts the level's value into its table; keys that are missing on the way are created. Errors: a part that is not
/// there, a path that leads through something that is no table.
void applyOverride(const Override& change, StudyTables& tables, Errors& errors);

/// True if one of the keys is the other or holds it.
bool overlap(const std::string& a, const std::string& b);

/// Every combination of indices of sound levels, the first factor varying slowest. One empty combination without
/// factors.
std::vector<std::vector<std::size_t>> combinations(const std::vector<FactorContent>& factors);

}  // namespace passung::protocol
