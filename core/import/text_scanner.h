#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

#include "core/base/result.h"
#include "core/base/types.h"

namespace passung::importer {

/// Takes a text apart into lines and the words of a line.
class TextScanner {
public:
    TextScanner(std::string_view text, const std::string& file) : rest_(text), file_(file) {}

    /// Goes to the next line that holds words, `comment` and what follows it cut off (0: there are no comments); false
    /// at the end of the text.
    bool nextLine(char comment) {
        while (!rest_.empty()) {
            const std::size_t end = rest_.find('\n');
            words_ = rest_.substr(0, end);
            rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
            ++line_;
            if (comment != 0) words_ = words_.substr(0, words_.find(comment));
            skipSpace();
            if (!words_.empty()) return true;
        }
        words_ = {};
        return false;
    }

    /// The next word of the line, empty at its end.
    std::string_view word() {
        skipSpace();
        const std::size_t end = words_.find_first_of(kSpace);
        const std::string_view word = words_.substr(0, end);
        words_.remove_prefix(word.size());
        return word;
    }

    /// What follows the current line.
    std::string_view rest() const { return rest_; }
    bool atLineEnd() {
        skipSpace();
        return words_.empty();
    }

    Error error(const std::string& message, std::string_view value = {}) const {
        constexpr std::size_t kLongest = 40;  // of what is quoted
        std::string quoted(value.substr(0, kLongest));
        for (char& c : quoted)
            if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) > 0x7e) c = '?';
        Error error{.message = message, .file = file_, .value = quoted};
        error.line = line_;
        error.column = line_ > 0 ? 1 : 0;
        return error;
    }

private:
    static constexpr std::string_view kSpace = " \t\r\v\f";
    void skipSpace() { words_.remove_prefix(std::min(words_.find_first_not_of(kSpace), words_.size())); }

    std::string_view rest_, words_;
    std::string file_;
    int line_ = 0;
};

/// The whole word as a number of type T; nothing if it is none or out of range.
template <class T>
std::optional<T> numberIn(std::string_view word) {
    if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
    T value{};
    const auto [end, failure] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (failure != std::errc() || end != word.data() + word.size()) return std::nullopt;
    return value;
}

/// A coordinate: finite, too. A number too small for a double is 0.
inline std::optional<double> coordinateIn(std::string_view word) {
    if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
    double value = 0.0;
    const auto [end, failure] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (end != word.data() + word.size() || end == word.data()) return std::nullopt;
    if (failure == std::errc::result_out_of_range) {
        // Too large or too small: its first digit says, that is not 0, with the exponent.
        const std::size_t exponent_at = std::min(word.find_first_of("eE"), word.size());
        const std::string_view digits = word.substr(0, exponent_at);
        const std::size_t point = std::min(digits.find('.'), digits.size()), first = digits.find_first_not_of("-0.");
        if (first == std::string_view::npos) return 0.0;
        int exponent = 0;
        if (exponent_at < word.size()) {
            std::string_view power = word.substr(exponent_at + 1);
            const bool negative = power.starts_with('-');
            if (negative || power.starts_with('+')) power.remove_prefix(1);
            const auto read = std::from_chars(power.data(), power.data() + power.size(), exponent);
            if (read.ec == std::errc::result_out_of_range) return negative ? std::optional(0.0) : std::nullopt;
            if (negative) exponent = -exponent;
        }
        const bool tiny = static_cast<double>(point) - static_cast<double>(first) + exponent < 0.0;
        return tiny ? std::optional(0.0) : std::nullopt;
    }
    if (failure != std::errc() || !std::isfinite(value)) return std::nullopt;
    return value;
}

/// The next three words as a vertex.
inline Result<Vec3> takeVertex(TextScanner& text) {
    Vec3 v;
    for (double& coordinate : v) {
        const std::string_view word = text.word();
        const auto value = coordinateIn(word);
        if (!value) return text.error("a vertex needs three finite numbers", word);
        coordinate = *value;
    }
    return v;
}

}  // namespace passung::importer
