#include "study/store/transfer/heal.h"

namespace passung::store {

void Healer::healChunks(const SessionDamage& damage, std::vector<std::string>& healed) {
    for (const ChunkFault& fault : damage.chunks)
        if (healChunk(fault)) healed.push_back(damage.name + ", " + fault.unit + ": " + fault.what);
}

/// The same chunk there is one that is sound and has the same checksum; or the same bytes, if the checksum is damaged.
bool Healer::healChunk(const ChunkFault& fault) {
    std::int64_t stream = 0;
    for (const auto& [there, here] : numbers_["stream"])
        if (here == fault.stream_id) stream = there;
    Statement there = database_.prepare(
        "SELECT t.first_tick, t.n, t.crc32, t.data, s.stream, s.encoding, t.crc32=m.crc32 OR t.data=m.data FROM " +
        source_ + ".sample_chunk t JOIN " + source_ +
        ".stream s ON s.stream_id=t.stream_id JOIN main.sample_chunk m ON m.stream_id=?3 AND m.chunk_no=t.chunk_no "
        "WHERE "
        "t.stream_id=?1 AND t.chunk_no=?2");
    if (!there.bind(stream, fault.chunk_no, fault.stream_id).step() || there.integer(6) == 0) return false;
    if (!chunkFault(there.text(4), there.text(5), there.integer(0), there.integer(1), there.integer(2), there.blob(3))
             .empty())
        return false;
    database_
        .prepare(
            "UPDATE main.sample_chunk SET (first_tick, n, t0_ns, crc32, data)=(SELECT first_tick, n, t0_ns, "
            "crc32, data FROM " +
            source_ + ".sample_chunk WHERE stream_id=?1 AND chunk_no=?2) WHERE stream_id=?3 AND chunk_no=?2")
        .bind(stream, fault.chunk_no, fault.stream_id)
        .run();
    return true;
}

/// What a chunk says of itself; its bytes only where it is not here at all.
void Healer::replaceSamples(std::int64_t there) {
    const SessionTable& chunks = table("sample_chunk");
    Statement rows = database_.prepare(
        "SELECT t.stream_id, t.chunk_no, n.here, t.first_tick, t.n, t.crc32, t.data, s.stream, s.encoding FROM " +
        source_ + ".sample_chunk t JOIN " + source_ +
        ".stream s USING(stream_id) JOIN temp.heal_number n ON "
        "n.table_name='stream' AND n.there=t.stream_id WHERE t.attempt_id=?");
    rows.bind(there);
    while (rows.step()) {
        database_
            .prepare(
                "UPDATE main.sample_chunk SET (attempt_id, first_tick, n, t0_ns, crc32)=(SELECT ?4, first_tick, n, "
                "t0_ns, crc32 FROM " +
                source_ +
                ".sample_chunk WHERE stream_id=?1 AND chunk_no=?2) WHERE "
                "stream_id=?3 AND chunk_no=?2")
            .bind(rows.integer(0), rows.integer(1), rows.integer(2), numbers_["attempt"][there])
            .run();
        if (database_.changes() > 0) continue;
        if (chunkFault(rows.text(7), rows.text(8), rows.integer(3), rows.integer(4), rows.integer(5), rows.blob(6))
                .empty())
            copy(chunks, "t.stream_id=?1 AND t.chunk_no=" + rows.text(1), rows.integer(0));
    }
}

}  // namespace passung::store
