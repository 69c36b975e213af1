#include "study/store/rows/contact_energy_rows.h"

#include "study/store/schema/named_columns.h"

namespace passung::store {

void insertContactEnergy(const Database& database, std::int64_t attempt_id,
                         const std::vector<session::ContactEnergy>& pairs) {
    std::int64_t place = 0;
    for (const session::ContactEnergy& pair : pairs)
        insertRow(database, "contact_energy", Named{"attempt_id", attempt_id}, Named{"place", place++},
                  Named{"obstacle", nullIfEmpty(pair.obstacle)}, Named{"taken_in_J", pair.taken_in_J},
                  Named{"least_J", pair.least_J}, Named{"hand", nullIfEmpty(pair.hand)});
}

std::vector<session::ContactEnergy> readContactEnergy(const Database& database, std::int64_t attempt_id) {
    std::vector<session::ContactEnergy> pairs;
    Statement row = database.prepare(
        "SELECT coalesce(obstacle, ''), taken_in_J, least_J, coalesce(hand, '') FROM contact_energy WHERE attempt_id=? "
        "ORDER BY place");
    row.bind(attempt_id);
    while (row.step()) pairs.push_back({row.text(0), row.real(1), row.real(2), row.text(3)});
    return pairs;
}

}  // namespace passung::store
