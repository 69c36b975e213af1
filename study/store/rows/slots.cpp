#include "study/store/rows/slots.h"

#include <stdexcept>

#include "study/plan/participant.h"

namespace passung::store {

SlotDesign slotDesignOf(const Database& database, const std::string& sha256) {
    SlotDesign slots;
    Statement each = database.prepare(
        "SELECT g.value FROM protocol_version p, json_each(p.expanded_json, '$.groups') g WHERE protocol_sha256=?");
    each.bind(sha256);
    while (each.step()) slots.groups.push_back(each.text(0));
    if (slots.groups.empty()) slots.groups = {"all"};
    Statement find = database.prepare(
        "SELECT name, sequences, coalesce(json_extract(expanded_json, '$.allocation_blocks'), 1), "
        "json_extract(expanded_json, '$.seed') FROM protocol_version WHERE protocol_sha256=?");
    if (!find.bind(sha256).step()) throw std::runtime_error("the protocol has not been imported");
    slots.study = find.text(0);
    slots.allocation.groups = slots.groups.size();
    slots.allocation.sequences = static_cast<std::size_t>(find.integer(1));
    slots.allocation.blocks_of = static_cast<std::size_t>(find.integer(2));
    slots.allocation.seed = static_cast<std::uint64_t>(find.integer(3));
    Statement rows = database.prepare(
        "SELECT r.value FROM protocol_version p, json_each(p.expanded_json, '$.rows') r WHERE protocol_sha256=?");
    rows.bind(sha256);
    while (rows.step()) slots.rows.push_back(static_cast<std::size_t>(rows.integer(0)));
    if (slots.rows.empty()) slots.rows = {slots.allocation.sequences};
    return slots;
}

void insertSlots(const Database& database, const std::string& sha256, const char* kind) {
    SlotDesign slots = slotDesignOf(database, sha256);
    slots.allocation.study = slots.study;
    Statement count = database.prepare("SELECT count(*) FROM design_slot WHERE protocol_sha256=? AND kind=?");
    count.bind(sha256, kind).step();
    const design::Allocation& a = slots.allocation;
    const auto round = static_cast<std::size_t>(count.integer(0)) / (a.groups * a.sequences * a.blocks_of);
    Statement insert = database.prepare(
        "INSERT INTO design_slot(protocol_sha256, between_group, sequence_index, replicate, state, kind) "
        "VALUES(?, ?, ?, ?, 'free', ?)");
    for (const design::Place& place : design::placesOf(a, plan::kAllocationStratum, round))
        insert
            .bind(sha256, slots.groups[place.group], static_cast<std::int64_t>(place.sequence),
                  static_cast<std::int64_t>(place.replicate), kind)
            .run();
}

std::int64_t slotCount(const Database& database, const std::string& sha256) {
    Statement count = database.prepare("SELECT count(*) FROM design_slot WHERE protocol_sha256=?");
    count.bind(sha256).step();
    return count.integer(0);
}

}  // namespace passung::store
