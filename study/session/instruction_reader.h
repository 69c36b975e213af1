#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "study/plan/study_texts.h"

namespace passung::session {

/// A page of the study's instructions as it is to be shown.
struct Page {
    const plan::Instruction& instruction;
    std::string text;     // in the session's language
    std::string picture;  // file that can be opened from here; empty: none
    std::string id;       // differs from that of every other page of this run of the session
};

struct PageRead {
    std::string read_by;                     // "participant", "experimenter" (who read it out), "simulated"
    std::optional<std::int64_t> reading_ms;  // from showing the page to its acknowledgement; empty: not measured
};

/// Interface that shows instructions and hears when they were read; and who rests.
class InstructionReader {
public:
    virtual ~InstructionReader() = default;
    /// Nothing while somebody reads. Called again and again with the same page, returns quickly.
    virtual std::optional<PageRead> read(const Page& page) = 0;
    /// A rest has lasted its least time: true once the person wants to go on. Called again and again, returns quickly.
    virtual bool goesOn() { return true; }
};

}  // namespace passung::session
