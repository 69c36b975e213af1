#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace passung::importer {

/// A JSON text taken apart, without a call for every level of it: as much of JSON as it takes to judge a file before
/// another library reads it.
class JsonScan {
public:
    enum class Kind : std::uint8_t { Object, List, String, Number, Word };
    using Index = std::uint32_t;
    static constexpr Index kNone = ~Index{0};

    /// Nothing if `text` is no JSON or deeper than `most_depth`; `why` then says which. `text` outlives the scan.
    static std::optional<JsonScan> of(std::string_view text, int most_depth, std::string& why);

    /// The value that is the whole text.
    static constexpr Index root() { return 0; }
    Kind kind(Index value) const { return values_[value].kind; }
    /// The first member or item and the one behind `value`; kNone if there is none.
    Index first(Index value) const { return values_[value].first; }
    Index next(Index value) const { return values_[value].next; }
    /// The name of a member, and the text of a string, their escapes resolved.
    std::string key(Index member) const { return plain(values_[member].key); }
    std::string text(Index value) const { return plain(values_[value].text); }
    /// How many bytes text() has, not counting escapes.
    std::size_t length(Index value) const { return values_[value].text.size(); }
    /// A number; nothing if it is none.
    std::optional<double> number(Index value) const;

    /// The member of an object, of two with one name the first; kNone if there is none, and of kNone.
    Index find(Index object, std::string_view name) const;

private:
    struct Value {
        Kind kind = Kind::Word;
        Index first = kNone, next = kNone;
        std::string_view key = {}, text = {};  // as written
    };
    friend class JsonReader;

    static std::string plain(std::string_view written);

    std::vector<Value> values_;
};

}  // namespace passung::importer
