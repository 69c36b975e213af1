#include "study/protocol/contact_edit.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <utility>

#include "study/protocol/document.h"
#include "study/protocol/factors.h"
#include "study/protocol/include.h"

namespace passung::protocol {
namespace {

using EditOutcome = ContactEdit::Outcome;

constexpr std::string_view kBlanks = " \t";

std::string pathOf(const ContactKey& key) { return "contact." + key.name; }

/// Where something in the study changes a key of its scenes.
struct Setter {
    std::string who;  // in words
    TextPosition place;
    std::string path;
};

void addSetters(const Node& table, const std::string& who, std::vector<Setter>& setters) {
    if (const Node* key = table.find("key"); key != nullptr && key->kind == Node::Kind::Text)
        setters.push_back({who, key->place, key->text});
    if (const Node* set = table.find("set"))
        for (const Entry& entry : set->entries) setters.push_back({who, entry.place, entry.key});
    if (const Node* levels = table.find("levels"))
        for (const Node& level : levels->items) addSetters(level, who, setters);
}

std::vector<Setter> settersOf(const Node& document) {
    std::vector<Setter> setters;
    for (const char* kind : {"factor", "block", "staircase"}) {
        const Node* tables = document.find(kind);
        if (tables == nullptr) continue;
        for (const Node& table : tables->items) {
            const Node* name = table.find("name");
            addSetters(table, fmt::format("{} {}", kind, name != nullptr ? name->text : ""), setters);
        }
    }
    return setters;
}

ContactEdit refused(const std::string& path, std::string message, int line = 0) {
    return {EditOutcome::Refused,
            {},
            {.message = std::move(message),
             .file = path,
             .line = line,
             .column = line > 0 ? 1 : 0,
             .key = "scene.contact"}};
}

/// Bytes from `begin` up to `end`.
struct Span {
    std::size_t begin = 0, end = 0;
};

/// The file's own text, of which the parser saw the included one.
class Source {
public:
    Source(const std::string& text, const std::string& path, const IncludedText& included)
        : text_(text), path_(path), included_(included), lines_{0} {
        for (std::size_t i = 0; i < text.size(); ++i)
            if (text[i] == '\n') lines_.push_back(i + 1);
    }

    /// Tells whether the parser's place is in the file itself.
    bool holds(const toml::source_position& place) const { return placeOf(place).file == path_; }
    int lineOf(const toml::source_position& place) const { return placeOf(place).line; }

    std::size_t byteOf(const toml::source_position& place) const {
        std::size_t at = beginOf(lineOf(place));
        for (toml::source_index column = 1; column < place.column && at < text_.size(); ++column) {
            ++at;
            while (at < text_.size() && (static_cast<unsigned char>(text_[at]) & 0xC0U) == 0x80U) ++at;
        }
        return at;
    }
    Span spanOf(const toml::source_region& region) const { return {byteOf(region.begin), byteOf(region.end)}; }
    std::size_t beginOf(int line) const { return lines_[static_cast<std::size_t>(line) - 1]; }
    /// Where the line that holds `at` ends, before its end of line.
    std::size_t endOfLine(std::size_t at) const {
        const std::size_t end = std::min(text_.find('\n', at), text_.size());
        return end > at && text_[end - 1] == '\r' ? end - 1 : end;
    }
    const std::string& text() const { return text_; }
    std::string newLine() const { return text_.find("\r\n") != std::string::npos ? "\r\n" : "\n"; }

private:
    TextPosition placeOf(const toml::source_position& place) const {
        TextPosition position{path_, static_cast<int>(place.line), 1};
        relocate(included_, position);
        return position;
    }

