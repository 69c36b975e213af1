#include "study/store/schema/open_database.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <stdexcept>

#include "core/base/regular_file.h"
#include "study/store/schema/backup.h"
#include "study/store/schema/private_files.h"
#include "study/store/schema/revisions.h"
#include "study/store/schema/row_hash.h"
#include "study/store/schema/schema_text.h"
#include "study/store/schema/untouched.h"
#include "study/store/schema/value_hash.h"

namespace passung::store {
namespace {

Error fileError(const std::string& path, std::string message) {
    return Error{.message = std::move(message), .file = path, .key = {}, .value = {}};
}

/// Where a database is damaged and has a copy, its error says so.
Errors withBackupNamed(const std::string& path, Errors errors) {
    const std::string backup = backupPath(path);
    std::error_code none;
    for (Error& error : errors)
        if (error.message.starts_with("the database is damaged") && std::filesystem::exists(backup, none))
            error.message += "; its copy from the end of the last run is " + backup;
    return errors;
}

constexpr const char* kForeign = "not a Passung database";

std::string newerText(const Database& database, const char* consequence) {
    return "written by a newer program (schema " + std::to_string(fileSchemaNumber(database)) +
           ", this program knows " + std::to_string(schemaNumber()) + "): " + consequence;
}

[[noreturn]] void refuseDamaged(const std::string& what) {
    throw std::runtime_error("the database is damaged (" + what + ")");
}

void checkIntegrity(const Database& database) {
    const std::string verdict = database.text("PRAGMA quick_check(1)");
    if (verdict != "ok") refuseDamaged(verdict);
}

/// SQLite's own check does not read the schema's text, and every later statement builds on it.
void checkSchema(const Database& database) {
    if (const auto faults = schemaFaults(database); !faults.empty()) refuseDamaged(faults.front());
}

/// Attempts without an end belong to a process that is gone: the lock says that no other one writes.
RecoveryReport markCrashed(const Database& database) {
    RecoveryReport report;
    Transaction transaction(database);
    std::vector<std::string> crashed;
    {
        Statement attempts = database.prepare(
            "SELECT participant_id || ', session ' || ordinal || ', trial ' || (trial_index + 1) || ', attempt ' || "
            "attempt_no "
            "FROM attempt JOIN trial_plan USING(trial_id) JOIN session USING(session_id) WHERE outcome='running' "
            "ORDER BY attempt_id");
        while (attempts.step()) report.crashed_attempts.push_back(attempts.text(0));
        Statement sessions = database.prepare(
            "SELECT participant_id || ', session ' || ordinal, session_id FROM session WHERE end_state IS NULL ORDER "
            "BY "
            "rowid");
        while (sessions.step()) {
            report.crashed_sessions.push_back(sessions.text(0));
            crashed.push_back(sessions.text(1));
        }
    }
    database.execute(
        "UPDATE attempt SET outcome='crashed', valid=0, invalid_reason='the program ended during the attempt' "
        "WHERE outcome='running'; "
        "UPDATE session SET end_state='crashed' WHERE end_state IS NULL; "
        // No session runs now: whoever was in one gives the row of the square back to the next participant.
        "UPDATE participant SET status='enrolled', status_reason=(SELECT 'session ' || max(ordinal) || ' did not "
        "complete' FROM session s WHERE s.participant_id=participant.participant_id) WHERE status='active'; "
        "UPDATE design_slot SET state='free', participant_id=NULL WHERE state='assigned'");
    for (const std::string& session : crashed) sealSession(database, session);
    transaction.commit();
    return report;
}

/// Texts of UTC sort as their times. Virtual time says nothing about the clock.
std::string newestUtc(const Database& database) {
    return database.text(
        "SELECT max(t) FROM (SELECT max(started_utc, coalesce(ended_utc, '')) t FROM session WHERE epoch='wall' "
        "UNION ALL SELECT t_utc FROM audit)");
}

std::string laterUtc(const Database& database, const std::string& now_utc) {
    const std::string newest = newestUtc(database);
    return newest > now_utc ? newest : std::string();
}

/// Fills `opened` for a file whose schema this program may write.
void prepareForWriting(const std::string& path, const OpenOptions& options, SchemaState state, OpenedDatabase& opened) {
    const Database& database = *opened.database;
    database.execute("PRAGMA busy_timeout=" + std::to_string(options.busy_timeout_ms));
    if (options.max_pages > 0) database.execute("PRAGMA max_page_count=" + std::to_string(options.max_pages));
    checkIntegrity(database);
    keepPrivate(path, options.group);  // now that it is ours, and before a log comes
    database.execute("PRAGMA journal_mode=WAL");
    if (state != SchemaState::Current) upgradeSchema(database, options.now_utc);
    if (state == SchemaState::Older) {
        Transaction transaction(database);
        sealNewRows(database);
        transaction.commit();
    }
    watchStudyRows(*opened.database);
    opened.recovery = markCrashed(database);
    keepPrivate(path, options.group);  // the log that has come meanwhile too
    opened.recovery.later_utc = laterUtc(database, options.now_utc);
    opened.outcome = state == SchemaState::Empty     ? OpenOutcome::Created
                     : state == SchemaState::Current ? OpenOutcome::Current
                                                     : OpenOutcome::Upgraded;
}

void inspectAndPrepare(const std::string& path, const OpenOptions& options, OpenedDatabase& opened) {
    checkSchema(*opened.database);
    const SchemaState state = inspectSchema(*opened.database);
    switch (state) {
        case SchemaState::Foreign:
            opened.errors.push_back(fileError(path, kForeign));
            return;
        case SchemaState::NewerCompatible:
            opened.outcome = OpenOutcome::NewerCompatible;
            opened.errors.push_back(fileError(path, newerText(*opened.database, "it can be read but not written")));
            return;
        case SchemaState::NewerIncompatible:
            opened.outcome = OpenOutcome::NewerIncompatible;
            opened.errors.push_back(fileError(path, newerText(*opened.database, "it cannot be read")));
            return;
        case SchemaState::Empty:
            if (!options.create) {
                opened.errors.push_back(fileError(path, kForeign));
                return;
            }
            break;
        case SchemaState::Older:
        case SchemaState::Current:
            break;
    }
    prepareForWriting(path, options, state, opened);
}

/// What a check of SQLite's says.
std::vector<std::string> linesOf(const Database& database, const std::string& check) {
    std::vector<std::string> lines;
    Statement verdict = database.prepare("PRAGMA " + check + "(200)");
    while (verdict.step()) lines.push_back(verdict.text(0));
    return lines;
}

/// Do these lines tell of faults of single rows and of indices only?
bool soundBy(const std::vector<std::string>& lines) {
    constexpr std::array kOfRows = {"CHECK constraint failed", "NULL value in",      " value in ",
                                    "missing from index",      "wrong # of entries", "non-unique entry"};
    return std::all_of(lines.begin(), lines.end(), [&](const std::string& line) {
        return line == "ok" || std::any_of(kOfRows.begin(), kOfRows.end(),
                                           [&](const char* what) { return line.find(what) != std::string::npos; });
    });
}

/// One walk through the file, as far as `check` asks for; with `indices` what does not fit its table is told there.
void lookThrough(const Database& database, ReadCheck check, std::vector<std::string>* indices) {
    if (check == ReadCheck::None) return;
    if (check == ReadCheck::Pages) return checkIntegrity(database);
    const auto lines = linesOf(database, indices == nullptr ? "quick_check" : "integrity_check");
    if (!soundBy(lines)) checkIntegrity(database);
    if (indices == nullptr) return;
    for (const std::string& line : lines)
        if (line.find(" index ") != std::string::npos) indices->push_back(line);
}

std::unique_ptr<Database> withSchemaMended(const Database& database, const std::string& path,
                                           const std::vector<std::string>& faults, std::vector<std::string>* mended) {
    auto copy = privateCopy(database, path);
    mendSchema(*copy);
    if (mended != nullptr) *mended = faults;
    return copy;
}

}  // namespace

bool pagesAreSound(const Database& database) { return soundBy(linesOf(database, "quick_check")); }

std::vector<BrokenReference> brokenReferences(const Database& database) {
    std::vector<BrokenReference> all;
    Statement broken = database.prepare("SELECT DISTINCT \"table\", parent FROM pragma_foreign_key_check");
    while (broken.step()) all.push_back({broken.text(0), broken.text(1)});
    return all;
}

void rebuildIndices(const Database& database) {
    try {
        database.execute("REINDEX");
    } catch (const SqliteError&) {
        // two rows of one name: healing one of them comes first
    }
}

OpenedDatabase openForWriting(const std::string& path, const OpenOptions& options) {
    OpenedDatabase opened;
    const bool existed = std::filesystem::exists(path);
    const auto done = guarded(path, [&] {
        // What is no file stays as it is: who may use a device is not this program's to say.
        if (const auto why = whyNoRegularFile(path)) throw std::runtime_error(*why);
        opened.database = std::make_unique<Database>(path, options.create ? OpenMode::Create : OpenMode::ReadWrite);
        if (!existed) keepPrivate(path, options.group);
        inspectAndPrepare(path, options, opened);
        return Done{};
    });
    if (!done) {
        opened.outcome = OpenOutcome::Failed;
        opened.errors = withBackupNamed(path, done.errors());
    }
    if (!opened.errors.empty()) opened.database.reset();
    if (!opened.database && !existed) {
        std::error_code ignored;
        std::filesystem::remove(path, ignored);
    }
    return opened;
}

Result<std::unique_ptr<Database>> openForReading(const std::string& path, OlderFile older, ReadCheck check,
                                                 std::vector<std::string>* mended, std::vector<std::string>* indices) {
    if (const auto why = whyNoRegularFile(path)) return fileError(path, *why);
    if (!std::filesystem::exists(path)) return fileError(path, "no such file");
    auto opened = guarded(path, [&] {
        auto database = openUntouched(path);
        if (check == ReadCheck::Pages)
            checkSchema(*database);
        else if (const auto faults = schemaFaults(*database); !faults.empty())
            database = withSchemaMended(*database, path, faults, mended);
        const auto look = [&] { lookThrough(*database, check, indices); };
        switch (inspectSchema(*database)) {
            case SchemaState::Empty:
            case SchemaState::Foreign:
                throw std::runtime_error(kForeign);
            case SchemaState::Older:
                if (older == OlderFile::Refuse)
                    throw std::runtime_error("written by an older program: open it once for writing to upgrade it");
                look();
                database = privateCopy(*database, path);
                upgradeSchema(*database, newestUtc(*database));
                break;
            case SchemaState::NewerIncompatible:
                throw std::runtime_error(newerText(*database, "it cannot be read"));
            case SchemaState::NewerCompatible:
            case SchemaState::Current:
                look();
                break;
        }
        database->execute("PRAGMA query_only=ON");
        return database;
    });
    if (!opened) return withBackupNamed(path, opened.errors());
    return opened;
}

}  // namespace passung::store
