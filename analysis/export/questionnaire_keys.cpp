#include <algorithm>

#include "analysis/export/columns.h"
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

/// The smallest and the largest answer to an item; nothing: none is a number.
struct AnswerRange {
    std::optional<double> low, high;
};

AnswerRange rangeOf(const questionnaire::Response& response) {
    if (response.kind == AnswerKind::Text) return {};
    if (response.kind == AnswerKind::Pair) return {0.0, 1.0};
    if (response.options.empty()) return {response.low, response.high};
    const auto [low, high] = std::minmax_element(response.options.begin(), response.options.end(),
                                                 [](const auto& a, const auto& b) { return a.value < b.value; });
    return {low->value, high->value};
}

/// An item of a questionnaire in one language.
struct KeyRow {
    const store::QuestionnaireRow* questionnaire;
    const Definition* definition;
    std::size_t index;  // in the definition, from 0

    const questionnaire::Item& item() const { return definition->items[index]; }
};

ColumnsOf<store::QuestionnaireRow> instrumentColumns() {
    using store::QuestionnaireRow;
    return {{"questionnaire", "Key of the questionnaire", "text", &QuestionnaireRow::questionnaire},
            {"version", "Version of its items and texts", "text", &QuestionnaireRow::version},
            {"language", "Language of the texts", "text", &QuestionnaireRow::language}};
}

ColumnsOf<KeyRow> keyColumns() {
    ColumnsOf<KeyRow> columns;
    append(columns, instrumentColumns(),
           [](const KeyRow& row) -> const store::QuestionnaireRow& { return *row.questionnaire; });
    append(columns,
           {{"item", "Its id: column item of questionnaire_items.csv", "text",
             [](const KeyRow& row) { return row.item().id; }},
            {"place", "Its place in the questionnaire's file, from 1", "integer",
             [](const KeyRow& row) { return static_cast<std::int64_t>(row.index) + 1; }},
            {"text", "The item as it is shown", "text", [](const KeyRow& row) { return row.item().text; }},
            {"answer",
             "How it is answered",
             "text",
             [](const KeyRow& row) { return kindName(row.item().response.kind); },
             {.levels = {"rating", "choice", "number", "text", "pair"}}},
            {"low", "Smallest answer; NA: none is a number", "number",
             [](const KeyRow& row) { return rangeOf(row.item().response).low; }},
            {"high", "Largest answer", "number", [](const KeyRow& row) { return rangeOf(row.item().response).high; }},
            {"labels", "What answers stand for, parted by ;", "text",
             [](const KeyRow& row) { return labelsText(*row.definition, row.item()); }},
            {"reversed",
             "1 if scales take low + high - answer: more of it means less of what the scale measures",
             "0/1",
             [](const KeyRow& row) { return row.item().reversed; },
             {.levels = {"0", "1"}}},
            {"scales", "Scales that it enters, parted by ;; NA: none", "text",
             [](const KeyRow& row) { return scalesText(*row.definition, row.index); }},
            {"instruction", "What stands above all items", "text",
             [](const KeyRow& row) { return row.definition->instruction; }},
            {"citation", "Where instrument and scoring are from", "text",
             [](const KeyRow& row) { return row.definition->citation; }},
            {"licence", "Under which the texts stand", "text",
             [](const KeyRow& row) { return row.definition->licence; }}});
    return columns;
}

}  // namespace

Table makeQuestionnaireKeys(const StudyData& study) {
    Definitions definitions;
    std::vector<KeyRow> rows;
    for (const store::QuestionnaireRow& questionnaire : study.definitions)
        if (const Definition* definition = definitions.of(questionnaire))
            for (std::size_t i = 0; i < definition->items.size(); ++i) rows.push_back({&questionnaire, definition, i});
    return makeTable("questionnaire_keys.csv",
                     "One row per item of every questionnaire and language that the study has: its text, its answers, "
                     "its polarity and its scales.",
                     keyColumns(), rows);
}

}  // namespace passung::exporter
