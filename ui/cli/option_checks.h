#pragma once

#include <functional>
#include <string>

namespace passung::cli {

/// What is wrong with the word of an option; empty if nothing. CLI11's own checks print the limits of the type, digit
/// by digit.
using OptionCheck = std::function<std::string(const std::string& word)>;

/// Whole numbers from `low` on that the type holds.
OptionCheck wholeFrom(int low);     // std::int64_t
OptionCheck wholeIntFrom(int low);  // int
OptionCheck wholeUnsigned();        // std::uint64_t
OptionCheck above0();
OptionCheck atLeast0();
/// `words`: "a number from 0 to 1".
OptionCheck between(double low, double high, const std::string& words);
/// A to Z.
OptionCheck capitalLetter();
/// Above 0 and below `high`.
OptionCheck above0Below(double high);

}  // namespace passung::cli
