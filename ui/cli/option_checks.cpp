#include "ui/cli/option_checks.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdint>
#include <string_view>

namespace passung::cli {

namespace {

template <class Number, class Accept>
OptionCheck numberThat(Accept accept, const std::string& requirement) {
    return [accept, requirement](const std::string& text) {
        const std::string_view digits = text.starts_with('+') ? std::string_view(text).substr(1) : text;
        Number value{};
        const auto [end, problem] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
        const bool read = problem == std::errc() && end == digits.data() + digits.size();
        return read && accept(value) ? std::string() : "must be " + requirement + ", not \"" + text + '"';
    };
}

template <class Number>
OptionCheck wholeOf(int low) {
    return numberThat<Number>([low](Number value) { return value >= static_cast<Number>(low); },
                              fmt::format("a whole number ≥ {}", low));
}

}  // namespace

OptionCheck wholeFrom(int low) { return wholeOf<std::int64_t>(low); }
OptionCheck wholeIntFrom(int low) { return wholeOf<int>(low); }
OptionCheck wholeUnsigned() { return wholeOf<std::uint64_t>(0); }

OptionCheck above0() {
    return numberThat<double>([](double value) { return std::isfinite(value) && value > 0.0; }, "a number > 0");
}

OptionCheck atLeast0() {
    return numberThat<double>([](double value) { return std::isfinite(value) && value >= 0.0; }, "a number ≥ 0");
}

OptionCheck between(double low, double high, const std::string& words) {
    return numberThat<double>([low, high](double value) { return value >= low && value <= high; }, words);
}

OptionCheck capitalLetter() {
    return [](const std::string& text) {
        const bool good = text.size() == 1 && text[0] >= 'A' && text[0] <= 'Z';
        return good ? std::string() : "must be a capital letter, A for the first, not \"" + text + '"';
    };
}

OptionCheck above0Below(double high) {
    return numberThat<double>([high](double value) { return value > 0.0 && value < high; },
                              fmt::format("a number above 0 and below {}", high));
}

}  // namespace passung::cli
