#include "study/store/people/erase.h"

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "study/store/rows/participant_rows.h"
#include "study/store/rows/tombstone.h"
#include "study/store/schema/backup.h"
#include "study/store/schema/open_database.h"
#include "study/store/schema/row_hash.h"

namespace passung::store {
namespace {

/// VACUUM writes a second copy and then the file; its journal holds the old one meanwhile.
void requireRoom(const std::string& path) {
    std::error_code error;
    const auto size = std::filesystem::file_size(path, error);
    if (error) return;
    const auto room = std::filesystem::space(std::filesystem::absolute(path).parent_path(), error);
    if (!error && room.available < 2 * size)
        throw std::runtime_error("erasing needs " + std::to_string(2 * size / 1'000'000 + 1) +
                                 " MB of free space beside the database; nothing was erased");
}

std::int64_t highestNumber(const Database& database, const std::string& kind) {
    std::int64_t highest = 0;
    Statement codes = database.prepare("SELECT participant_id FROM participant WHERE kind=?");
    codes.bind(kind);
    while (codes.step()) highest = std::max(highest, plan::participantNumber(codes.text(0)));
    return highest;
}

std::string deleteRows(const Database& database, const std::string& participant, const Actor& actor) {
    Transaction transaction(database);
    Statement find = database.prepare("SELECT kind, identity FROM participant WHERE participant_id=?");
    if (!find.bind(participant).step()) throw std::runtime_error("participant " + participant + " is not enrolled");
    const std::string kind = find.text(0), identity = find.text(1);
    find.reset();
    const auto detail = tombstone(identity, kind, highestNumber(database, kind));
    database.prepare("UPDATE design_slot SET state='free', participant_id=NULL WHERE participant_id=?")
        .bind(participant)
        .run();
    database.prepare("DELETE FROM participant WHERE participant_id=?").bind(participant).run();
    eraseAuditDetails(database, participant, identity);
    appendAudit(database, actor, "erase", detail);
    transaction.commit();
    return identity;
}

}  // namespace

std::string eraseParticipant(const Database& database, const std::string& path, const std::string& participant,
                             const Actor& actor) {
    requireRoom(path);
    database.execute("PRAGMA secure_delete=ON");
    // Empties and removes the log, and fails while anybody else has the file open.
    if (database.text("PRAGMA journal_mode=DELETE") != "delete")
        throw std::runtime_error("another program has the database open: end it first; nothing was erased");
    const std::string identity = deleteRows(database, participant, actor);
    try {
        database.execute("VACUUM");
    } catch (const SqliteError& error) {
        throw std::runtime_error("the participant is erased, but the file could not be written anew (" +
                                 std::string(error.what()) + "): run VACUUM on it with sqlite3");
    }
    database.execute("PRAGMA journal_mode=WAL");
    return identity;
}

bool eraseFromBackup(const std::string& database_path, const std::string& identity, const Actor& actor) {
    const std::string path = backupPath(database_path);
    if (!std::filesystem::exists(path)) return false;
    const auto backup = openForReading(path);
    if (!backup) throw std::runtime_error(backup.errors().front().message);
    Statement find = (*backup)->prepare("SELECT participant_id FROM participant WHERE identity=?");
    if (!find.bind(identity).step()) return false;
    const std::string code = find.text(0);
    find.reset();
    writeBackup(**backup, database_path, [&](Database& copy, const std::string& part) {
        watchStudyRows(copy);
        eraseParticipant(copy, part, code, actor);
    });
    return true;
}

}  // namespace passung::store
