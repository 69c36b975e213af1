#include "study/store/read/session_damage.h"

#include <algorithm>
#include <set>

#include "study/store/samples/sample_codec.h"
#include "study/store/schema/value_hash.h"

namespace passung::store {
namespace {

void findChunkFaults(const Database& database, const std::string& schema, const std::string& session_id,
                     const SessionValues& values, SessionDamage& damage) {
    const auto& attempts = values.names.at("attempt");
    const std::string from = schema + ".";
    Statement row = database.prepare(
        "SELECT c.stream_id, c.chunk_no, coalesce(c.attempt_id, 0), c.first_tick, c.n, c.crc32, c.data, s.stream, "
        "s.encoding FROM " +
        from + "sample_chunk c JOIN " + from + "stream s USING(stream_id) JOIN " + from +
        "segment g USING(segment_id) WHERE g.session_id=? ORDER BY c.stream_id, c.chunk_no");
    row.bind(session_id);
    while (row.step()) {
        ++damage.chunk_count;
        std::string what =
            chunkFault(row.text(7), row.text(8), row.integer(3), row.integer(4), row.integer(5), row.blob(6));
        if (what.empty()) continue;
        const auto attempt = attempts.find(row.integer(2));
        damage.chunks.push_back({row.integer(0), row.integer(1), row.integer(2),
                                 attempt == attempts.end() ? "" : attempt->second + kSamplesUnit, std::move(what)});
    }
}

}  // namespace

std::string chunkFault(const std::string& stream, const std::string& encoding, std::int64_t first_tick,
                       std::int64_t count, std::int64_t crc32, std::span<const std::byte> data) {
    const Chunk stored{first_tick, count, static_cast<std::uint32_t>(crc32), {data.begin(), data.end()}};
    if (crc32 != static_cast<std::int64_t>(stored.crc32)) return "its checksum is none";
    const bool ticks = isTickStream(stream);
    const auto extra = extraNamed(stream);
    const auto chunk = ticks   ? unpackTicks(stored, encoding)
                       : extra ? unpackExtra(*extra, stored, encoding)
                               : unpackTiming(stored, encoding);
    if (!chunk) return chunk.errors().front().message;
    std::vector<TickRecord> records;
    const auto sound = ticks   ? decodeTicks(*chunk, records)
                       : extra ? decodeExtra(*extra, *chunk, records)
                               : decodeTiming(*chunk, records);
    return sound ? "" : sound.errors().front().message;
}

SessionDamage damageOf(const Database& database, const std::vector<SessionTable>& tables, const std::string& schema,
                       const std::string& session_id, SampleCheck samples) {
    SessionDamage damage;
    Statement session =
        database.prepare("SELECT participant_id || ', session ' || ordinal, end_state IS NOT NULL FROM " + schema +
                         ".session WHERE session_id=?");
    session.bind(session_id);
    if (!session.step()) throw std::runtime_error("there is no session " + session_id);
    damage.name = session.text(0);
    const bool over = session.integer(1) != 0;
    const SessionValues values = sessionValues(database, tables, schema, session_id);
    if (samples == SampleCheck::LookedAt) findChunkFaults(database, schema, session_id, values, damage);
    const KeptHashes kept = keptHashes(database, schema, session_id);
    damage.list = !kept.list_whole;
    damage.hashed = over && !kept.units.empty();
    if (!damage.hashed) return damage;
    const UnitHashes found = unitHashes(database, schema, session_id, values.rows);
    damage.changes = !found.changes_whole;
    std::set<std::string> units;
    for (const auto& [unit, sha256] : found.units) units.insert(unit);
    for (const auto& [unit, sha256] : kept.units) units.insert(unit);
    for (const std::string& unit : units) {
        const auto now = found.units.find(unit), then = kept.units.find(unit);
        if (now == found.units.end() || then == kept.units.end() || now->second != then->second)
            damage.units.push_back(unit);
    }
    return damage;
}

std::vector<std::string> SessionDamage::lines() const {
    std::vector<std::string> lines;
    std::set<std::string> told;
    for (const ChunkFault& chunk : chunks) {
        lines.push_back((chunk.unit.empty() ? "samples of no attempt" : chunk.unit) + ": " + chunk.what);
        told.insert(chunk.unit);
    }
    for (const std::string& unit : units)
        if (told.count(unit) == 0) lines.push_back(unit + ": is not as the run wrote it");
    if (changes) lines.push_back("a later note, event or invalidation is not as it was left");
    if (list) lines.push_back("the list of its hashes is damaged");
    return lines;
}

}  // namespace passung::store
