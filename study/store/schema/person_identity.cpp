#include "study/store/schema/person_identity.h"

#include <optional>
#include <utility>
#include <vector>

#include "core/base/digest.h"
#include "core/base/json.h"

namespace passung::store {
namespace {

constexpr std::size_t kBytes = 16;

std::string hashed(const JsonObject& what) { return sha256Hex(what.str()).substr(0, 2 * kBytes); }

/// By the protocol imported last.
std::string simulatedIdentity(const Database& database, const std::string& schema, const std::string& code) {
    Statement find = database.prepare("SELECT name, coalesce(json_extract(expanded_json, '$.seed'), 0) FROM " + schema +
                                      ".protocol_version ORDER BY rowid DESC LIMIT 1");
    const bool found = find.step();
    return hashed(JsonObject()
                      .text("study", found ? find.text(0) : "")
                      .integer("seed", found ? find.integer(1) : 0)
                      .text("code", code));
}

/// What every copy of the file has about them and nobody can guess; none if there is no such thing.
std::optional<std::string> secretOf(const Database& database, const std::string& schema, const std::string& code) {
    Statement nonce = database.prepare(
        "SELECT json_extract(detail_json, '$.nonce') FROM " + schema +
        ".audit WHERE json_extract(detail_json, '$.participant')=? AND json_extract(detail_json, '$.nonce') IS NOT "
        "NULL ORDER BY t_utc, hash LIMIT 1");
    if (nonce.bind(code).step()) return nonce.text(0);
    if (schema != "main") return std::nullopt;
    Statement trial = database.prepare(
        "SELECT a.state_hash || ' ' || a.start_ns FROM attempt a JOIN trial_plan USING(trial_id) JOIN session s "
        "USING(session_id) WHERE s.participant_id=? AND a.state_hash IS NOT NULL "
        "ORDER BY s.ordinal, trial_index, attempt_no LIMIT 1");
    if (trial.bind(code).step()) return trial.text(0);
    return std::nullopt;
}

}  // namespace

std::string newIdentity(const Database& database, const std::string& code, const std::string& kind) {
    return kind == "simulated" ? simulatedIdentity(database, "main", code) : randomHex(kBytes);
}

void giveIdentities(const Database& database, const std::string& schema) {
    std::vector<std::pair<std::string, std::string>> given;
    Statement people = database.prepare("SELECT participant_id, kind FROM " + schema +
                                        ".participant WHERE coalesce(identity, '')='' ORDER BY participant_id");
    while (people.step()) {
        const std::string code = people.text(0);
        if (people.text(1) == "simulated") {
            given.emplace_back(code, simulatedIdentity(database, schema, code));
        } else if (const auto secret = secretOf(database, schema, code)) {
            given.emplace_back(code, hashed(JsonObject().text("code", code).text("secret", *secret)));
        } else if (schema == "main") {
            given.emplace_back(code, randomHex(kBytes));
        }
    }
    Statement give = database.prepare("UPDATE " + schema + ".participant SET identity=?2 WHERE participant_id=?1");
    for (const auto& [code, identity] : given) give.bind(code, identity).run();
}

}  // namespace passung::store
