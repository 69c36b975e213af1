#include "analysis/export/counted_forms.h"

#include <algorithm>

#include "study/protocol/questionnaire_reader.h"
#include "study/protocol/questionnaire_texts.h"

namespace passung::exporter {

using questionnaire::Definition;
using store::QuestionnaireRunRow;

const Definition* Definitions::read(const Key& key, const std::string& name) {
    const auto& [text, texts, language] = key;
    auto found = known_.find(key);
    if (found == known_.end()) {
        auto definition = protocol::readQuestionnaire(text, name, language);
        if (definition && texts) definition = protocol::withTexts(*std::move(definition), *texts, name);
        found = known_.emplace(key, definition ? std::optional(*std::move(definition)) : std::nullopt).first;
    }
    return found->second ? &*found->second : nullptr;
}

const Definition* Definitions::of(const QuestionnaireRunRow& run) {
    return read({run.definition_text, run.texts_text, run.language}, run.questionnaire);
}

const Definition* Definitions::of(const store::QuestionnaireRow& row) {
    return read({row.definition_text, row.texts_text, row.language}, row.questionnaire);
}

const questionnaire::Scale* Definitions::scale(const QuestionnaireRunRow& run, const std::string& name) {
    const Definition* definition = of(run);
    const auto index = definition != nullptr ? questionnaire::scaleNamed(*definition, name) : std::nullopt;
    return index ? &definition->scales[*index] : nullptr;
}

/// Of the counted sessions the newest form of each occasion: who goes back to a trial or block is asked again.
CountedRuns countedRuns(const StudyData& study) {
    const std::set<std::string> counted = countedSessions(study);
    using Occasion = std::tuple<std::string, std::string, std::string, std::optional<std::int64_t>,
                                std::optional<std::int64_t>, std::optional<std::string>>;
    std::map<Occasion, const QuestionnaireRunRow*> newest;  // rows come as they were filled in
    for (const QuestionnaireRunRow& run : study.questionnaires)
        if (counted.count(run.session_id) != 0)
            newest[{run.session_id, run.questionnaire, run.moment, run.block_index, run.trial_index, run.condition}] =
                &run;
    CountedRuns runs;
    for (const auto& [occasion, run] : newest) runs.push_back(run);
    std::sort(runs.begin(), runs.end());
    return runs;
}

}  // namespace passung::exporter
