#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "study/store/schema/station.h"

namespace passung::store {

enum class OpenOutcome { Current, Upgraded, Created, NewerCompatible, NewerIncompatible, Failed };

/// What an earlier process left unfinished when it was killed, as found and marked at opening.
struct RecoveryReport {
    std::vector<std::string> crashed_attempts;  // for people, from 1: "S001, session 1, trial 4, attempt 1"
    std::vector<std::string> crashed_sessions;  // "S001, session 1"
    std::string later_utc;  // the newest time that this file holds, if this machine's clock says an earlier one
    bool empty() const { return crashed_attempts.empty() && crashed_sessions.empty(); }
};

struct OpenOptions {
    std::string app_version;  // of the program, stored with protocols and segments
    std::string now_utc;      // wall clock for rows about the file itself (schema, import); never exported
    Station station;
    bool create = true;          // false: the file has to exist
    bool group = false;          // share it with the owner's group; false: as it is, or with nobody
    int busy_timeout_ms = 5000;  // how long another program may hold the file before this is an error
    std::int64_t max_pages = 0;  // refuse to grow beyond so many pages of 4096 bytes; 0 = as far as the disk goes
};

}  // namespace passung::store
