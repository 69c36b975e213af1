#include "core/import/json_scan.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <optional>
#include <utility>

namespace passung::importer {

/// Fills a scan from left to right; what is open stands in a list instead of on the stack.
class JsonReader {
public:
    JsonReader(std::string_view text, int most_depth)
        : text_(text), most_depth_(static_cast<std::size_t>(most_depth)) {}

    bool read() {
        if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;
        if (!readValue({})) return false;
        while (!open_.empty())
            if (!readNext()) return false;
        skipSpace();
        return at_ == text_.size() || fail("more follows the end of it");
    }

    JsonScan scan;
    std::string why;

private:
    struct Open {
        JsonScan::Index value, last;
    };

    bool fail(const char* reason) {
        why = "byte " + std::to_string(at_) + " of its JSON: " + reason;
        return false;
    }

    void skipSpace() { at_ = std::min(text_.find_first_not_of(" \t\r\n", at_), text_.size()); }
    bool take(char c) {
        skipSpace();
        if (at_ >= text_.size() || text_[at_] != c) return false;
        ++at_;
        return true;
    }

    bool readString(std::string_view& string) {
        if (!take('"')) return fail("a string is wanted");
        const std::size_t begin = at_;
        while (at_ < text_.size() && text_[at_] != '"') at_ += text_[at_] == '\\' ? 2 : 1;
        if (at_ >= text_.size()) return fail("a string does not end");
        string = text_.substr(begin, at_ - begin);
        ++at_;
        return true;
    }

    /// A value behind its name, if it has one; of an object or list the beginning.
    bool readValue(std::string_view key) {
        skipSpace();
        if (at_ >= text_.size()) return fail("it ends too early");
        if (scan.values_.size() >= JsonScan::kNone) return fail("too many values");
        const auto index = static_cast<JsonScan::Index>(scan.values_.size());
        scan.values_.push_back({.key = key});
        if (!open_.empty()) {
            Open& parent = open_.back();
            (parent.last == JsonScan::kNone ? scan.values_[parent.value].first : scan.values_[parent.last].next) =
                index;
            parent.last = index;
        }
        JsonScan::Value& value = scan.values_.back();
        const char c = text_[at_];
        if (c == '{' || c == '[') {
            value.kind = c == '{' ? JsonScan::Kind::Object : JsonScan::Kind::List;
            ++at_;
            open_.push_back({index, JsonScan::kNone});
            return open_.size() <= most_depth_ ||
                   fail(("it is more than " + std::to_string(most_depth_) + " levels deep").c_str());
        }
        if (c == '"') {
            value.kind = JsonScan::Kind::String;
            return readString(value.text);
        }
        const std::size_t end = std::min(text_.find_first_of(" \t\r\n,]}:", at_), text_.size());
        value.text = text_.substr(at_, end - at_);
        const bool word = value.text == "true" || value.text == "false" || value.text == "null";
        value.kind = word ? JsonScan::Kind::Word : JsonScan::Kind::Number;
        if (!word && !scan.number(index)) return fail("no value");
        at_ = end;
        return true;
    }

    /// What comes next in the innermost object or list that is open: its end, or one more value.
    bool readNext() {
        const Open inner = open_.back();
        const bool object = scan.values_[inner.value].kind == JsonScan::Kind::Object;
        if (take(object ? '}' : ']')) {
            open_.pop_back();
            return true;
        }
        if (inner.last != JsonScan::kNone && !take(',')) return fail("a comma is wanted");
        std::string_view key;
        if (object && !(readString(key) && (take(':') || fail("a colon is wanted")))) return false;
        return readValue(key);
    }

    std::string_view text_;
    std::size_t most_depth_;
    std::size_t at_ = 0;
    std::vector<Open> open_;
};

std::optional<JsonScan> JsonScan::of(std::string_view text, int most_depth, std::string& why) {
    JsonReader reader(text, most_depth);
    const bool read = reader.read();
    why = reader.why;
    if (!read) return std::nullopt;
    return std::move(reader.scan);
}

std::optional<double> JsonScan::number(Index value) const {
    if (value == kNone) return std::nullopt;
    const std::string_view text = values_[value].text;
    double number = 0.0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (failure == std::errc::invalid_argument || end != text.data() + text.size()) return std::nullopt;
    return number;
}

JsonScan::Index JsonScan::find(Index object, std::string_view name) const {
    if (object == kNone || kind(object) != Kind::Object) return kNone;
    for (Index member = first(object); member != kNone; member = next(member))
        if (values_[member].key == name || key(member) == name) return member;
    return kNone;
}

namespace {

/// The four hexadecimal digits at `at`.
std::optional<std::uint32_t> codeAt(std::string_view text, std::size_t at) {
    std::uint32_t code = 0;
    if (at + 4 > text.size()) return std::nullopt;
    const auto [end, error] = std::from_chars(text.data() + at, text.data() + at + 4, code, 16);
    if (error != std::errc() || end != text.data() + at + 4) return std::nullopt;
    return code;
}

void appendUtf8(std::uint32_t code, std::string& text) {
    const auto put = [&](std::uint32_t bits) { text += static_cast<char>(bits); };
    if (code < 0x80) return put(code);
    if (code < 0x800) {
        put(0xC0 | code >> 6);
    } else {
        if (code < 0x10000) {
            put(0xE0 | code >> 12);
        } else {
            put(0xF0 | code >> 18);
            put(0x80 | (code >> 12 & 0x3F));
        }
        put(0x80 | (code >> 6 & 0x3F));
    }
    put(0x80 | (code & 0x3F));
}

}  // namespace

std::string JsonScan::plain(std::string_view written) {
    std::string text;
    text.reserve(written.size());
    for (std::size_t at = 0; at < written.size(); ++at) {
        if (written[at] != '\\' || at + 1 >= written.size()) {
            text += written[at];
            continue;
        }
        const char c = written[++at];
        std::optional<std::uint32_t> code = c == 'u' ? codeAt(written, at + 1) : std::nullopt;
        if (!code) {
            text += c;
            continue;
        }
        at += 4;
        // Two halves that make one character.
        if (*code >= 0xD800 && *code < 0xDC00 && written.substr(at + 1).starts_with("\\u"))
            if (const auto low = codeAt(written, at + 3); low && *low >= 0xDC00 && *low < 0xE000) {
                code = 0x10000 + ((*code - 0xD800) << 10) + (*low - 0xDC00);
                at += 6;
            }
        appendUtf8(*code, text);
    }
    return text;
}

}  // namespace passung::importer
