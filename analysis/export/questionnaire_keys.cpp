#include <algorithm>

#include "analysis/export/counted_forms.h"
#include "analysis/export/questionnaire_tables.h"

namespace passung::exporter {
namespace {

using questionnaire::AnswerKind;
using questionnaire::Definition;

const char* kindName(AnswerKind kind) {
    switch (kind) {
        case AnswerKind::Rating:
            return "rating";
        case AnswerKind::Choice:
            return "choice";
        case AnswerKind::Number:
            return "number";
        case AnswerKind::Text:
            return "text";
        case AnswerKind::Pair:
            return "pair";
    }
    return "";
}

/// What the numbers of an item's answers stand for.
std::string labelsText(const Definition& definition, const questionnaire::Item& item) {
    std::string text;
    const auto add = [&text](double value, const std::string& label) {
        if (!label.empty()) text += (text.empty() ? "" : "; ") + cell(value) + " = " + label;
    };
    const questionnaire::Response& response = item.response;
    if (response.kind == AnswerKind::Rating) {
        add(response.low, response.low_anchor);
        add(response.high, response.high_anchor);
    }
    if (response.kind == AnswerKind::Pair) {
        add(0, definition.items[item.of.first].text);
        add(1, definition.items[item.of.second].text);
    }
    for (const questionnaire::Option& option : response.options) add(option.value, option.label);
    return text;
}

/// The scales that the item enters by itself, parted by ;.
std::string scalesText(const Definition& definition, std::size_t item) {
    std::string text;
    for (const questionnaire::Scale& scale : definition.scales)
        if (std::find(scale.items.begin(), scale.items.end(), item) != scale.items.end())
            text += (text.empty() ? "" : ";") + scale.name;
    return text.empty() ? kMissing : text;
}

std::vector<Column> keyColumns() {
    return {{"questionnaire", "Key of the questionnaire", "", "text", "", 1, {}},
            {"version", "Version of its items and texts", "", "text", "", 1, {}},
            {"language", "Language of the texts", "", "text", "", 1, {}},
            {"item", "Its id: column item of questionnaire_items.csv", "", "text", "", 1, {}},
            {"place", "Its place in the questionnaire's file, from 1", "", "integer", "", 1, {}},
            {"text", "The item as it is shown", "", "text", "", 1, {}},
            {"answer", "How it is answered", "", "text", "", 1, {"rating", "choice", "number", "text", "pair"}},
            {"low", "Smallest answer; NA: none is a number", "", "number", "", 1, {}},
            {"high", "Largest answer", "", "number", "", 1, {}},
            {"labels", "What answers stand for, parted by ;", "", "text", "", 1, {}},
            {"reversed",
             "1 if scales take low + high - answer: more of it means less of what the scale measures",
             "",
             "0/1",
             "",
             1,
             {"0", "1"}},
            {"scales", "Scales that it enters, parted by ;; NA: none", "", "text", "", 1, {}},
            {"instruction", "What stands above all items", "", "text", "", 1, {}},
            {"citation", "Where instrument and scoring are from", "", "text", "", 1, {}},
            {"licence", "Under which the texts stand", "", "text", "", 1, {}}};
}

}  // namespace

Table makeQuestionnaireKeys(const StudyData& study) {
    Table table{"questionnaire_keys.csv",
                "One row per item of every questionnaire and language that the study has: its text, its answers, its "
                "polarity and its scales.",
                keyColumns(),
                {}};
    Definitions definitions;
    for (const store::QuestionnaireRow& row : study.definitions) {
        const Definition* definition = definitions.of(row);
        if (definition == nullptr) continue;
        for (std::size_t i = 0; i < definition->items.size(); ++i) {
            const questionnaire::Item& item = definition->items[i];
            double low = item.response.low, high = item.response.high;
            for (const questionnaire::Option& option : item.response.options) {
                const bool first = &option == item.response.options.data();
                low = first ? option.value : std::min(low, option.value);
                high = first ? option.value : std::max(high, option.value);
            }
            if (item.response.kind == AnswerKind::Pair) low = 0.0, high = 1.0;
            const bool text = item.response.kind == AnswerKind::Text;
            table.rows.push_back({row.questionnaire, row.version, row.language, item.id,
                                  cell(static_cast<std::int64_t>(i) + 1), item.text, kindName(item.response.kind),
                                  text ? kMissing : cell(low), text ? kMissing : cell(high),
                                  labelsText(*definition, item), cell(item.reversed), scalesText(*definition, i),
                                  definition->instruction, definition->citation, definition->licence});
        }
    }
    return table;
}

}  // namespace passung::exporter
