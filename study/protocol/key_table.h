#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/device_description.h"

namespace passung::protocol {

/// What may stand behind a key.
enum class KeyType {
    Boolean,
    Integer,
    Number,
    Text,
    Name,          // lower-case identifier
    Choice,        // one of a few words
    Length,        // number in the file's `unit`
    LengthVector,  // three of them
    Depth,         // a length or "through"
    Vector,        // three numbers
    Stiffness,     // number, "max" or "0.7 max"
    Table,
    Tables,  // list of tables
    Texts,   // list of strings
    Levels,  // values of a factor
    Any,
};

/// Range of a number, in the unit of the key.
struct Range {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    bool low_excluded = false;
};

/// One row: everything that reader, messages and documentation know of a key.
struct Key {
    std::string_view table;  // id of the table that it belongs to
    std::string_view name;
    KeyType type;
    Range range;
    std::string_view choices;   // of a Choice: "a|b|c"
    std::string_view fallback;  // value if absent; "!" = required; "(words)" = not a plain value
    std::string_view doc;       // one sentence

    bool required() const { return fallback == "!"; }
    /// The default as a number in the key's unit, if it is one.
    std::optional<double> fallbackNumber() const;
    std::vector<std::string_view> choiceList() const;
};

/// All keys, table by table.
std::span<const Key> keys();

/// The row of `name` in one of `tables`; nullptr if unknown.
const Key* findKey(std::span<const std::string_view> tables, std::string_view name);

/// How many of the key's units make one SI unit, by the suffix of its name: 1000 for `hold_ms`; 1 without suffix.
double unitsPerSi(std::string_view name);

/// "must be > 0", "must be from 0 to 100": what a number in the range fulfils. Empty for no limits.
std::string requirement(const Range& range);

/// The word most like `word`, if any is close enough to be meant.
std::optional<std::string_view> closestWord(std::string_view word, std::span<const std::string_view> candidates);

/// A word that a file may name, and what it stands for.
struct KnownWord {
    std::string name, meaning;
};

/// The documentation of all keys as Markdown, and of the presets and measures that may be named: the text of
/// protocols/KEYS.md.
std::string keyTable(std::span<const DeviceDescription> devices, std::span<const KnownWord> measures);

}  // namespace passung::protocol
