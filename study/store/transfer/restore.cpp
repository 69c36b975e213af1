#include "study/store/transfer/restore.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "core/base/regular_file.h"
#include "study/store/people/erase.h"
#include "study/store/read/verify.h"
#include "study/store/rows/audit.h"
#include "study/store/rows/tombstone.h"
#include "study/store/schema/database_file.h"
#include "study/store/schema/open_database.h"
#include "study/store/schema/private_files.h"
#include "study/store/schema/process_lock.h"
#include "study/store/schema/revisions.h"
#include "study/store/schema/schema_text.h"
#include "study/store/schema/session_tables.h"
#include "study/store/schema/study_views.h"
#include "study/store/schema/untouched.h"
#include "study/store/schema/workshop.h"
#include "study/store/transfer/heal.h"
#include "study/store/transfer/heal_links.h"
#include "study/store/transfer/merge.h"

namespace passung::store {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFrom = "source";
constexpr const char* kOfTheFile = "the file: ";  // how verify begins such a line

/// A private copy of this program's schema, so that the source stays as it is.
void copySource(const std::string& from, const std::string& to, const std::string& now_utc) {
    if (const auto why = whyNoRegularFile(from)) throw std::runtime_error(from + ": " + *why);
    if (!fs::exists(from)) throw std::runtime_error(from + ": no such file");
    openUntouched(from)->copyTo(to);
    const Database copy(to, OpenMode::ReadWrite);
    mendSchema(copy);
    const SchemaState state = inspectSchema(copy);
    if (state == SchemaState::Older) upgradeSchema(copy, now_utc);
    if (state != SchemaState::Older && state != SchemaState::Current)
        throw std::runtime_error(from + ": not a Passung database that this program can read");
    if (!pagesAreSound(copy)) throw std::runtime_error(from + ": is damaged itself");
}

/// The file as it is, of this program's schema, whose text is mended. False if its pages are damaged. Refuses what is
/// no such database.
bool copyDamaged(const std::string& path, const std::string& to, const std::string& now_utc,
                 std::vector<std::string>& healed) {
    try {
        Database(path, OpenMode::ReadWrite).copyTo(to);
        const Database copy(to, OpenMode::ReadWrite);
        healed = mendSchema(copy);
        const SchemaState state = inspectSchema(copy);
        if (state == SchemaState::Older) upgradeSchema(copy, now_utc);
        if (state != SchemaState::Older && state != SchemaState::Current)
            throw std::runtime_error("not a Passung database that this program can read");
        return pagesAreSound(copy);
    } catch (const SqliteError& error) {
        if (!isDamage(error)) throw;
        return false;
    }
}

/// Rows of sessions that are gone while what belongs to them is there.
void bringBackSessions(const Database& database, std::vector<std::string>& healed) {
    Statement gone = database.prepare(
        "SELECT session_id, participant_id || ', session ' || ordinal FROM source.session WHERE session_id NOT "
        "IN(SELECT "
        "session_id FROM main.session) AND session_id IN(SELECT session_id FROM main.trial_plan) AND participant_id "
        "IN(SELECT participant_id FROM main.participant)");
    const std::string columns = columnNames(describeTable(database, "session"));
    while (gone.step()) {
        // Under another id it would be there twice.
        database
            .prepare(
                "DELETE FROM main.session WHERE (participant_id, ordinal)=(SELECT participant_id, ordinal FROM "
                "source.session WHERE session_id=?) AND session_id NOT IN(SELECT session_id FROM main.trial_plan)")
            .bind(gone.text(0))
            .run();
        database
            .prepare("INSERT INTO main.session(" + columns + ") SELECT " + columns +
                     " FROM source.session WHERE session_id=?")
            .bind(gone.text(0))
            .run();
        healed.push_back(gone.text(1));
    }
}

/// A detail that is no JSON any more is no reason to heal nothing else.
void healAuditIfRead(const Database& database, std::vector<std::string>& healed) {
    try {
        for (std::string& line : healAudit(database, kFrom)) healed.push_back(std::move(line));
    } catch (const SqliteError& error) {
        if (isOfTheDisk(error)) throw;
    }
}

void heal(const Database& database, const std::string& source, std::vector<std::string>& healed) {
    database.prepare(std::string("ATTACH ? AS ") + kFrom).bind(source).run();
    {
        Transaction transaction(database);
        database.execute("PRAGMA defer_foreign_keys=ON");
        rebuildIndices(database);
        const auto add = [&](std::vector<std::string> lines) {
            for (std::string& line : lines) healed.push_back(std::move(line));
        };
        add(healReferences(database, kFrom));
        add(healHashNames(database));
        Healer healer(database, kFrom);
        add(healer.healRows());
        healAuditIfRead(database, healed);
        bringBackSessions(database, healed);
        std::vector<std::string> ids;
        Statement both = database.prepare(
            "SELECT session_id FROM main.session JOIN source.session USING(session_id) ORDER BY session_id");
        while (both.step()) ids.push_back(both.text(0));
        for (const std::string& id : ids) add(healer.healSession(id));
        rebuildIndices(database);
        makeStudyViews(database);
        transaction.commit();
    }
    database.execute(std::string("DETACH ") + kFrom);
}

/// Whoever was erased from the damaged file, as far as it can still tell, is erased from its source.
void leaveOutErased(const Workshop& workshop, const OpenOptions& options, RestoreReport& report) {
    std::map<std::string, std::string> erased;
    try {
        const Database part(workshop.part, OpenMode::ReadWrite);
        part.prepare("ATTACH ? AS damaged").bind(workshop.damaged).run();
        erased = erasedPeople(part, "damaged", "main");
    } catch (const SqliteError& error) {
        if (isOfTheDisk(error)) throw;
        report.remaining.push_back(std::string("who was erased from it cannot be read (") + error.what() +
                                   "): whoever it was has to be erased again");
    }
    if (erased.empty()) return;
    const OpenedDatabase opened = openForWriting(workshop.part, options);
    if (!opened.database) throw std::runtime_error(opened.errors.front().message);
    for (const auto& [code, surrogate] : erased)
        eraseParticipant(*opened.database, workshop.part, code, {"restore", options.now_utc});
}

/// A file that cannot be read can still hold the name of its study: a protocol's hash stands in many rows.
bool holdsStudyOf(const std::string& path, const std::string& source) {
    std::vector<std::string> names;
    const Database known(source, OpenMode::ReadWrite);
    Statement protocols = known.prepare("SELECT protocol_sha256 FROM protocol_version");
    while (protocols.step()) names.push_back(protocols.text(0));
    constexpr std::size_t kPiece = std::size_t{1} << 20, kName = 64;
    std::ifstream file(path, std::ios::binary);
    std::string bytes;
    for (std::string piece(kPiece, '\0'); file.read(piece.data(), kPiece), file.gcount() > 0;) {
        bytes.erase(0, bytes.size() - std::min(bytes.size(), kName));  // a name across two pieces
        bytes.append(piece, 0, static_cast<std::size_t>(file.gcount()));
        for (const std::string& name : names)
            if (bytes.find(name) != std::string::npos) return true;
    }
    return false;
}

/// Of a file whose pages are damaged: the source, and what of the file can still be read, is intact and newer.
void makeAnew(const std::string& path, const std::string& from, const Workshop& workshop, const OpenOptions& options,
              RestoreReport& report) {
    report.anew = true;
    Database(workshop.source, OpenMode::ReadWrite).copyTo(workshop.part);
    const auto merged = mergeDamaged("the damaged file", workshop.damaged, workshop.part, options);
    if (!merged) throw std::runtime_error(merged.errors().front().message);
    if (!holdsStudyOf(path, workshop.source))
        throw std::runtime_error("nothing in it names the study of " + from +
                                 ": if it is of that study nevertheless, move it away and copy " + from +
                                 " in its place");
    report.remaining = merged->damaged;
    report.healed = merged->held;
    for (const std::string& session : merged->unfinished)
        report.remaining.push_back(session + ": had not ended, is not taken over");
    report.told = merged->conflicts;
    for (const std::string& who : merged->moved_places)
        report.told.push_back(who +
                              ": the same row of the square in a further replicate, for another one has the slot");
    if (const auto newer = merged->sessions + merged->replaced; newer > 0)
        report.told.push_back(std::to_string(newer) + (newer == 1 ? " session that is" : " sessions that are") +
                              " newer than the source: taken over");
    leaveOutErased(workshop, options, report);
}

/// What SQLite found in the file as a whole and finds no more.
void tellHealedFile(const Verification& before, const Verification& after, RestoreReport& report) {
    for (const std::string& damage : before.damages) {
        const auto& left = after.damages;
        if (damage.starts_with(kOfTheFile) && std::find(left.begin(), left.end(), damage) == left.end())
            report.healed.push_back(damage);
    }
}

/// A text with the names that its reader knows.
std::string withKnownNames(std::string text, const Workshop& workshop, const std::string& path,
                           const std::string& from) {
    for (const auto& [ours, theirs] :
         {std::pair(workshop.damaged, path), {workshop.source, from}, {workshop.part, path}})
        for (std::size_t at = 0; (at = text.find(ours, at)) != std::string::npos; at += theirs.size())
            text.replace(at, ours.size(), theirs);
    return text;
}

/// Whoever could open the file can open it afterwards.
void putInPlace(const std::string& path, const Workshop& workshop, RestoreReport& report) {
    shareLike(path, workshop.part);
    if (report.anew) {
        report.kept = path + ".damaged";
        if (fs::exists(report.kept)) throw std::runtime_error(report.kept + " is there already: move it away first");
        fs::rename(path, report.kept);
        removeDatabase(path);
    }
    fs::rename(workshop.part, path);
}

/// Works on copies; the database changes at the end, if anything was healed.
RestoreReport restoreIn(const Workshop& workshop, const std::string& path, const std::string& from,
                        const OpenOptions& options, const PullSessions& pull) {
    RestoreReport report;
    const bool sound = copyDamaged(path, workshop.part, options.now_utc, report.healed);
    if (fs::exists(path + "-wal")) throw std::runtime_error("another program has this database open; end it first");
    Verification before;
    if (sound) {
        auto found = verifyDatabase(workshop.part);
        if (!found) throw std::runtime_error(found.errors().front().message);
        before = *std::move(found);
        if (before.damages.empty() && report.healed.empty()) return report;
    } else if (isServer(from)) {
        throw std::runtime_error("its pages are damaged: only a backup or another database can replace it");
    }
    if (isServer(from))
        pull(from, workshop.part, workshop.source, options.now_utc);
    else
        copySource(from, workshop.source, options.now_utc);
    if (sound) {
        heal(Database(workshop.part, OpenMode::ReadWrite), workshop.source, report.healed);
    } else {
        std::error_code none;  // where not even its first page can be read
        fs::rename(workshop.part, workshop.damaged, none);
        makeAnew(path, from, workshop, options, report);
    }
    const auto after = verifyDatabase(workshop.part);
    if (!after) throw std::runtime_error("could not be healed: " + after.errors().front().message);
    tellHealedFile(before, *after, report);
    report.remaining.insert(report.remaining.end(), after->damages.begin(), after->damages.end());
    if (!report.healed.empty() || report.anew) putInPlace(path, workshop, report);
    return report;
}

}  // namespace

bool isServer(const std::string& from) { return from.starts_with("postgresql://") || from.starts_with("postgres://"); }

Result<RestoreReport> restoreDatabase(const std::string& database, const std::string& from, const OpenOptions& options,
                                      const PullSessions& pull) {
    const std::string path = behindLink(database);
    if (const auto why = whyNoRegularFile(path)) return Error{.message = *why, .file = path};
    if (!fs::exists(path)) return Error{.message = "no such file", .file = path};
    if (!beginsAsDatabase(path)) return Error{.message = "is no database; nothing is restored over it", .file = path};
    const auto lock = ProcessLock::take(path);
    if (!lock) return lock.errors();
    const Workshop workshop(path);
    auto restored = guarded(path, [&] { return restoreIn(workshop, path, from, options, pull); });
    const auto name = [&](std::string& text) { text = withKnownNames(text, workshop, path, from); };
    if (!restored) {
        Errors errors = restored.errors();
        for (Error& error : errors) name(error.message);
        return errors;
    }
    for (auto* lines : {&restored->healed, &restored->remaining, &restored->told})
        for (std::string& line : *lines) name(line);
    return restored;
}

}  // namespace passung::store
