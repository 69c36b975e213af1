#include "study/protocol/questionnaire_texts.h"

#include <fmt/format.h>

#include <algorithm>

#include "study/protocol/document.h"
#include "study/protocol/table_reader.h"

namespace passung::protocol {
namespace {

using namespace questionnaire;

void checkHead(const TableReader& read, const Definition& definition) {
    if (read.has("texts_for") && read.text("texts_for") != definition.key)
        read.fail("texts_for",
                  fmt::format("must be \"{}\": the questionnaire that these texts are for", definition.key));
    const auto check = [&](const char* name, double Response::*limit) {
        const auto differs = [&](const Item& item) { return item.response.*limit != read.number(name); };
        if (!read.has(name)) return;
        if (const auto item = std::find_if(definition.items.begin(), definition.items.end(), differs);
            item != definition.items.end())
            read.fail(name, fmt::format("{} is scored for answers from {} to {}", definition.key, item->response.low,
                                        item->response.high));
    };
    check("low", &Response::low);
    check("high", &Response::high);
}

/// Puts one text into its item; the item's index, if it is one.
std::optional<std::size_t> readText(const Node& table, Definition& definition, Errors& errors) {
    const TableReader read(table, {"questionnaire_text"}, "item", errors);
    const auto index = itemNamed(definition, read.text("id"));
    if (!index) {
        if (read.has("id")) read.fail("id", fmt::format("{} has no item with this id", definition.key));
        return std::nullopt;
    }
    Item& item = definition.items[*index];
    if (!item.text.empty()) read.fail("id", "two texts are for this item");
    item.text = read.text("text");
    if (read.has("low_anchor")) item.response.low_anchor = read.text("low_anchor");
    if (read.has("high_anchor")) item.response.high_anchor = read.text("high_anchor");
    if (read.has("reversed") && !definition.polarity_from_texts)
        read.fail("reversed", fmt::format("{} says itself which items are reversed", definition.key));
    else if (definition.polarity_from_texts)
        item.reversed = read.boolean("reversed");
    return index;
}

/// Items in the order of the lab's file; scales and golden vectors follow them.
void reorder(Definition& definition, const std::vector<std::size_t>& order) {
    std::vector<std::size_t> place(order.size());
    std::vector<Item> items;
    for (std::size_t i = 0; i < order.size(); ++i) {
        place[order[i]] = i;
        items.push_back(std::move(definition.items[order[i]]));
    }
    definition.items = std::move(items);
    for (Scale& scale : definition.scales)
        for (std::size_t& item : scale.items) item = place[item];
    // They were checked against the definition's own polarity.
    definition.golden.clear();
}

}  // namespace

Result<Definition> withTexts(Definition definition, const std::string& text, const std::string& file) {
    const auto document = parseDocument(text, file);
    if (!document) return document.errors();
    Errors errors;
    const TableReader read(*document, {"questionnaire_texts"}, "", errors);
    checkHead(read, definition);
    definition.language = read.text("language");
    if (read.has("instruction")) definition.instruction = read.text("instruction");
    std::vector<std::size_t> order;
    for (const Node& table : read.items("item"))
        if (const auto index = readText(table, definition, errors)) order.push_back(*index);
    for (const Item& item : definition.items)
        if (read.has("item") && item.text.empty()) read.fail("item", fmt::format("the text of {} is missing", item.id));
    tidy(errors);
    if (!errors.empty()) return errors;
    reorder(definition, order);
    return definition;
}

}  // namespace passung::protocol