    const std::string& text_;
    const std::string& path_;
    const IncludedText& included_;
    std::vector<std::size_t> lines_;  // first byte of each
};

/// What stands in the place of some bytes.
struct Patch {
    Span span;
    std::string text;
};

/// The bytes of a key that goes, in a table with a line for each key.
Span lineSpan(const Source& source, const Span& key, const Span& value) {
    const std::string& text = source.text();
    const std::size_t before = text.rfind('\n', key.begin);
    Span span{before == std::string::npos ? 0 : before + 1, value.end};
    span.end = std::min(text.find_first_not_of(kBlanks, value.end), text.size());
    const std::size_t end = source.endOfLine(value.end);
    if (span.end >= end) span.end = std::min(text.find('\n', end), text.size() - 1) + 1;
    return span;
}

/// The same in an inline table, with one of its commas.
Span inlineSpan(const Source& source, const Span& key, const Span& value) {
    const std::string& text = source.text();
    std::size_t next = text.find_first_not_of(kBlanks, value.end);
    if (next < text.size() && text[next] == ',') return {key.begin, text.find_first_not_of(kBlanks, next + 1)};
    const std::size_t last = text.find_last_not_of(kBlanks, key.begin - 1);
    return {text[last] == ',' ? last : key.begin, value.end};
}

/// Finds the patches of a table that is there.
class TableEdit {
public:
    TableEdit(const Source& source, const toml::table& contact) : source_(source), contact_(contact) {
        for (const auto& [name, value] : contact) {
            const Span at = source.spanOf(value.source());
            if (at.end < last_value_.end) continue;
            last_key_ = source.spanOf(name.source());
            last_value_ = at;
        }
    }

    void change(const ContactKey& key) {
        for (const auto& [name, value] : contact_) {
            if (name.str() != key.name) continue;
            const Span at = source_.spanOf(value.source());
            if (!key.value.empty()) {
                patches_.push_back({at, key.value});
                return;
            }
            removed_.emplace_back(source_.spanOf(name.source()), at);
            return;
        }
        if (!key.value.empty()) added_.push_back(fmt::format("{} = {}", key.name, key.value));
    }

    /// A key that comes takes the place of one that goes.
    std::vector<Patch> take() {
        const std::size_t swaps = std::min(added_.size(), removed_.size());
        for (std::size_t i = 0; i < removed_.size(); ++i) {
            const auto& [key, value] = removed_[i];
            if (i < swaps)
                patches_.push_back({{key.begin, value.end}, added_[i]});
            else
                patches_.push_back(
                    {contact_.is_inline() ? inlineSpan(source_, key, value) : lineSpan(source_, key, value), ""});
        }
        added_.erase(added_.begin(), added_.begin() + static_cast<std::ptrdiff_t>(swaps));
        if (!added_.empty()) patches_.push_back(addition());
        return std::move(patches_);
    }

private:
    Patch addition() const {
        const std::string& text = source_.text();
        std::string all;
        if (contact_.is_inline()) {
            const std::size_t at = contact_.empty() ? source_.byteOf(contact_.source().begin) + 1 : last_value_.end;
            for (const std::string& line : added_) all += (all.empty() && contact_.empty() ? " " : ", ") + line;
            return {{at, at}, all};
        }
        const std::size_t from = contact_.empty() ? source_.byteOf(contact_.source().begin) : last_key_.begin;
        const std::size_t before = text.rfind('\n', from);
        const std::size_t begin = before == std::string::npos || from == 0 ? 0 : before + 1;
        const std::string lead = contact_.empty() ? "" : text.substr(begin, from - begin);  // of a dotted key its table
        const std::size_t at = source_.endOfLine(contact_.empty() ? from : last_value_.end);
        for (const std::string& line : added_) all += source_.newLine() + lead + line;
        return {{at, at}, all};
    }

