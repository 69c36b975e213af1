#include "study/protocol/consent_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace passung::protocol {
namespace {

std::vector<std::pair<std::string, std::string>> readTexts(const Node& table, const std::string& path, Errors& errors) {
    std::vector<std::pair<std::string, std::string>> texts;
    for (const Entry& entry : table.entries) {
        const auto report = [&](const char* message) {
            errors.push_back(errorAt(entry.place, path + "." + entry.key, valueText(entry.value), message));
        };
        if (!isLanguage(entry.key))
            report("a language is two lower-case letters, such as en");
        else if (entry.value.kind != Node::Kind::Text || entry.value.text.empty())
            report("must be a text");
        else
            texts.emplace_back(entry.key, entry.value.text);
    }
    if (table.entries.empty()) errors.push_back(errorAt(table.place, path, "", "needs a text in one language"));
    return texts;
}

bool hasLanguage(const plan::ConsentClause& clause, const std::string& language) {
    return std::any_of(clause.texts.begin(), clause.texts.end(),
                       [&](const auto& text) { return text.first == language; });
}

/// A participant is asked in one language: whatever one clause has, all must have.
void checkLanguages(const std::vector<plan::ConsentClause>& clauses, const std::vector<const Node*>& tables,
                    Errors& errors) {
    for (const plan::ConsentClause& other : clauses)
        for (const auto& [language, text] : other.texts)
            for (std::size_t i = 0; i < clauses.size(); ++i)
                if (!hasLanguage(clauses[i], language))
                    errors.push_back(errorAt(
                        tables[i]->place, fmt::format("consent.{}.text", clauses[i].clause), "",
                        fmt::format("the text in \"{}\" is missing, which clause {} has", language, other.clause)));
}

}  // namespace

bool isLanguage(std::string_view text) {
    return text.size() == 2 && std::all_of(text.begin(), text.end(), [](char c) { return c >= 'a' && c <= 'z'; });
}

std::optional<std::string> unfilledDate(std::string_view text) {
    const auto letter = [](char c) { return c >= 'A' && c <= 'Z'; };
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (!letter(text[i]) || (i > 0 && letter(text[i - 1]))) continue;
        // Groups of one letter each, such as YYYY-MM-DD or TT.MM.JJJJ.
        std::size_t end = i, groups = 0;
        while (end < text.size() && letter(text[end])) {
            const std::size_t begin = end;
            while (end < text.size() && text[end] == text[begin]) ++end;
            if (end - begin < 2) break;
            ++groups;
            const bool more =
                end + 1 < text.size() && std::string_view("-./").find(text[end]) != std::string_view::npos;
            if (groups == 3 || !more || !letter(text[end + 1])) break;
            ++end;
        }
        if (groups == 3) return std::string(text.substr(i, end - i));
    }
    return std::nullopt;
}

std::vector<plan::ConsentClause> readConsent(const TableReader& root, Errors& errors, Errors& for_people) {
    std::vector<plan::ConsentClause> clauses;
    std::vector<const Node*> tables;
    std::set<std::string> names;
    const std::size_t before = errors.size();
    for (const Node& table : root.items("consent")) {
        const Node* name = table.find("clause");
        const bool named = name != nullptr && name->kind == Node::Kind::Text && isName(name->text);
        const TableReader read(table, {"consent"}, named ? "consent." + name->text : "consent", errors);
        plan::ConsentClause clause;
        clause.clause = read.text("clause");
        clause.required = read.boolean("required");
        if (named && !names.insert(clause.clause).second) read.fail("clause", "two clauses have this name");
        const Node* text = read.node("text");
        if (text != nullptr) {
            clause.texts = readTexts(*text, read.pathOf("text"), errors);
            for (const Entry& entry : text->entries)
                if (const auto date = unfilledDate(entry.value.text))
                    for_people.push_back(errorAt(entry.place, read.pathOf("text") + "." + entry.key,
                                                 "\"" + *date + "\"",
                                                 "is a placeholder: fill in the date before people are asked"));
        }
        clauses.push_back(std::move(clause));
        tables.push_back(text != nullptr ? text : &table);
    }
    if (errors.size() == before) checkLanguages(clauses, tables, errors);
    return clauses;
}

}  // namespace passung::protocol
