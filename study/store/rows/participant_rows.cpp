#include "study/store/rows/participant_rows.h"

#include <stdexcept>

#include "study/store/rows/audit.h"
#include "study/store/schema/person_identity.h"

namespace passung::store {
namespace {

/// Stations whose codes were alike could not be merged.
void refuseCodeOfNoStation(const std::string& code, plan::ParticipantKind kind, const Station& station) {
    const std::string start = codeStart(kind, station);
    if (code.starts_with(start)) return;
    throw std::runtime_error("participant code '" + code + "': with " + std::to_string(station.count) +
                             " stations the codes of station " + station.name + " begin with " + start + ", such as " +
                             start + "001");
}

void refuseErasedCode(const Database& database, const std::string& code, plan::ParticipantKind kind) {
    const std::int64_t to = erasedCodesTo(database, kind);
    if (plan::participantNumber(code) <= to)
        throw std::runtime_error("participant code " + code +
                                 " may be that of somebody who was erased: take one with a number above " +
                                 std::to_string(to));
}

}  // namespace

std::string codeStart(plan::ParticipantKind kind, const Station& station) {
    return plan::codeLetter(kind) + (station.count > 1 ? station.name : "");
}

bool insertParticipant(const Database& database, const std::string& code, plan::ParticipantKind wanted,
                       const std::string& created_utc, const Station& station) {
    const char* kind = plan::participantKindName(wanted);
    if (!plan::isParticipantCode(code)) {
        throw std::runtime_error("participant code '" + code +
                                 "' is not a capital letter, then capital letters, digits, '_' or '-', then a digit, "
                                 "such as " +
                                 plan::participantCode(wanted, 1));
    }
    if (code.front() != plan::codeLetter(wanted)) {
        throw std::runtime_error("participant code '" + code + "': codes of " + kind + " participants begin with " +
                                 plan::codeLetter(wanted) + ", such as " + plan::participantCode(wanted, 1));
    }
    Statement find = database.prepare("SELECT kind FROM participant WHERE participant_id=?");
    if (find.bind(code).step()) {
        if (find.text(0) == kind) return false;
        throw std::runtime_error("participant " + code + " is " + find.text(0) + ", not " + kind);
    }
    refuseCodeOfNoStation(code, wanted, station);
    refuseErasedCode(database, code, wanted);
    const std::string identity = newIdentity(database, code, kind);
    database
        .prepare(
            "INSERT INTO participant(participant_id, kind, status, created_utc, identity) "
            "VALUES(?, ?, 'enrolled', ?, ?)")
        .bind(code, kind, created_utc, identity)
        .run();
    return true;
}

}  // namespace passung::store
