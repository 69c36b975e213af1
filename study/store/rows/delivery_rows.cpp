#include "study/store/rows/delivery_rows.h"

#include "study/store/schema/named_columns.h"

namespace passung::store {

void insertDelivery(const Database& database, std::int64_t attempt_id, const session::Delivered& delivered) {
    insertRow(database, "delivery", Named{"attempt_id", attempt_id}, Named{"force_ticks", delivered.force},
              Named{"visual_frames", delivered.visual}, Named{"vibrotactile_ticks", delivered.vibration},
              Named{"audio_ticks", delivered.sound}, Named{"masking_ticks", delivered.masking});
}

std::optional<session::Delivered> readDelivery(const Database& database, std::int64_t attempt_id) {
    using session::Delivered;
    static const Selection<Delivered> columns = {{"force_ticks", &Delivered::force},
                                                 {"visual_frames", &Delivered::visual},
                                                 {"vibrotactile_ticks", &Delivered::vibration},
                                                 {"audio_ticks", &Delivered::sound},
                                                 {"masking_ticks", &Delivered::masking}};
    Statement row = database.prepare("SELECT " + columns.text() + " FROM delivery WHERE attempt_id=?");
    if (!row.bind(attempt_id).step()) return std::nullopt;
    return columns.read(row);
}

}  // namespace passung::store
