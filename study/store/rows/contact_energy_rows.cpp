#include "study/store/rows/contact_energy_rows.h"

namespace passung::store {

void insertContactEnergy(const Database& database, std::int64_t attempt_id,
                         const std::vector<session::ContactEnergy>& pairs) {
    Statement insert = database.prepare("INSERT INTO contact_energy VALUES(?, ?, ?, ?, ?)");
    std::int64_t place = 0;
    for (const session::ContactEnergy& pair : pairs)
        insert.bind(attempt_id, place++, nullIfEmpty(pair.obstacle), pair.taken_in_J, pair.least_J).run();
}

std::vector<session::ContactEnergy> readContactEnergy(const Database& database, std::int64_t attempt_id) {
    std::vector<session::ContactEnergy> pairs;
    Statement row = database.prepare(
        "SELECT coalesce(obstacle, ''), taken_in_J, least_J FROM contact_energy WHERE attempt_id=? ORDER BY place");
    row.bind(attempt_id);
    while (row.step()) pairs.push_back({row.text(0), row.real(1), row.real(2)});
    return pairs;
}

}  // namespace passung::store
