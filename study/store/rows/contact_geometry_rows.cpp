#include "study/store/rows/contact_geometry_rows.h"

namespace passung::store {

std::vector<ContactGeometryRow> readContactGeometry(const Database& database, const std::string& protocol_sha256) {
    std::vector<ContactGeometryRow> rows;
    // Before the key was there, contact had distance fields only.
    Statement row = database.prepare(
        "SELECT json_extract(value, '$.condition'), "
        "coalesce(json_extract(value, '$.params.contact.geometry'), 'field'), "
        "coalesce(json_extract(value, '$.params.comparison.contact.geometry'), 'field') "
        "FROM protocol_version, json_each(expanded_json, '$.conditions') WHERE protocol_sha256=? ORDER BY key");
    row.bind(protocol_sha256);
    while (row.step()) rows.push_back({row.text(0), row.text(1), row.text(2)});
    return rows;
}

}  // namespace passung::store
