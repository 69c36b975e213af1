#pragma once

#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "analysis/export/study_data.h"
#include "study/questionnaire/definition.h"

namespace passung::exporter {

/// The instruments of a study, each read once.
class Definitions {
public:
    /// nullptr where this program cannot read the stored text.
    const questionnaire::Definition* of(const store::QuestionnaireRunRow& run);
    const questionnaire::Definition* of(const store::QuestionnaireRow& row);
    const questionnaire::Scale* scale(const store::QuestionnaireRunRow& run, const std::string& name);

private:
    using Key = std::tuple<std::string, std::optional<std::string>, std::string>;  // definition, texts, language
    const questionnaire::Definition* read(const Key& key, const std::string& name);

    std::map<Key, std::optional<questionnaire::Definition>> known_;
};

/// Forms that enter means, in the order of the study's rows.
using CountedRuns = std::vector<const store::QuestionnaireRunRow*>;

/// Of the counted sessions the newest form of each occasion: who goes back to a trial or block is asked again.
CountedRuns countedRuns(const StudyData& study);

}  // namespace passung::exporter
