#include "study/store/read/verify.h"

#include "core/base/digest.h"
#include "study/store/read/session_damage.h"
#include "study/store/rows/audit.h"
#include "study/store/schema/open_database.h"
#include "study/store/schema/row_hash.h"

namespace passung::store {
namespace {

constexpr const char* kMostFaults = "200";

/// Damaged bytes do not reach a terminal as they are.
std::string oneLine(std::string text) {
    for (char& c : text)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
    return text;
}

/// Looks at one database; what cannot be read is a damage and not the end.
class Inspection {
public:
    Inspection(const Database& database, const std::vector<std::string>& schema_faults) : database_(database) {
        for (const std::string& fault : schema_faults)
            found_.damages.push_back("the file: " + fault + " is not as it was written");
    }

    Verification run() {
        attempt("the file", [&] { pages(); });
        attempt("references between rows", [&] { references(); });
        attempt("the study's rows", [&] { rows(); });
        attempt("the protocols", [&] { protocols(); });
        attempt("the audit", [&] {
            for (const std::string& fault : checkAudit(database_).faults) found_.damages.push_back("audit, " + fault);
        });
        attempt("the sessions", [&] { sessions(); });
        for (std::string& damage : found_.damages) damage = oneLine(std::move(damage));
        return std::move(found_);
    }

private:
    template <class Work>
    void attempt(const std::string& what, Work work) {
        try {
            work();
        } catch (const std::exception& error) {
            found_.damages.push_back(what + ": cannot be read (" + error.what() + ")");
        }
    }

    void pages() {
        Statement verdict = database_.prepare(std::string("PRAGMA integrity_check(") + kMostFaults + ")");
        while (verdict.step())
            if (const std::string line = verdict.text(0); line != "ok") found_.damages.push_back("the file: " + line);
    }

    void references() {
        for (const auto& [table, parent] : brokenReferences(database_))
            found_.damages.push_back("a row of " + table + " belongs to no row of " + parent);
    }

    void rows() {
        RowsSeen seen;
        for (const RowFault& fault : rowFaults(database_, "main", &seen))
            found_.damages.push_back(titleOf(fault) + (fault.missing ? ": is gone" : ": is not as it was written"));
        for (const std::string& table : seen.unreadable) found_.damages.push_back(table + ": cannot be read");
        if (seen.not_hashed > 0)
            found_.not_hashed.push_back((seen.hashed > 0 ? std::to_string(seen.not_hashed) + " of " : std::string()) +
                                        "the study's own rows");
        found_.rows = database_.integer("SELECT count(*) FROM row_hash");
    }

    /// Their names are hashes as well, which older databases have too.
    void protocols() {
        const auto compare = [&](const char* sql, const char* what) {
            Statement row = database_.prepare(sql);
            while (row.step())
                if (sha256Hex(row.text(1)) != row.text(0))
                    found_.damages.push_back(std::string(what) + " " + row.text(0) +
                                             ": is not the text of that SHA-256");
        };
        compare("SELECT protocol_sha256, source_text FROM protocol_version", "protocol");
        compare("SELECT questionnaire_sha256, definition_json FROM questionnaire", "questionnaire");
    }

    void sessions() {
        const auto tables = sessionTables(database_);
        std::vector<std::pair<std::string, std::string>> ids;
        Statement row = database_.prepare(
            "SELECT session_id, participant_id || ', session ' || ordinal FROM session ORDER BY participant_id, "
            "ordinal");
        while (row.step()) ids.emplace_back(row.text(0), row.text(1));
        for (const auto& [id, name] : ids)
            attempt(name, [&, session = id] {
                const SessionDamage damage = damageOf(database_, tables, "main", session);
                for (const std::string& line : damage.lines()) found_.damages.push_back(damage.name + ", " + line);
                if (!damage.hashed && !damage.any()) found_.not_hashed.push_back(damage.name);
                ++found_.sessions;
                found_.chunks += damage.chunk_count;
            });
    }

    const Database& database_;
    Verification found_;
};

}  // namespace

Result<Verification> verifyDatabase(const std::string& path) {
    std::vector<std::string> schema_faults;
    const auto opened = openForReading(path, OlderFile::UpgradeCopy, ReadCheck::None, &schema_faults);
    if (!opened) return opened.errors();
    return guarded(path, [&] {
        (*opened)->execute("BEGIN");
        return Inspection(**opened, schema_faults).run();
    });
}

}  // namespace passung::store
