#include "study/protocol/questionnaire_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "study/protocol/document.h"
#include "study/protocol/table_reader.h"
#include "study/questionnaire/scoring.h"

namespace passung::protocol {
namespace {

using namespace questionnaire;

AnswerKind kindNamed(std::string_view name) {
    if (name == "choice") return AnswerKind::Choice;
    if (name == "number") return AnswerKind::Number;
    if (name == "text") return AnswerKind::Text;
    return name == "pair" ? AnswerKind::Pair : AnswerKind::Rating;
}

Felt feltNamed(std::string_view name) {
    if (name == "force") return Felt::Force;
    if (name == "time") return Felt::Time;
    if (name == "failure") return Felt::Failure;
    if (name == "success") return Felt::Success;
    return name == "depth" ? Felt::Depth : Felt::Hardness;
}

Formula formulaNamed(std::string_view name) {
    if (name == "sum") return Formula::Sum;
    if (name == "pair_weighted") return Formula::PairWeighted;
    if (name == "laterality") return Formula::Laterality;
    if (name == "most_identical") return Formula::MostIdentical;
    return name == "wide_scales" ? Formula::WideScales : Formula::Mean;
}

bool hasLimits(AnswerKind kind) { return kind == AnswerKind::Rating || kind == AnswerKind::Number; }

bool leadsToHigh(const Response& response) {
    Item item;
    item.response = response;
    return answerFault(item, {response.high, ""}).empty();
}

/// Reads one questionnaire file, step by step; every step adds to errors_.
class QuestionnaireReader {
public:
    QuestionnaireReader(const Node& document, std::string_view language)
        : root_(document, {"questionnaire_file"}, "", errors_), language_(language) {}

    Result<Definition> read() {
        readHead();
        for (const Node& table : root_.items("response")) readResponse(table);
        for (const Node& table : root_.items("item")) readItem(table);
        readPairs();
        for (const Node& table : root_.items("scale")) readScale(table);
        // Golden vectors of a file that is wrong elsewhere would only repeat that.
        if (errors_.empty()) {
            if (root_.items("golden").empty()) root_.fail("golden", "needs at least one golden vector");
            for (const Node& table : root_.items("golden")) readGolden(table);
        }
        tidy(errors_);
        if (!errors_.empty()) return errors_;
        return std::move(definition_);
    }

private:
    void readHead() {
        for (const Node& item : root_.items("languages")) languages_.push_back(item.text);
        if (languages_.empty()) {
            if (root_.has("languages")) root_.fail("languages", "needs at least one language");
            languages_.push_back("en");
        }
        const bool known = std::find(languages_.begin(), languages_.end(), language_) != languages_.end();
        definition_.language = known ? language_ : languages_.front();
        definition_.key = root_.text("questionnaire");
        definition_.version = root_.text("version");
        definition_.scoring_version = static_cast<int>(root_.integer("scoring_version"));
        definition_.title = localText(root_, "title");
        definition_.instruction = localText(root_, "instruction");
        definition_.licence = root_.text("licence");
        definition_.citation = root_.text("citation");
        definition_.shuffled = root_.text("order") == "random";
        definition_.is_template = root_.boolean("slot");
        definition_.polarity_from_texts = root_.boolean("polarity_from_texts");
        if (definition_.polarity_from_texts && !definition_.is_template)
            root_.fail("polarity_from_texts", "is for templates (slot = true): only they get texts from elsewhere");
    }

    /// A text in the language asked for; empty if absent or wrong.
    std::string localText(const TableReader& read, std::string_view name) {
        const Node* value = read.node(name);
        if (value == nullptr) return "";
        if (value->kind == Node::Kind::Text) {
            if (languages_.size() > 1) read.fail(name, "needs a text for each language, as in { en = \"...\" }");
            return value->text;
        }
        if (value->kind != Node::Kind::Table) {
            read.fail(name, "must be a string or a table with a text for each language");
            return "";
        }
        for (const Entry& entry : value->entries) {
            const bool known = std::find(languages_.begin(), languages_.end(), entry.key) != languages_.end();
            if (!known)
                errors_.push_back(errorAt(entry.place, read.pathOf(name), entry.key, "is none of the languages"));
            if (entry.value.kind != Node::Kind::Text || entry.value.text.empty())
                errors_.push_back(
                    errorAt(entry.place, read.pathOf(name), entry.key, "must be a text that is not empty"));
        }
        for (const std::string& language : languages_)
            if (value->find(language) == nullptr)
                read.fail(name, fmt::format("the text in \"{}\" is missing", language));
        const Node* text = value->find(definition_.language);
        return text != nullptr ? text->text : "";
    }

