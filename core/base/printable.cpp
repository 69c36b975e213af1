#include "core/base/printable.h"

#include <array>
#include <cstdio>

namespace passung {

namespace {

unsigned byteAt(std::string_view text, std::size_t at) { return static_cast<unsigned char>(text[at]); }

/// Bytes of the character that begins with `first`; 0 if none does.
std::size_t lengthOf(unsigned first) {
    if (first < 0x80) return 1;
    if (first >= 0xc2 && first <= 0xdf) return 2;
    if (first >= 0xe0 && first <= 0xef) return 3;
    if (first >= 0xf0 && first <= 0xf4) return 4;
    return 0;
}

/// A character of UTF-8, or one byte that is none.
struct Character {
    std::size_t bytes = 1;
    unsigned code = 0;
    bool sound = false;
};

Character characterAt(std::string_view text, std::size_t at) {
    const unsigned first = byteAt(text, at);
    const std::size_t length = lengthOf(first);
    if (length == 0 || at + length > text.size()) return {1, first, false};
    if (length == 1) return {1, first, true};
    unsigned code = first & (0xffu >> (length + 1));
    for (std::size_t i = 1; i < length; ++i) {
        const unsigned next = byteAt(text, at + i);
        if ((next & 0xc0u) != 0x80u) return {1, first, false};
        code = code << 6 | (next & 0x3fu);
    }
    constexpr std::array<unsigned, 5> kLeast{0, 0, 0x80, 0x800, 0x10000};
    const bool sound = code >= kLeast[length] && code <= 0x10ffff && !(code >= 0xd800 && code <= 0xdfff);
    return sound ? Character{length, code, true} : Character{1, first, false};
}

bool isControl(unsigned code) { return code < 0x20 || (code >= 0x7f && code <= 0x9f); }

/// Does it act on a terminal, or on what stands around it, instead of being seen?
bool acts(unsigned code) {
    const bool direction = code == 0x061c || code == 0x200e || code == 0x200f || (code >= 0x202a && code <= 0x202e) ||
                           (code >= 0x2066 && code <= 0x2069);
    const bool line = code == 0x2028 || code == 0x2029;
    return isControl(code) || direction || line;
}

void appendCode(std::string& out, const char* format, unsigned code) {
    std::array<char, 16> text{};
    std::snprintf(text.data(), text.size(), format, code);
    out += text.data();
}

void appendWritten(std::string& out, const Character& c) {
    if (c.sound && c.code == '\n')
        out += "\\n";
    else if (c.sound && c.code == '\t')
        out += "\\t";
    else if (c.code < 0x100)
        appendCode(out, c.sound && c.code >= 0x80 ? "\\u%04x" : "\\x%02x", c.code);
    else
        appendCode(out, "\\u%04x", c.code);
}

std::string written(std::string_view text, std::string_view kept) {
    std::string out;
    out.reserve(text.size());
    for (std::size_t at = 0; at < text.size();) {
        const Character c = characterAt(text, at);
        const bool stays = c.sound && (!acts(c.code) || (c.bytes == 1 && kept.find(text[at]) != kept.npos));
        if (stays)
            out += text.substr(at, c.bytes);
        else
            appendWritten(out, c);
        at += c.bytes;
    }
    return out;
}

}  // namespace

std::string printable(std::string_view text) { return written(text, ""); }

std::string printableLines(std::string_view text, bool returns) { return written(text, returns ? "\n\t\r" : "\n\t"); }

bool holdsControls(std::string_view text) {
    for (std::size_t at = 0; at < text.size();) {
        const Character c = characterAt(text, at);
        if (isControl(c.code) && c.code != '\n' && c.code != '\t') return true;
        at += c.bytes;
    }
    return false;
}

std::size_t cutOff(std::string_view text) {
    for (std::size_t back = 1; back <= 3 && back <= text.size(); ++back) {
        const unsigned byte = byteAt(text, text.size() - back);
        if ((byte & 0xc0u) == 0x80u) continue;
        return lengthOf(byte) > back ? back : 0;
    }
    return 0;
}

}  // namespace passung
