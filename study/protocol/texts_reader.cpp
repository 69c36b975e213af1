#include "study/protocol/texts_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "study/protocol/consent_reader.h"

namespace passung::protocol {
namespace {

plan::StudyText& textNamed(plan::StudyPlan& plan, const std::string& name) {
    auto found =
        std::find_if(plan.texts.begin(), plan.texts.end(), [&](const auto& text) { return text.name == name; });
    if (found == plan.texts.end()) found = plan.texts.insert(plan.texts.end(), {name, {}});
    return *found;
}

bool has(const std::vector<std::pair<std::string, std::string>>& texts, const std::string& language) {
    return std::any_of(texts.begin(), texts.end(), [&](const auto& text) { return text.first == language; });
}

void readLanguage(const Entry& language, plan::StudyPlan& plan, Errors& errors) {
    const auto report = [&](const Entry& entry, std::string key, const char* message) {
        errors.push_back(errorAt(entry.place, std::move(key), valueText(entry.value), message));
    };
    const std::string path = "text." + language.key;
    if (!isLanguage(language.key)) return report(language, path, "a language is two lower-case letters, such as en");
    if (language.value.kind != Node::Kind::Table) return report(language, path, "must be a table of texts");
    plan.languages.push_back(language.key);
    for (const Entry& entry : language.value.entries) {
        const std::string key = path + "." + entry.key;
        if (!isName(entry.key))
            report(entry, key, "a name has lower-case letters, digits and _, beginning with a letter");
        else if (entry.value.kind != Node::Kind::Text || entry.value.text.empty())
            report(entry, key, "must be a text");
        else
            textNamed(plan, entry.key).languages.emplace_back(language.key, entry.value.text);
    }
}

/// A participant reads one language: whatever one has, all must have, and the clauses of consent as well.
void checkTranslations(const Node& table, const plan::StudyPlan& plan, Errors& errors) {
    for (const Entry& language : table.entries) {
        for (const plan::StudyText& text : plan.texts)
            if (!has(text.languages, language.key))
                errors.push_back(
                    errorAt(language.value.place, fmt::format("text.{}.{}", language.key, text.name), "",
                            fmt::format("the text is missing, which [text.{}] has", text.languages.front().first)));
        for (const plan::ConsentClause& clause : plan.consent)
            if (!has(clause.texts, language.key))
                errors.push_back(errorAt(
                    language.value.place, "text." + language.key, "",
                    fmt::format("clause {} of [[consent]] has no text in \"{}\"", clause.clause, language.key)));
    }
}

void readInstruction(const Node& table, plan::StudyPlan& plan, Errors& errors) {
    const TableReader read(table, {"instruction"}, "instruction", errors);
    plan::Instruction page;
    const std::string moment = read.text("moment");
    for (std::size_t i = 0; i < plan::kShowAtNames.size(); ++i)
        if (moment == plan::kShowAtNames[i]) page.moment = static_cast<plan::ShowAt>(i);
    page.block = read.text("block");
    page.text = read.text("text");
    page.picture = read.text("picture");
    if (read.has("block") && page.moment != plan::ShowAt::BeforeBlock)
        read.fail("block", "is for moment = \"before_block\"");
    if (!read.has("block") && page.moment == plan::ShowAt::BeforeBlock)
        read.fail("block", "required with moment = \"before_block\"");
    if (read.has("block") && std::none_of(plan.blocks.begin(), plan.blocks.end(),
                                          [&](const plan::Block& block) { return block.name == page.block; }))
        read.fail("block", "the study has no block of this name");
    const bool known = std::any_of(plan.texts.begin(), plan.texts.end(),
                                   [&](const plan::StudyText& text) { return text.name == page.text; });
    if (read.has("text") && !known) read.fail("text", "no [text.LANGUAGE] has a text of this name");
    if (const Node* picture = read.node("picture")) {
        const std::filesystem::path file(page.picture);
        if (file.is_absolute()) read.fail("picture", "must be relative to the study's file");
        if (std::none_of(plan.pictures.begin(), plan.pictures.end(),
                         [&](const plan::PictureSource& other) { return other.name == page.picture; }))
            plan.pictures.push_back({page.picture,
                                     (std::filesystem::path(picture->place.file).parent_path() / file).string(),
                                     picture->place.line, picture->place.column});
    }
    plan.instructions.push_back(std::move(page));
}

bool isPicture(std::string_view bytes) {
    using namespace std::string_view_literals;
    return bytes.starts_with("\x89PNG\r\n\x1a\n"sv) || bytes.starts_with("\xff\xd8\xff"sv);
}

}  // namespace

void readTexts(const TableReader& root, plan::StudyPlan& plan, Errors& errors) {
    if (const Node* table = root.node("text")) {
        const std::size_t before = errors.size();
        for (const Entry& language : table->entries) readLanguage(language, plan, errors);
        if (errors.size() == before) checkTranslations(*table, plan, errors);
    }
    for (const Node& table : root.items("instruction")) readInstruction(table, plan, errors);
}

Errors checkPictures(const plan::StudyPlan& plan,
                     const std::function<Result<std::string>(const std::string& path)>& read) {
    Errors errors;
    for (const plan::PictureSource& picture : plan.pictures) {
        const auto bytes = read(picture.path);
        if (bytes && isPicture(*bytes)) continue;
        errors.push_back(errorAt({plan.source_path, picture.line, picture.column}, "instruction.picture",
                                 "\"" + picture.name + "\"",
                                 bytes ? "must be a PNG or JPEG picture" : bytes.errors().front().message));
    }
    return errors;
}

}  // namespace passung::protocol
