#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "study/store/schema/session_tables.h"

namespace passung::store {

// What of a session is not as its run wrote it, by the checksums of its samples and the hashes of the rest. For this
// room only: the functions throw.

/// A chunk of samples whose checksum does not fit, or that is none.
struct ChunkFault {
    std::int64_t stream_id = 0, chunk_no = 0, attempt_id = 0;
    std::string unit;  // "trial 4, attempt 1, samples"
    std::string what;
};

struct SessionDamage {
    std::string name;                // "S001, session 1"
    bool hashed = false;             // it ended under a program that kept hashes
    std::vector<std::string> units;  // whose values are not those of the run; see value_hash.h
    bool list = false;               // the kept hashes themselves are damaged
    bool changes = false;            // something that was changed later is not as it was left
    std::vector<ChunkFault> chunks;
    std::int64_t chunk_count = 0;

    bool any() const { return list || changes || !units.empty() || !chunks.empty(); }
    /// A sentence for each, without the session's name.
    std::vector<std::string> lines() const;
};

/// Whether the bytes of samples are looked at, which takes nearly all of the time.
enum class SampleCheck { LookedAt, LeftOut };

SessionDamage damageOf(const Database& database, const std::vector<SessionTable>& tables, const std::string& schema,
                       const std::string& session_id, SampleCheck samples = SampleCheck::LookedAt);

/// Why the chunk cannot be read; empty: it can.
std::string chunkFault(const std::string& stream, const std::string& encoding, std::int64_t first_tick,
                       std::int64_t count, std::int64_t crc32, std::span<const std::byte> data);

}  // namespace passung::store
