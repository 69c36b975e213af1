#include "study/store/rows/delivery_rows.h"

namespace passung::store {

void insertDelivery(const Database& database, std::int64_t attempt_id, const session::Delivered& delivered) {
    database.prepare("INSERT INTO delivery VALUES(?, ?, ?, ?, ?, ?)")
        .bind(attempt_id, delivered.force, delivered.visual, delivered.vibration, delivered.sound, delivered.masking)
        .run();
}

std::optional<session::Delivered> readDelivery(const Database& database, std::int64_t attempt_id) {
    Statement row = database.prepare(
        "SELECT force_ticks, visual_frames, vibrotactile_ticks, audio_ticks, masking_ticks FROM delivery "
        "WHERE attempt_id=?");
    if (!row.bind(attempt_id).step()) return std::nullopt;
    return session::Delivered{row.integer(0), row.integer(1), row.integer(2), row.integer(3), row.integer(4)};
}

}  // namespace passung::store
