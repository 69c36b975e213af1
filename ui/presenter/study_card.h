#pragma once

#include <string>
#include <vector>

#include "core/base/device_description.h"
#include "core/base/result.h"
#include "study/plan/study_plan.h"

namespace passung::presenter {

/// A study of the list, as an experimenter looks through them.
struct StudyCard {
    struct Factor {
        std::string name, unit;
        std::vector<std::string> levels;
    };

    std::string path;
    std::string name, version, title;  // of a file that is not sound: the file's name
    bool sound = false;                // may it be run?
    bool for_people = true;            // by a person: every cue has an output here
    Errors problems;                   // why not, each with its place
    std::vector<std::string> warnings;
    std::vector<Factor> factors;
    std::size_t conditions = 0;
    std::size_t trials = 0;  // of a participant's first session
    int sessions = 1;        // of each participant
    double minutes = 0;      // of that session by plan::longestDuration(), which is no bound
    int participants = 0;
    std::string device;  // label; of several the first
    std::vector<std::string> questionnaires;
};

/// What is to be known of the study file at `path`, which has been read with this result. `devices`: those known.
StudyCard cardOf(const std::string& path, const Result<plan::StudyPlan>& read,
                 const std::vector<DeviceDescription>& devices);

/// The study files in the folders below `root`, "NAME/study.toml", by name.
std::vector<std::string> studyFilesBelow(const std::string& root);

}  // namespace passung::presenter
