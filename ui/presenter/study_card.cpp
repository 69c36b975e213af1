#include "ui/presenter/study_card.h"

#include <algorithm>
#include <filesystem>

#include "study/plan/duration.h"
#include "study/plan/plan_warnings.h"
#include "study/session/participant_order.h"
#include "study/session/plan_text.h"

namespace passung::presenter {

namespace {

namespace fs = std::filesystem;

std::string labelOf(const std::string& device, const std::vector<DeviceDescription>& devices) {
    for (const DeviceDescription& known : devices)
        if (known.name == device) return known.label;
    return device;
}

}  // namespace

StudyCard cardOf(const std::string& path, const Result<plan::StudyPlan>& read,
                 const std::vector<DeviceDescription>& devices) {
    StudyCard card;
    card.path = path;
    card.name = fs::path(path).parent_path().filename().string();
    card.title = card.name;
    if (!read) {
        card.problems = read.errors();
        return card;
    }
    const plan::StudyPlan& plan = *read;
    card.name = plan.name;
    card.version = plan.version;
    card.title = plan.title.empty() ? plan.name : plan.title;
    card.warnings = session::planWarnings(plan);
    for (const plan::Factor& factor : plan.factors) {
        StudyCard::Factor shown{factor.name, factor.unit, {}};
        for (const plan::Level& level : factor.levels) shown.levels.push_back(level.label);
        card.factors.push_back(std::move(shown));
    }
    card.conditions = plan.shared_conditions > 0 ? plan.shared_conditions : plan.conditions.size();
    card.sessions = plan::sessionsOf(plan);
    card.participants = plan.participants;
    card.device = labelOf(plan.conditions.front().device, devices);
    for (const auto& asked : plan.questionnaires) card.questionnaires.push_back(asked.definition.title);

    const auto trials = session::planTrials(plan, {}, "P001");
    if (!trials) {
        card.problems = trials.errors();
        return card;
    }
    card.trials = trials->size();
    card.minutes = plan::longestDuration(plan, *trials) / 60.0;
    card.sound = true;
    card.for_people = plan::isForPeople(plan);
    return card;
}

std::vector<std::string> studyFilesBelow(const std::string& root) {
    std::vector<std::string> files;
    std::error_code problem;
    for (const auto& entry : fs::directory_iterator(root, problem)) {
        const fs::path file = entry.path() / "study.toml";
        std::error_code unknown;
        if (fs::is_regular_file(file, unknown)) files.push_back(file.string());
    }
    std::sort(files.begin(), files.end());
    return files;
}

}  // namespace passung::presenter
