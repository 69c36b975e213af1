#include "study/protocol/document.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <tuple>
#include <utility>

#include "core/base/printable.h"
#include "study/protocol/text_limits.h"

namespace passung::protocol {
namespace {

constexpr std::size_t kMostShown = 200;  // bytes of a key or value in a message

TextPosition placeOf(const toml::source_region& region, const std::string& file) {
    // The parser leaves 0 where a value has no place of its own (the top-level table).
    return {file, std::max(1, static_cast<int>(region.begin.line)), std::max(1, static_cast<int>(region.begin.column))};
}

const char* otherKind(toml::node_type type) {
    switch (type) {
        case toml::node_type::date:
            return "a date";
        case toml::node_type::time:
            return "a time";
        default:
            return "a date and time";
    }
}

Node convert(const toml::node& source, const std::string& file);

void convertTable(const toml::table& table, const std::string& file, Node& node) {
    node.kind = Node::Kind::Table;
    for (const auto& [key, value] : table)
        node.entries.push_back({std::string(key.str()), placeOf(key.source(), file), convert(value, file)});
    std::stable_sort(node.entries.begin(), node.entries.end(), [](const Entry& a, const Entry& b) {
        return std::tie(a.place.line, a.place.column) < std::tie(b.place.line, b.place.column);
    });
}

Node convert(const toml::node& source, const std::string& file) {
    Node node;
    node.place = placeOf(source.source(), file);
    if (const auto* table = source.as_table()) {
        convertTable(*table, file, node);
    } else if (const auto* list = source.as_array()) {
        node.kind = Node::Kind::List;
        for (const auto& item : *list) node.items.push_back(convert(item, file));
    } else if (const auto* boolean = source.as_boolean()) {
        node.kind = Node::Kind::Boolean;
        node.boolean = boolean->get();
    } else if (const auto* integer = source.as_integer()) {
        node.kind = Node::Kind::Integer;
        node.integer = integer->get();
        node.number = static_cast<double>(node.integer);
    } else if (const auto* number = source.as_floating_point()) {
        node.kind = Node::Kind::Number;
        node.number = number->get();
    } else if (const auto* text = source.as_string()) {
        node.kind = Node::Kind::Text;
        node.text = text->get();
    } else {
        node.kind = Node::Kind::Other;
        node.text = otherKind(source.type());
    }
    return node;
}

/// Text of a number as a file may hold it: 1.0 is not the integer 1.
std::string numberText(double number) {
    std::string text = fmt::format("{}", number);
    if (text.find_first_not_of("-0123456789") == std::string::npos) text += ".0";
    return text;
}

/// One line stays readable, however long a key or value is.
std::string shortened(std::string text) {
    if (text.size() <= kMostShown) return text;
    text.resize(kMostShown);
    text.resize(text.size() - cutOff(text));
    return text + "...";
}

/// Reports keys and texts with control characters, which no file needs and a terminal would obey.
void refuseControls(const Node& node, Errors& errors) {
    constexpr const char* kRefused = "must hold no control characters";
    if (node.kind == Node::Kind::Text && holdsControls(node.text))
        errors.push_back(errorAt(node.place, "", valueText(node), kRefused));
    for (const Node& item : node.items) refuseControls(item, errors);
    for (const Entry& entry : node.entries) {
        if (holdsControls(entry.key) || entry.key.find_first_of("\n\t") != std::string::npos)
            errors.push_back(errorAt(entry.place, entry.key, "", kRefused));
        refuseControls(entry.value, errors);
    }
}

}  // namespace

const Node* Node::find(std::string_view key) const {
    for (const auto& entry : entries)
        if (entry.key == key) return &entry.value;
    return nullptr;
}

Node* Node::find(std::string_view key) { return const_cast<Node*>(std::as_const(*this).find(key)); }

std::optional<FileKind> kindOf(const Node& document) {
    if (document.find("study") != nullptr) return FileKind::Study;
    for (const char* key : {"contact", "device", "registration", "start_gate", "effects"})
        if (document.find(key) != nullptr) return FileKind::Scene;
    if (document.find("part") != nullptr) return FileKind::Part;
    if (document.find("passung") != nullptr) return FileKind::Study;  // whose [study] is missing
    return std::nullopt;
}

std::optional<std::string> otherKind(const Node& document, FileKind wanted) {
    const auto kind = kindOf(document);
    if (!kind || *kind == wanted || (*kind == FileKind::Part && wanted == FileKind::Scene)) return std::nullopt;
    const auto name = [](FileKind k) {
        return k == FileKind::Study   ? "a study file (it has a [study])"
               : k == FileKind::Scene ? "a scene file ([[part]], [contact], [device] at its top level, no [study])"
                                      : "a part file ([[part]] and nothing else)";
    };
    return fmt::format("is {}; wanted here is {}", name(*kind), name(wanted));
}

Node emptyTable(const TextPosition& place) {
    Node node;
    node.place = place;
    return node;
}

Result<Node> parseDocument(const std::string& text, const std::string& file) {
    if (const auto beyond = beyondLimits(text, file)) return *beyond;
    try {
        const auto table = toml::parse(std::string_view(text), std::string_view(file));
        Node document = convert(table, file);
        Errors errors;
        refuseControls(document, errors);
        if (!errors.empty()) return errors;
        return document;
    } catch (const toml::parse_error& error) {
        std::string_view description = error.description();
        constexpr std::string_view kPrefix = "Error while ";
        if (description.starts_with(kPrefix)) description.remove_prefix(kPrefix.size());
        return errorAt(placeOf(error.source(), file), "", "", fmt::format("not valid TOML: {}", description));
    }
}

std::string kindText(const Node& node) {
    switch (node.kind) {
        case Node::Kind::Boolean:
            return "a boolean";
        case Node::Kind::Integer:
            return "an integer";
        case Node::Kind::Number:
            return "a number";
        case Node::Kind::Text:
            return "a string";
        case Node::Kind::List:
            return "a list";
        case Node::Kind::Table:
            return "a table";
        case Node::Kind::Other:
            return node.text;
    }
    return "";
}

std::string labelText(const Node& node) {
    return node.kind == Node::Kind::Text     ? node.text
           : node.kind == Node::Kind::Number ? fmt::format("{}", node.number)
                                             : valueText(node);
}

std::string valueText(const Node& node) {
    switch (node.kind) {
        case Node::Kind::Boolean:
            return node.boolean ? "true" : "false";
        case Node::Kind::Integer:
            return fmt::format("{}", node.integer);
        case Node::Kind::Number:
            return numberText(node.number);
        case Node::Kind::Text:
            return fmt::format("\"{}\"", node.text);
        case Node::Kind::Table:
            return "{...}";
        case Node::Kind::Other:
            return node.text;
        case Node::Kind::List:
            break;
    }
    std::string text;
    for (const auto& item : node.items) {
        if (!text.empty()) text += ", ";
        text += valueText(item);
    }
    return fmt::format("[{}]", text);
}

Error errorAt(const TextPosition& place, std::string key, std::string value, std::string message) {
    return {.message = std::move(message),
            .file = place.file,
            .line = place.line,
            .column = place.column,
            .key = shortened(std::move(key)),
            .value = shortened(std::move(value))};
}

void tidy(Errors& errors) {
    const auto fields = [](const Error& e) { return std::tie(e.file, e.line, e.column, e.key, e.value, e.message); };
    std::stable_sort(errors.begin(), errors.end(),
                     [&](const Error& a, const Error& b) { return fields(a) < fields(b); });
    errors.erase(std::unique(errors.begin(), errors.end(),
                             [&](const Error& a, const Error& b) { return fields(a) == fields(b); }),
                 errors.end());
}

}  // namespace passung::protocol
