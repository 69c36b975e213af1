#pragma once

#include <optional>
#include <string>
#include <vector>

#include "study/run/machine/tick_front.h"

namespace passung::run {

/// A front as a file keeps it.
struct StoredFront {
    std::string condition;  // its name
    std::string mark;       // conditionMark() when it was measured
    TickFront front;
};

/// Fronts beside the study that they are of, for those who do not want to wait, and who measured them on what.
struct FrontFile {
    std::string program;  // version
    std::string commit;   // of its sources; empty: not told
    std::string machine;  // measuringMachine()
    std::string date;     // "2026-11-26", UTC
    std::vector<StoredFront> fronts;
};

/// Of STUDY.toml it is STUDY.front.csv.
std::string frontPath(const std::string& study);

/// The system with its processors, without the machine's name and what an update changes.
std::string measuringMachine();

/// Who measures now, and on what; no fronts yet.
FrontFile newFrontFile(const std::string& commit);

/// Changes with everything of a condition that is felt, seen or judged.
std::string conditionMark(const plan::Condition& condition);

/// What is written: comments that say where it comes from, and a table for each condition.
std::string frontFileText(const FrontFile& file);

/// Errors: with their lines.
Result<FrontFile> readFrontText(const std::string& text, const std::string& path);

/// That of the study's file; nothing where there is none.
Result<std::optional<FrontFile>> readFronts(const std::string& study);

/// The condition's, as a measurement would have given it; nothing if the file has none.
std::optional<TickFront> frontOf(const FrontFile& file, const plan::Condition& condition);

/// What a reader of the front has to know, in no particular language: whether it was measured elsewhere, and before the
/// condition was changed.
struct FrontOrigin {
    std::string program, commit, machine, date;
    bool elsewhere = false, outdated = false;
};
FrontOrigin originOf(const FrontFile& file, const plan::Condition& condition);

}  // namespace passung::run
