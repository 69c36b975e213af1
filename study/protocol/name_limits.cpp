#include "study/protocol/name_limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace passung::protocol {
namespace {

constexpr std::array<std::string_view, 5> kNames{"name", "clause", "id", "questionnaire", "texts_for"};

bool isLong(const std::string& text) {
    const auto letters = std::count_if(text.begin(), text.end(),
                                       [](char c) { return (static_cast<unsigned char>(c) & 0xc0u) != 0x80u; });
    return static_cast<std::size_t>(letters) > kMostLetters;
}

class NameCheck {
public:
    explicit NameCheck(Errors& errors) : errors_(errors) {}

    void checkTable(const Node& table, const std::string& path) {
        for (const auto& [key, place, value] : table.entries) {
            const std::string at = path.empty() ? key : fmt::format("{}.{}", path, key);
            const bool version = at == "study.version";
            if (value.kind == Node::Kind::Text && version && value.text.find_first_of("\n\r\t") != std::string::npos)
                report(value, at, valueText(value), "must be one line without tabs");
            if (value.kind == Node::Kind::Text && (version || std::count(kNames.begin(), kNames.end(), key) > 0) &&
                isLong(value.text))
                report(value, at, valueText(value), fmt::format("must have at most {} letters", kMostLetters));
            if (at == "factor.levels") checkLevels(table, value);
            if (value.kind == Node::Kind::Table) checkTable(value, at);
            for (const Node& item : value.items)
                if (item.kind == Node::Kind::Table) checkTable(item, at);
        }
    }

private:
    void checkLevels(const Node& factor, const Node& levels) {
        const Node* name = factor.find("name");
        for (const Node& level : levels.items) {
            const Node* own = level.find("label");
            const Node* value = own != nullptr ? own : level.find("value");
            const std::string label = labelText(level.kind != Node::Kind::Table ? level
                                                : value != nullptr              ? *value
                                                                                : level);
            if (isLong(label))
                report(level, fmt::format("factor.{}.levels", name != nullptr ? name->text : ""),
                       fmt::format("\"{}\"", label), fmt::format("a label must have at most {} letters", kMostLetters));
        }
    }

    void report(const Node& node, std::string path, std::string value, std::string message) {
        errors_.push_back(errorAt(node.place, std::move(path), std::move(value), std::move(message)));
    }

    Errors& errors_;
};

}  // namespace

void checkNames(const Node& document, Errors& errors) { NameCheck(errors).checkTable(document, ""); }

}  // namespace passung::protocol