    const Source& source_;
    const toml::table& contact_;
    Span last_key_, last_value_;
    std::vector<Patch> patches_;
    std::vector<std::pair<Span, Span>> removed_;  // keys with their values
    std::vector<std::string> added_;
};

std::string patched(const std::string& text, std::vector<Patch> patches) {
    std::stable_sort(patches.begin(), patches.end(),
                     [](const Patch& a, const Patch& b) { return a.span.begin > b.span.begin; });
    std::string result = text;
    for (const Patch& patch : patches) result.replace(patch.span.begin, patch.span.end - patch.span.begin, patch.text);
    return result;
}

/// A table at the end of a study that has none.
std::string withTable(const Source& source, std::span<const ContactKey> keys) {
    std::string text = source.text();
    if (!text.empty() && text.back() != '\n') text += source.newLine();
    text += source.newLine() + "[scene.contact]" + source.newLine();
    for (const ContactKey& key : keys)
        if (!key.value.empty()) text += fmt::format("{} = {}{}", key.name, key.value, source.newLine());
    return text;
}

bool sameValues(const Node& a, const Node& b) {
    if (a.kind != b.kind || a.boolean != b.boolean || a.integer != b.integer || a.number != b.number ||
        a.text != b.text || a.items.size() != b.items.size() || a.entries.size() != b.entries.size())
        return false;
    for (std::size_t i = 0; i < a.items.size(); ++i)
        if (!sameValues(a.items[i], b.items[i])) return false;
    return std::all_of(a.entries.begin(), a.entries.end(), [&](const Entry& entry) {
        const Node* other = b.find(entry.key);
        return other != nullptr && sameValues(entry.value, *other);
    });
}

/// The document as it is to be read after the change.
Result<Node> changedDocument(Node document, std::span<const ContactKey> keys) {
    Node* scene = document.find("scene");
    if (scene == nullptr) return Error{.message = "has no [scene]"};
    if (scene->find("contact") == nullptr)
        scene->entries.push_back({"contact", scene->place, emptyTable(scene->place)});
    Node& contact = *scene->find("contact");
    for (const ContactKey& key : keys) {
        std::erase_if(contact.entries, [&](const Entry& entry) { return entry.key == key.name; });
        if (key.value.empty()) continue;
        auto value = parseDocument(key.name + " = " + key.value, "");
        if (!value) return value.errors();
        contact.entries.push_back(std::move(value->entries.front()));
    }
    return document;
}

/// The keys that are to be written, or what sets one of them elsewhere.
std::optional<ContactEdit> choose(const Node& document, std::span<const ContactKey> keys,
                                  std::vector<ContactKey>& written) {
    const std::vector<Setter> setters = settersOf(document);
    for (const ContactKey& key : keys) {
        const auto setter =
            std::find_if(setters.begin(), setters.end(), [&](const Setter& s) { return overlap(s.path, pathOf(key)); });
        if (setter == setters.end()) {
            written.push_back(key);
        } else if (!key.holds_already) {
            return ContactEdit{EditOutcome::SetElsewhere,
                               {},
                               errorAt(setter->place, pathOf(key), "", fmt::format("is set by {}", setter->who))};
        }
    }
    return std::nullopt;
}

/// True if the changed text says what it should, and nothing else than before.
bool saysSo(const std::string& text, const std::string& path, const Node& wanted) {
    const auto included = includeFiles(text, path);
    if (!included) return false;
    const auto read = parseDocument(included->text, path);
    return read && sameValues(*read, wanted);
}

}  // namespace

ContactEdit editContact(const std::string& text, const std::string& path, std::span<const ContactKey> keys) {
    const auto included = includeFiles(text, path);
    if (!included) return {EditOutcome::Refused, {}, included.errors().front()};
    auto document = parseDocument(included->text, path);
    if (!document) return {EditOutcome::Refused, {}, document.errors().front()};
    relocate(*included, *document);
    std::vector<ContactKey> written;
    if (auto elsewhere = choose(*document, keys, written)) return *std::move(elsewhere);
    const auto wanted = changedDocument(*document, written);
    if (!wanted) return refused(path, wanted.errors().front().message);
    if (sameValues(*document, *wanted)) return {EditOutcome::Unchanged, text, {}};

    const Source source(text, path, *included);
    const toml::table parsed = toml::parse(std::string_view(included->text), std::string_view(path));
    const toml::table* contact = parsed["scene"]["contact"].as_table();
    std::string changed;
    if (contact == nullptr) {
        changed = withTable(source, written);
    } else {
        if (!source.holds(contact->source().begin)) {
            const Node& table = *document->find("scene")->find("contact");
            return refused(table.place.file,
                           "stands in an included file, which other studies may share: change it there",
                           table.place.line);
        }
        TableEdit edit(source, *contact);
        for (const ContactKey& key : written) edit.change(key);
        changed = patched(text, edit.take());
    }
    if (!saysSo(changed, path, *wanted))
        return refused(path, "is written in a way that no key can be put into: write it as a table of its own");
    return {EditOutcome::Changed, std::move(changed), {}};
}

}  // namespace passung::protocol
