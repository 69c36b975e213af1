#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace passung::plan {

/// A text of the study in each of its languages.
struct StudyText {
    std::string name;
    std::vector<std::pair<std::string, std::string>> languages;  // language, text
};

/// Moment at which instructions are shown: before the session's first trial, before the first trial of a block, after
/// the last.
enum class ShowAt { SessionStart, BeforeBlock, SessionEnd };
inline constexpr std::array kShowAtNames = {"session_start", "before_block", "session_end"};  // as stored
inline const char* showAtName(ShowAt moment) { return kShowAtNames[static_cast<std::size_t>(moment)]; }

/// A page for the participant.
struct Instruction {
    ShowAt moment = ShowAt::SessionStart;
    std::string block;    // of BeforeBlock
    std::string text;     // name of a StudyText
    std::string picture;  // name of a file beside the study, as the protocol writes it; empty: none
};

/// A picture that the instructions name.
struct PictureSource {
    std::string name;          // as the protocol writes it
    std::string path;          // as it can be opened from here
    int line = 0, column = 0;  // where the protocol first names it
};

}  // namespace passung::plan
