#include "study/protocol/planned_questionnaires.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>

#include "core/base/json.h"
#include "study/plan/language.h"
#include "study/protocol/analysis_reader.h"
#include "study/protocol/plan_json.h"
#include "study/protocol/questionnaire_reader.h"
#include "study/protocol/questionnaire_texts.h"
#include "study/protocol/table_reader.h"

namespace passung::protocol {
namespace {

constexpr plan::Moment kMoments[]{plan::Moment::SessionStart, plan::Moment::BeforeBlock,    plan::Moment::AfterBlock,
                                  plan::Moment::AfterTrial,   plan::Moment::AfterCondition, plan::Moment::SessionEnd};

bool isOfSession(plan::Moment moment) {
    return moment == plan::Moment::SessionStart || moment == plan::Moment::SessionEnd;
}

void checkBlock(const TableReader& read, const plan::PlannedQuestionnaire& planned,
                const std::vector<plan::Block>& blocks) {
    if (!read.has("block")) return;
    if (isOfSession(planned.moment)) return read.fail("block", "has no meaning at the start or end of a session");
    const auto named = [&](const plan::Block& block) { return block.name == planned.block; };
    if (std::none_of(blocks.begin(), blocks.end(), named)) read.fail("block", "no block has this name");
}

/// Loads one questionnaire; errors name the study's table where they are about it.
class Loader {
public:
    Loader(const plan::StudyPlan& plan, const std::function<Result<std::string>(const std::string&)>& read,
           Errors& errors)
        : plan_(plan), read_(read), errors_(errors) {}

    void load(plan::PlannedQuestionnaire& planned) {
        const auto text = open(planned, "file", planned.file);
        if (!text) return;
        const std::string path = pathOf(planned.file);
        // A template's language is that of the lab's texts.
        auto definition = readQuestionnaire(*text, path, "");
        if (!definition) return add(definition.errors());
        const bool is_template = definition->is_template;
        if (is_template && planned.texts.empty())
            return fail(planned, "texts", "", "required: " + definition->key + " is a template for the lab's texts");
        if (!is_template && !planned.texts.empty())
            return fail(planned, "texts", planned.texts, definition->key + " has texts of its own");
        JsonObject source;
        source.text("definition", *text);
        if (is_template) {
            const auto texts = open(planned, "texts", planned.texts);
            if (!texts) return;
            definition = withTexts(*std::move(definition), *texts, pathOf(planned.texts));
            source.text("texts", *texts);
        } else {
            definition = readQuestionnaire(*text, path, planned.language);
        }
        if (!definition) return add(definition.errors());
        if (definition->language != planned.language)
            return fail(planned, "language", planned.language,
                        fmt::format("there are no texts of {} in this language", definition->key));
        for (const std::string& language : plan::languagesAsked(plan_, planned))
            if (!is_template && readQuestionnaire(*text, path, language)->language != language)
                fail(planned, "language", language,
                     fmt::format("there are no texts of {} in this language of the study", definition->key));
        planned.definition = *std::move(definition);
        planned.source_json = source.str();
    }

private:
    std::string pathOf(const std::string& file) const {
        return (std::filesystem::path(plan_.source_path).parent_path() / file).string();
    }

    Result<std::string> open(const plan::PlannedQuestionnaire& planned, std::string_view key, const std::string& file) {
        auto text = read_(pathOf(file));
        if (!text) fail(planned, key, file, text.errors().front().message);
        return text;
    }

    void add(const Errors& errors) { errors_.insert(errors_.end(), errors.begin(), errors.end()); }

    void fail(const plan::PlannedQuestionnaire& planned, std::string_view key, const std::string& value,
              std::string message) {
        errors_.push_back(errorAt({plan_.source_path, planned.line, planned.column},
                                  fmt::format("questionnaire.{}", key),
                                  value.empty() ? "" : fmt::format("\"{}\"", value), std::move(message)));
    }

