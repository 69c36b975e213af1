#include "study/run/log/discreet.h"

#include <pwd.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <vector>

namespace passung::run {

namespace {

constexpr std::string_view kLeftOut = "…";
constexpr std::string_view kHomes[] = {"home", "Users", "run/media", "media", "run/user"};

bool isCapital(char c) { return c >= 'A' && c <= 'Z'; }
bool isDigit(char c) { return c >= '0' && c <= '9'; }
bool isOfWord(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || static_cast<unsigned char>(c) >= 0x80;
}
bool isOfCode(char c) { return isCapital(c) || isDigit(c) || c == '_' || c == '-'; }

void replace(std::string& text, std::size_t from, std::size_t to, std::string_view with) {
    text.replace(from, to - from, with);
}

/// Where a quoted text may begin; an apostrophe within a word is none.
std::size_t quoteBegin(const std::string& text, char mark) {
    std::size_t at = text.find(mark);
    while (mark == '\'' && at != std::string::npos && at > 0 && isOfWord(text[at - 1])) at = text.find(mark, at + 1);
    return at;
}

/// A quoted text may hold quotation marks itself: of several only the outer ones are sure to be ours.
void leaveOutQuoted(std::string& text, char mark) {
    const std::size_t first = quoteBegin(text, mark);
    if (first == std::string::npos) return;
    const std::size_t last = text.rfind(mark);
    replace(text, first + 1, last == first ? text.size() : last, kLeftOut);
}

/// Puts `with` for `word` wherever that is a whole word; one that begins with a slash may stand in a longer path.
void replaceWord(std::string& text, std::string_view word, std::string_view with) {
    for (std::size_t at = 0; (at = text.find(word, at)) != std::string::npos;) {
        const std::size_t end = at + word.size();
        const bool whole =
            (end == text.size() || !isOfWord(text[end])) && (at == 0 || word.front() == '/' || !isOfWord(text[at - 1]));
        if (whole) replace(text, at, end, with);
        at += whole ? with.size() : 1;
    }
}

/// The folder below `parent`, whoever's it is.
void shortenBelow(std::string& text, std::string_view parent) {
    for (std::size_t at = 0; (at = text.find(parent, at)) != std::string::npos; ++at) {
        const std::size_t name = at + parent.size();
        std::size_t end = text.find('/', name);
        if (end == std::string::npos) end = std::min(text.find_first_of(" :,;)", name), text.size());
        replace(text, at, end, "~");
    }
}

/// Of this user, by the system and by the environment.
std::vector<std::string> userNames() {
    std::vector<std::string> names;
    if (const passwd* user = getpwuid(geteuid()); user != nullptr) names.emplace_back(user->pw_name);
    for (const char* variable : {"USER", "LOGNAME", "SUDO_USER"})
        if (const char* value = std::getenv(variable); value != nullptr) names.emplace_back(value);
    std::erase(names, "");
    return names;
}

void leaveOutHomes(std::string& text) {
    if (const char* home = std::getenv("HOME"); home != nullptr && std::string_view(home).size() > 1)
        replaceWord(text, home, "~");
    for (const std::string_view parent : kHomes) shortenBelow(text, "/" + std::string(parent) + "/");
    static const std::vector<std::string> names = userNames();  // once: the system may ask a server
    for (const std::string& name : names) replaceWord(text, "/" + name, "/~");
}

/// Codes are of capitals, digits, '_' and '-', a capital first, a digit last.
std::string withoutCodes(std::string_view text) {
    std::string rest;
    while (!text.empty()) {
        const auto length =
            static_cast<std::size_t>(std::find_if_not(text.begin(), text.end(), isOfCode) - text.begin());
        const std::string_view run = text.substr(0, length);
        const auto first = static_cast<std::size_t>(std::find_if(run.begin(), run.end(), isCapital) - run.begin());
        const auto last = static_cast<std::size_t>(run.rend() - std::find_if(run.rbegin(), run.rend(), isDigit));
        if (first < last)
            rest.append(run.substr(0, first)).append(kLeftOut).append(run.substr(last));
        else
            rest.append(run);
        rest.append(text.substr(length, 1));
        text.remove_prefix(std::min(length + 1, text.size()));
    }
    return rest;
}

/// Cut before the first character that has no place any more.
void limit(std::string& text) {
    if (text.size() <= kLongestLine) return;
    std::size_t end = kLongestLine - kLeftOut.size();
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) --end;  // within a character of UTF-8
    replace(text, end, text.size(), kLeftOut);
}

}  // namespace

std::string discreet(std::string_view what, std::span<const std::string> names) {
    std::string text(what);
    for (char& c : text)
        if (static_cast<unsigned char>(c) < ' ' || c == '\x7f') c = ' ';
    for (const char mark : {'"', '\''}) leaveOutQuoted(text, mark);
    leaveOutHomes(text);
    for (const std::string& name : names)
        if (!name.empty()) replaceWord(text, name, kLeftOut);
    text = withoutCodes(text);
    limit(text);
    return text;
}

}  // namespace passung::run
