#include "analysis/power/drop_out.h"

#include <algorithm>
#include <map>
#include <set>
#include <string>

#include "core/base/random.h"

namespace passung::power {

void dropOut(double share, std::uint64_t seed, exporter::StudyData& study) {
    std::map<std::string, std::size_t> made;  // attempts of a person
    for (const store::AttemptRow& attempt : study.attempts) ++made[attempt.participant_id];
    std::map<std::string, std::size_t> left;  // of those who leave, attempts before they do
    for (const auto& [code, count] : made) {
        Random random(streamSeed("", code, "power", "drop-out", seed));
        if (random.uniform() >= share) continue;
        left[code] = static_cast<std::size_t>(random.uniform() * static_cast<double>(count));
    }
    std::set<std::string> begun, cut;  // sessions
    std::map<std::string, std::size_t> seen;
    std::erase_if(study.attempts, [&](const store::AttemptRow& attempt) {
        const auto leaves = left.find(attempt.participant_id);
        if (leaves == left.end()) return false;
        const bool goes = seen[attempt.participant_id]++ >= leaves->second;
        (goes ? cut : begun).insert(attempt.session_id);
        return goes;
    });
    std::erase_if(study.sessions, [&](const store::SessionRow& session) {
        return cut.count(session.session_id) > 0 && begun.count(session.session_id) == 0 && session.ordinal > 1;
    });
    for (store::SessionRow& session : study.sessions)
        if (cut.count(session.session_id) > 0) session.end_state = "aborted";
}

}  // namespace passung::power
