#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"

namespace passung::protocol {

/// Line and column of something in a text, from 1.
struct TextPosition {
    std::string file;
    int line = 1;
    int column = 1;
};

struct Entry;

/// A TOML value that knows its place. Unlike the parser's tree it keeps places when copied, so a scene can be cloned
/// and altered for every condition and still say where each value was written.
struct Node {
    enum class Kind { Boolean, Integer, Number, Text, List, Table, Other };
    Kind kind = Kind::Table;
    TextPosition place;
    bool boolean = false;
    std::int64_t integer = 0;
    double number = 0.0;         // of integers too
    std::string text;            // of Text; of Other: what it is ("a date")
    std::vector<Node> items;     // of List
    std::vector<Entry> entries;  // of Table, in the order of the file

    /// The value of `key` in a table; nullptr if there is none.
    const Node* find(std::string_view key) const;
    Node* find(std::string_view key);
};

struct Entry {
    std::string key;
    TextPosition place;
    Node value;
};

/// What a file describes, by its top-level keys: a study has `study` or `passung`; a scene `contact`, `device`,
/// `registration`, `start_gate` or `effects`; a part file parts and nothing of these.
enum class FileKind { Study, Scene, Part };
std::optional<FileKind> kindOf(const Node& document);  // nothing: none of them

/// One sentence that says what the file is and what was wanted, if it is of another kind that cannot be read as
/// `wanted` (a part file may be a scene).
std::optional<std::string> otherKind(const Node& document, FileKind wanted);

/// A table without keys that stands at `place`.
Node emptyTable(const TextPosition& place);

/// Parses TOML; `file` is the name in places. Errors: the parser's, at its place.
Result<Node> parseDocument(const std::string& text, const std::string& file);

/// What a value is, with its article, for messages: "a string".
std::string kindText(const Node& node);

/// The value as the user may recognise it: "abc" in quotes, numbers in shortest form, [1, 2, 3], {...}.
std::string valueText(const Node& node);

/// A value as the label of a level: a text without its quotes, 1.0 as 1.
std::string labelText(const Node& node);

Error errorAt(const TextPosition& place, std::string key, std::string value, std::string message);

/// Sorts by place and removes what was found twice (the same line is read once for every condition).
void tidy(Errors& errors);

}  // namespace passung::protocol