    void readResponse(const Node& table) {
        const TableReader read(table, {"questionnaire_response"}, "response", errors_);
        Response response;
        response.kind = kindNamed(read.text("kind"));
        response.low = read.number("low");
        response.high = read.number("high");
        response.step = read.number("step");
        response.low_anchor = localText(read, "low_anchor");
        response.high_anchor = localText(read, "high_anchor");
        std::set<double> values;
        for (const Node& option : read.items("options")) {
            const TableReader each(option, {"questionnaire_option"}, "response.options", errors_);
            response.options.push_back({each.number("value"), localText(each, "text")});
            if (!values.insert(each.number("value")).second) each.fail("value", "two options have this value");
        }
        if (hasLimits(response.kind)) {
            if (!read.has("low") || !read.has("high"))
                read.fail("kind", "needs the limits `low` and `high`");
            else if (!(response.low < response.high))
                read.fail("high", "must be > low");
            else if (!leadsToHigh(response))
                read.fail("step", "must lead from low to high");
        }
        if (response.kind == AnswerKind::Choice && response.options.size() < 2)
            read.fail("options", "a choice needs at least two options");
        if (!responses_.try_emplace(read.text("name"), response).second)
            read.fail("name", "two responses have this name");
    }

    void readItem(const Node& table) {
        const TableReader read(table, {"questionnaire_item"}, "item", errors_);
        Item item;
        item.id = read.text("id");
        item.text = localText(read, "text");
        item.reversed = read.boolean("reversed");
        if (read.has("id") && itemNamed(definition_, item.id)) read.fail("id", "two items have this id");
        if (const auto found = responses_.find(read.text("response")); found != responses_.end())
            item.response = found->second;
        else if (read.has("response"))
            read.fail("response", "no response has this name");
        if (read.has("low_anchor")) item.response.low_anchor = localText(read, "low_anchor");
        if (read.has("high_anchor")) item.response.high_anchor = localText(read, "high_anchor");
        if (item.reversed && !hasLimits(item.response.kind)) read.fail("reversed", "only a number can be reversed");
        const bool pair = item.response.kind == AnswerKind::Pair;
        if (!definition_.is_template && !pair && item.text.empty())
            read.fail("text", "required: only a template (slot = true) has items without");
        if (definition_.is_template && read.has("text"))
            read.fail("text", "a template (slot = true) takes the texts from the lab's file");
        if (read.has("felt")) item.felt = feltNamed(read.text("felt"));
        definition_.items.push_back(std::move(item));
    }

    /// After all items, because a pair may stand before what it compares.
    void readPairs() {
        const auto& tables = root_.items("item");
        std::set<std::pair<std::size_t, std::size_t>> seen;
        for (std::size_t i = 0; i < tables.size(); ++i) {
            Item& item = definition_.items[i];
            const Node* pair = tables[i].find("pair");
            const bool wanted = item.response.kind == AnswerKind::Pair;
            if (pair == nullptr && !wanted) continue;
            const auto fail = [&](const char* message) {
                const TextPosition& place = pair != nullptr ? pair->place : tables[i].place;
                errors_.push_back(errorAt(place, "item.pair", pair != nullptr ? valueText(*pair) : "", message));
            };
            if (!wanted || pair == nullptr || pair->items.size() != 2) {
                fail(wanted ? "must be the ids of two items" : "only a response of kind pair compares items");
                continue;
            }
            const auto first = itemNamed(definition_, pair->items[0].text);
            const auto second = itemNamed(definition_, pair->items[1].text);
            if (!first || !second || *first == *second) {
                fail("must be the ids of two items");
                continue;
            }
            item.of = {*first, *second};
            if (item.text.empty()) item.text = definition_.items[*first].text + " / " + definition_.items[*second].text;
            if (!seen.insert(std::minmax(*first, *second)).second) fail("two items compare this pair");
        }
    }

