#include "study/store/rows/stable_stiffness_rows.h"

namespace passung::store {

std::vector<plan::StableStiffness> readStableStiffness(const Database& database, const std::string& protocol_sha256) {
    std::vector<plan::StableStiffness> rows;
    if (database.integer("SELECT count(*) FROM sqlite_master WHERE name='stable_stiffness'") == 0) return rows;
    Statement row = database.prepare(
        "SELECT device, stable_stiffness_N_per_m, stable_rotational_stiffness_Nm_per_rad, origin "
        "FROM stable_stiffness WHERE protocol_sha256=? ORDER BY device");
    row.bind(protocol_sha256);
    while (row.step()) rows.push_back({row.text(0), row.real(1), row.real(2), row.text(3)});
    return rows;
}

}  // namespace passung::store
