#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "study/design/trial_order.h"
#include "study/session/resume.h"

namespace passung::store {

class Database;

/// A session that did not complete, with all that is needed to go on with it.
struct Unfinished {
    std::string session_id, participant, protocol_sha256, language, station;
    int ordinal = 1;
    std::uint64_t seed = 0;
    bool virtual_time = true;
    bool crashed = true;          // its program was killed; else somebody ended it
    std::optional<double> age_s;  // by the wall clock since its last sign of life; none in virtual time
    std::string latest_utc;       // the latest stamp of anything in it; empty in virtual time
    std::int64_t used_ns = 0;     // session time up to there
    std::vector<design::PlannedTrial> trials;
    std::vector<session::StoredAttempt> attempts;  // ascending by time
    std::vector<session::OrderStep> steps;         // the same
    std::vector<session::StoredForm> forms;        // the same
    std::optional<session::QualityFound> quality;  // with which the windows drew
};

/// The session of this id, or the newest one that is not complete. Throws if there is none, if it is complete, or if
/// its participant has begun another one since.
Unfinished readUnfinished(const Database& database, const std::string& session_id, const std::string& now_utc);

/// Runs the session again: what its end had set is taken back.
void reopenSession(const Database& database, const std::string& session_id);

}  // namespace passung::store
