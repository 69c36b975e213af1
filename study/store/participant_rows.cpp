#include "study/store/participant_rows.h"

#include <charconv>
#include <stdexcept>

namespace passung::store {

std::int64_t codeNumber(const std::string& code) {
    const std::size_t digits = code.find_last_not_of("0123456789") + 1;
    std::int64_t number = 0;
    std::from_chars(code.data() + digits, code.data() + code.size(), number);
    return number;
}

bool insertParticipant(const Database& database, const std::string& code, protocol::ParticipantKind wanted,
                       const std::string& created_utc) {
    const char* kind = protocol::participantKindName(wanted);
    if (!protocol::isParticipantCode(code)) {
        throw std::runtime_error("participant code '" + code +
                                 "' is not a capital letter, then capital letters, digits, '_' or '-', then a digit, "
                                 "such as " +
                                 protocol::participantCode(wanted, 1));
    }
    if (code.front() != protocol::codeLetter(wanted)) {
        throw std::runtime_error("participant code '" + code + "': codes of " + kind + " participants begin with " +
                                 protocol::codeLetter(wanted) + ", such as " + protocol::participantCode(wanted, 1));
    }
    Statement find = database.prepare("SELECT kind FROM participant WHERE participant_id=?");
    if (find.bind(code).step()) {
        if (find.text(0) == kind) return false;
        throw std::runtime_error("participant " + code + " is " + find.text(0) + ", not " + kind);
    }
    database.prepare("INSERT INTO participant VALUES(?, ?, 'enrolled', NULL, ?)").bind(code, kind, created_utc).run();
    return true;
}

}  // namespace passung::store
