#pragma once

#include <string>
#include <vector>

#include "study/protocol/document.h"

namespace passung::protocol {

/// A study's text with every included file in the place of its line, and where each line of it was written.
struct IncludedText {
    std::string text;
    std::vector<TextPosition> lines;  // column 1; empty if nothing was included: text and file are the same then
};

/// Replaces each line `include = "FILE"` by the lines of FILE, which may include others, and each line
/// `conditions = "TABLE.csv"` by the list that the table stands for (condition_table.h). What is stored and what is
/// read is this text, so that it is all of the protocol. FILE is beside the study, so that paths in it mean the same.
/// Errors, placed at the line: the file cannot be read, is in another folder, or includes itself; too many files,
/// too large a text.
Result<IncludedText> includeFiles(const std::string& text, const std::string& path);

/// Moves a place in the text to where its line was written.
void relocate(const IncludedText& included, TextPosition& place);
void relocate(const IncludedText& included, Node& document);

}  // namespace passung::protocol
