#include "study/store/rows/tombstone.h"

#include "core/base/digest.h"

namespace passung::store {
namespace {

/// By programs that knew no identities.
std::string personHash(const std::string& salt, const std::string& code, const std::string& created_utc) {
    return sha256Hex(JsonObject().text("salt", salt).text("code", code).text("created_utc", created_utc).str());
}

void addByHash(const Database& database, const std::string& tombstones, const std::string& people,
               std::map<std::string, std::string>& erased) {
    Statement stones = database.prepare(
        "SELECT json_extract(detail_json, '$.salt'), json_extract(detail_json, '$.person'), "
        "json_extract(detail_json, '$.surrogate') FROM " +
        tombstones + ".audit WHERE action='erase' AND json_extract(detail_json, '$.person') IS NOT NULL");
    Statement codes = database.prepare("SELECT participant_id, created_utc FROM " + people + ".participant");
    while (stones.step())
        for (codes.reset(); codes.step();)
            if (personHash(stones.text(0), codes.text(0), codes.text(1)) == stones.text(1))
                erased[codes.text(0)] = stones.text(2);
}

}  // namespace

JsonObject tombstone(const std::string& identity, const std::string& kind, std::int64_t codes_to) {
    return JsonObject().text("surrogate", identity).text("kind", kind).integer("codes_to", codes_to);
}

std::map<std::string, std::string> erasedPeople(const Database& database, const std::string& tombstones,
                                                const std::string& people) {
    std::map<std::string, std::string> erased;
    Statement known =
        database.prepare("SELECT p.participant_id, p.identity FROM " + people + ".participant p JOIN " + tombstones +
                         ".audit a ON p.identity=json_extract(a.detail_json, '$.surrogate') "
                         "WHERE a.action='erase' AND p.identity<>''");
    while (known.step()) erased[known.text(0)] = known.text(1);
    addByHash(database, tombstones, people, erased);
    return erased;
}

void leaveOut(const Database& database, const std::map<std::string, std::string>& erased) {
    database.execute("CREATE TEMP TABLE left_out(participant_id TEXT PRIMARY KEY)");
    Statement insert = database.prepare("INSERT INTO temp.left_out(participant_id) VALUES(?)");
    for (const auto& [code, surrogate] : erased) insert.bind(code).run();
}

}  // namespace passung::store