    void readScale(const Node& table) {
        const TableReader read(table, {"questionnaire_scale"}, "scale", errors_);
        Scale scale;
        scale.name = read.text("name");
        scale.label = read.has("label") ? read.text("label") : scale.name;
        scale.formula = formulaNamed(read.text("formula"));
        scale.spread = read.number("spread");
        scale.shift = read.number("shift");
        scale.factor = read.number("factor");
        scale.max_missing = static_cast<std::size_t>(read.integer("max_missing"));
        if (read.has("name") && scaleNamed(definition_, scale.name)) read.fail("name", "two scales have this name");
        const auto collect = [&](const char* key, auto find, const char* fault) {
            std::vector<std::size_t> indices;
            for (const Node& name : read.items(key)) {
                const auto found = find(name.text);
                const bool twice = found && std::find(indices.begin(), indices.end(), *found) != indices.end();
                if (!found || twice)
                    errors_.push_back(
                        errorAt(name.place, read.pathOf(key), valueText(name), twice ? "is listed twice" : fault));
                else
                    indices.push_back(*found);
            }
            return indices;
        };
        scale.items = collect(
            "items", [&](auto& id) { return itemNamed(definition_, id); }, "no item has this id");
        scale.scales = collect(
            "scales", [&](auto& name) { return scaleNamed(definition_, name); },
            "no scale with this name stands before");
        checkScale(read, scale);
        for (const Node& node : read.items("classes")) {
            const TableReader each(node, {"questionnaire_class"}, "scale.classes", errors_);
            if (!scale.classes.empty() && !(each.number("from") > scale.classes.back().from))
                each.fail("from", "must be above that of the class before");
            scale.classes.push_back({each.text("label"), each.number("from")});
        }
        definition_.scales.push_back(std::move(scale));
    }

    void checkScale(const TableReader& read, const Scale& scale) {
        if (read.has("items") == read.has("scales")) read.fail("items", "a scale has either items or scales");
        const auto scored = [&](std::size_t i) {
            return hasLimits(definition_.items[i].response.kind) ||
                   (definition_.items[i].response.kind == AnswerKind::Choice && scale.formula != Formula::PairWeighted);
        };
        if (!std::all_of(scale.items.begin(), scale.items.end(), scored))
            read.fail("items", "a text or a pair cannot be scored");
        if (!scale.items.empty() && scale.max_missing >= scale.items.size())
            read.fail("max_missing", "must leave at least one answer");
        checkFormula(read, scale);
        if (scale.formula != Formula::PairWeighted) return;
        const auto is_pair = [](const Item& item) { return item.response.kind == AnswerKind::Pair; };
        const auto pairs = std::count_if(definition_.items.begin(), definition_.items.end(), is_pair);
        const std::size_t needed = scale.items.size() * (scale.items.size() - 1) / 2;
        if (scale.items.empty() || static_cast<std::size_t>(pairs) != needed)
            read.fail("formula", fmt::format("needs every pair of its items once: {} pairs, not {}", needed, pairs));
    }

    /// Keys that the formula has no use for, and what it needs.
    void checkFormula(const TableReader& read, const Scale& scale) {
        const bool wide = scale.formula == Formula::WideScales;
        if (wide && (scale.scales.empty() || !read.has("spread")))
            read.fail("formula", "needs `scales` and their `spread`");
        if (!wide && read.has("spread")) read.fail("spread", "is for the formula wide_scales");
        if (wide && std::any_of(scale.scales.begin(), scale.scales.end(),
                                [&](std::size_t s) { return definition_.scales[s].items.empty(); }))
            read.fail("scales", "must be scales of items");
        const bool averages = scale.formula == Formula::Mean || scale.formula == Formula::Sum;
        for (const char* key : {"shift", "max_missing"})
            if (!averages && read.has(key)) read.fail(key, "is for means and sums");
        if (!averages && !wide && read.has("scales")) read.fail("scales", "this formula is one of items");
        if (scale.formula != Formula::Laterality) return;
        for (const std::size_t i : scale.items) {
            const Response& response = definition_.items[i].response;
            const bool marks = response.kind == AnswerKind::Choice &&
                               std::all_of(response.options.begin(), response.options.end(), [](const Option& option) {
                                   return std::abs(option.value) <= 2.0 && option.value == std::round(option.value);
                               });
            if (!marks) return read.fail("items", "must be choices whose options are from -2 to 2");
        }
    }

