#include "study/protocol/measures_reader.h"

#include <fmt/format.h>

#include <algorithm>

#include "study/protocol/trial_types.h"

namespace passung::protocol {
namespace {

/// The types of a plan's trials, each once.
std::vector<const TrialType*> typesOf(const plan::StudyPlan& plan) {
    std::vector<const TrialType*> types;
    for (const plan::Condition& condition : plan.conditions) {
        const TrialType* type = &typeOf(condition.task);
        if (std::find(types.begin(), types.end(), type) == types.end()) types.push_back(type);
    }
    return types;
}

bool contains(std::span<const std::string> names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

std::vector<std::string> readMeasures(const TableReader& root, const plan::StudyPlan* plan,
                                      std::span<const std::string> known_measures, Errors& errors) {
    const auto possible = plan != nullptr ? measuresOf(typesOf(*plan), known_measures)
                                          : std::vector<std::string>(known_measures.begin(), known_measures.end());
    if (!root.has("measures")) return possible;
    std::vector<std::string> measures;
    for (const Node& item : root.items("measures")) {
        const auto report = [&](std::string message) {
            errors.push_back(errorAt(item.place, "measures", valueText(item), std::move(message)));
        };
        if (!contains(known_measures, item.text)) {
            const std::vector<std::string_view> known(known_measures.begin(), known_measures.end());
            const auto close = closestWord(item.text, known);
            report(close ? fmt::format("unknown measure; did you mean \"{}\"?", *close)
                         : fmt::format("unknown measure; known measures: {}", fmt::join(known, ", ")));
        } else if (contains(measures, item.text)) {
            report("is listed twice");
        } else if (!contains(possible, item.text)) {
            report(fmt::format("is a measure of {} trials, and the study has none of these",
                               typesWith(item.text).front()->name));
        }
        measures.push_back(item.text);
    }
    return measures;
}

}  // namespace passung::protocol
