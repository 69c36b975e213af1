#include "analysis/export/psych_ds.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <vector>

#include "core/base/json.h"

namespace passung::exporter {
namespace {

/// Values of keywords are letters and digits.
std::string keywordValue(const std::string& text) {
    std::string value;
    std::copy_if(text.begin(), text.end(), std::back_inserter(value),
                 [](unsigned char c) { return std::isalnum(c) != 0; });
    return value;
}

/// What is said of a column name in all tables that have it.
struct Variable {
    std::vector<std::string> labels;
    std::string unit;
};

std::string variableJson(const std::string& name, const Variable& variable) {
    JsonObject json;
    json.text("@type", "PropertyValue").text("name", name).text("description", joined(variable.labels, " / "));
    if (!variable.unit.empty()) json.text("unitText", variable.unit);
    return json.str();
}

}  // namespace

std::string psychDsFile(const StudyData& study, const Table& table, std::set<std::string>& taken) {
    const std::string stem = keywordValue(table.file.substr(0, table.file.rfind('.')));
    const std::string name = study.protocols.empty() ? "" : keywordValue(study.protocols.front().name);
    std::string value = stem;
    for (int number = 2; !taken.insert(value).second; ++number) value = stem + "x" + std::to_string(number);
    return "data/" + (name.empty() ? "" : "study-" + name + "_") + "description-" + value + "_data.csv";
}

std::string psychDsDescription(const StudyData& study, std::span<const Table> tables) {
    std::map<std::string, Variable> variables;
    for (const Table& table : tables)
        for (const Column& column : table.columns) {
            Variable& variable = variables[column.name];
            const std::string label = column.label + (column.formula.empty() ? "" : ": " + column.formula);
            if (std::find(variable.labels.begin(), variable.labels.end(), label) == variable.labels.end())
                variable.labels.push_back(label);
            variable.unit = column.unit;
        }
    std::vector<std::string> list;
    list.reserve(variables.size());
    for (const auto& [name, variable] : variables) list.push_back(variableJson(name, variable));
    std::string title = "Study";
    if (!study.protocols.empty())
        title = study.protocols.front().title.empty() ? study.protocols.front().name : study.protocols.front().title;
    return JsonObject()
               .text("@context", "https://schema.org/")
               .text("@type", "Dataset")
               .text("name", title)
               .text("description",
                     "Data of a Passung study: tables in data/, every column in codebook.csv too. Rows of "
                     "simulated participants have kind = simulated: they show that software and analysis "
                     "work, never how people behave.")
               .text("schemaVersion", "Psych-DS 0.4.0")
               .json("variableMeasured", jsonList(list))
               .str() +
           "\n";
}

}  // namespace passung::exporter