    void readGolden(const Node& table) {
        const TableReader read(table, {"questionnaire_golden"}, "golden", errors_);
        Golden golden;
        const std::size_t before = errors_.size();
        const auto& answers = read.items("answers");
        if (answers.size() != definition_.items.size())
            return read.fail("answers",
                             fmt::format("must be {} answers, not {}", definition_.items.size(), answers.size()));
        for (std::size_t i = 0; i < answers.size(); ++i) {
            const Node& node = answers[i];
            const bool number = node.kind == Node::Kind::Number || node.kind == Node::Kind::Integer;
            Answer answer;
            if (number) answer.number = node.number;
            if (node.kind == Node::Kind::Text && node.text != "NA") answer.text = node.text;
            const bool sound = number || node.kind == Node::Kind::Text;
            const auto fault = sound ? answerFault(definition_.items[i], answer) : "must be a number, a text or \"NA\"";
            if (!fault.empty())
                errors_.push_back(errorAt(node.place, "golden.answers", valueText(node),
                                          fmt::format("item {}: {}", definition_.items[i].id, fault)));
            golden.answers.push_back(std::move(answer));
        }
        readExpected(read, golden);
        if (errors_.size() > before) return;
        for (const std::string& fault : goldenFaults(definition_, golden)) read.fail("scores", fault);
        definition_.golden.push_back(std::move(golden));
    }

    void readExpected(const TableReader& read, Golden& golden) {
        const auto each = [&](const char* key, auto take) {
            const Node* table = read.node(key);
            if (table == nullptr) return;
            if (table->kind != Node::Kind::Table) return read.fail(key, "must be a table");
            for (const Entry& entry : table->entries) {
                const auto scale = scaleNamed(definition_, entry.key);
                const char* fault = scale ? take(*scale, entry.value) : "no scale has this name";
                if (fault != nullptr)
                    errors_.push_back(
                        errorAt(entry.place, read.pathOf(key) + "." + entry.key, valueText(entry.value), fault));
            }
        };
        each("scores", [&](std::size_t scale, const Node& value) -> const char* {
            const bool number = value.kind == Node::Kind::Number || value.kind == Node::Kind::Integer;
            if (!number && value.text != "NA") return "must be a number or \"NA\"";
            golden.scores.push_back({scale, number ? std::optional(value.number) : std::nullopt, ""});
            return nullptr;
        });
        each("classes", [&](std::size_t scale, const Node& value) -> const char* {
            const auto& classes = definition_.scales[scale].classes;
            if (std::none_of(classes.begin(), classes.end(), [&](const Class& c) { return c.label == value.text; }))
                return "the scale has no class of this name";
            for (Golden::Expected& expected : golden.scores)
                if (expected.scale == scale && expected.value) expected.class_label = value.text;
            return nullptr;
        });
        if (golden.scores.empty() && !definition_.scales.empty()) read.fail("scores", "must name at least one scale");
    }

    Errors errors_;
    TableReader root_;
    std::string language_;
    std::vector<std::string> languages_;
    std::map<std::string, Response> responses_;
    Definition definition_;
};

}  // namespace

bool isQuestionnaire(const std::string& text, const std::string& file) {
    const auto document = parseDocument(text, file);
    const Node* key = document ? document->find("questionnaire") : nullptr;
    return key != nullptr && key->kind == Node::Kind::Text;
}

Result<Definition> readQuestionnaire(const std::string& text, const std::string& file, std::string_view language) {
    const auto document = parseDocument(text, file);
    if (!document) return document.errors();
    if (document->find("study") != nullptr)
        return errorAt(document->place, "", "",
                       "is a study file; wanted here is a questionnaire (`questionnaire = \"...\"`)");
    return QuestionnaireReader(*document, language).read();
}

}  // namespace passung::protocol
