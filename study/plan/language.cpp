#include "study/plan/language.h"

#include <fmt/format.h>

#include <algorithm>

namespace passung::plan {

std::vector<std::string> languagesOf(const StudyPlan& plan) {
    if (!plan.languages.empty()) return plan.languages;
    std::vector<std::string> languages;
    const auto add = [&](const std::string& language) {
        if (std::find(languages.begin(), languages.end(), language) == languages.end()) languages.push_back(language);
    };
    for (const ConsentClause& clause : plan.consent)
        for (const auto& text : clause.texts) add(text.first);
    if (languages.empty())
        for (const PlannedQuestionnaire& planned : plan.questionnaires) add(planned.language);
    if (languages.empty()) add("en");
    return languages;
}

Result<std::string> chooseLanguage(const StudyPlan& plan, const std::string& asked) {
    const auto languages = languagesOf(plan);
    if (asked.empty()) return languages.front();
    if (std::find(languages.begin(), languages.end(), asked) != languages.end()) return asked;
    return Error{.message = fmt::format("must be one of the protocol's languages: {}", fmt::join(languages, ", ")),
                 .file = plan.source_path,
                 .key = "language",
                 .value = "\"" + asked + "\""};
}

bool speaks(const StudyPlan& plan, const std::string& language) {
    return plan.languages.size() > 1 &&
           std::find(plan.languages.begin(), plan.languages.end(), language) != plan.languages.end();
}

std::vector<std::string> languagesAsked(const StudyPlan& plan, const PlannedQuestionnaire& planned) {
    if (planned.texts.empty() && speaks(plan, planned.language)) return plan.languages;
    return {planned.language};
}

}  // namespace passung::plan