    const plan::StudyPlan& plan_;
    const std::function<Result<std::string>(const std::string&)>& read_;
    Errors& errors_;
};

/// Those of a session in this language.
void speakLanguage(const plan::StudyPlan& plan, const std::string& language,
                   std::vector<plan::PlannedQuestionnaire>& all) {
    if (!plan::speaks(plan, language)) return;
    std::erase_if(all, [&](const plan::PlannedQuestionnaire& planned) {
        return !planned.texts.empty() && plan::speaks(plan, planned.language) && planned.language != language;
    });
    for (plan::PlannedQuestionnaire& planned : all)
        if (plan::speaks(plan, planned.language)) planned.language = language;
}

/// The lab's texts of a template are in one language each: a session has those in its own.
void checkSlots(const plan::StudyPlan& plan, const std::vector<plan::PlannedQuestionnaire>& all, Errors& errors) {
    for (const plan::PlannedQuestionnaire& filled : all) {
        if (filled.texts.empty() || !plan::speaks(plan, filled.language)) continue;
        for (const std::string& language : plan.languages) {
            const bool there = std::any_of(all.begin(), all.end(), [&](const plan::PlannedQuestionnaire& other) {
                return other.file == filled.file && other.moment == filled.moment && other.block == filled.block &&
                       other.language == language;
            });
            if (there) continue;
            errors.push_back(errorAt({plan.source_path, filled.line, filled.column}, "questionnaire.texts",
                                     fmt::format("\"{}\"", filled.texts),
                                     fmt::format("the study is also in \"{}\": another [[questionnaire]] has to give "
                                                 "the texts in that language",
                                                 language)));
        }
    }
}

/// The answers to one moment must be told apart by the questionnaire's name.
void checkDistinct(const plan::StudyPlan& plan, const std::vector<plan::PlannedQuestionnaire>& all, Errors& errors) {
    for (std::size_t i = 0; i < all.size(); ++i) {
        const auto twin = [&](const plan::PlannedQuestionnaire& other) {
            return other.definition.key == all[i].definition.key && other.moment == all[i].moment &&
                   other.block == all[i].block &&
                   (other.language == all[i].language || other.texts.empty() || !plan::speaks(plan, other.language) ||
                    !plan::speaks(plan, all[i].language));
        };
        const auto end = all.begin() + static_cast<std::ptrdiff_t>(i);
        if (all[i].definition.key.empty() || std::none_of(all.begin(), end, twin)) continue;
        errors.push_back(errorAt({plan.source_path, all[i].line, all[i].column}, "questionnaire.file",
                                 fmt::format("\"{}\"", all[i].file),
                                 fmt::format("{} is asked twice at this moment", all[i].definition.key)));
    }
}

Result<std::vector<plan::PlannedQuestionnaire>> load(const plan::StudyPlan& plan,
                                                     const std::function<Result<std::string>(const std::string&)>& read,
                                                     const std::string& language) {
    Errors errors;
    std::vector<plan::PlannedQuestionnaire> all = plan.questionnaires;
    speakLanguage(plan, language, all);
    Loader loader(plan, read, errors);
    for (plan::PlannedQuestionnaire& planned : all)
        if (!planned.file.empty()) loader.load(planned);
    checkDistinct(plan, all, errors);
    if (errors.empty()) errors = checkScales(plan, all);
    if (language.empty()) checkSlots(plan, all, errors);
    tidy(errors);
    if (!errors.empty()) return errors;
    return all;
}

}  // namespace

std::vector<plan::PlannedQuestionnaire> readQuestionnaires(const std::vector<Node>& tables,
                                                           const std::vector<plan::Block>& blocks, Errors& errors) {
    std::vector<plan::PlannedQuestionnaire> all;
    for (const Node& table : tables) {
        const TableReader read(table, {"questionnaire"}, "questionnaire", errors);
        plan::PlannedQuestionnaire planned;
        planned.file = read.text("file");
        planned.texts = read.text("texts");
        planned.language = read.text("language");
        planned.block = read.text("block");
        planned.line = table.place.line;
        planned.column = table.place.column;
        const auto moment = read.text("moment");
        const auto named = [&](plan::Moment each) { return moment == plan::momentName(each); };
        const auto found = std::find_if(std::begin(kMoments), std::end(kMoments), named);
        if (found != std::end(kMoments)) planned.moment = *found;
        checkBlock(read, planned, blocks);
        all.push_back(std::move(planned));
    }
    return all;
}

Errors checkQuestionnaires(const plan::StudyPlan& plan,
                           const std::function<Result<std::string>(const std::string&)>& read) {
    const auto loaded = load(plan, read, "");
    return loaded ? Errors{} : loaded.errors();
}

Result<Done> loadQuestionnaires(plan::StudyPlan& plan,
                                const std::function<Result<std::string>(const std::string&)>& read,
                                const std::string& language) {
    auto loaded = load(plan, read, language);
    if (!loaded) return loaded.errors();
    plan.questionnaires = *std::move(loaded);
    plan.expanded_json = expandedJson(plan);
    return Done{};
}

}  // namespace passung::protocol
