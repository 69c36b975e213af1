#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "study/design/allocation.h"
#include "study/store/schema/sqlite.h"

namespace passung::store {

/// What the stored protocol's slots are: groups and allocation as its expanded form has them. Protocols from before
/// there were groups have one.
struct SlotDesign {
    std::vector<std::string> groups;
    std::string study;
    design::Allocation allocation;  // without `study`
    std::vector<std::size_t> rows;  // of everything that takes turns; of older protocols all of it together
};

SlotDesign slotDesignOf(const Database& database, const std::string& sha256);

/// Adds the next round of slots of this kind of participant, in the order in which they are taken.
void insertSlots(const Database& database, const std::string& sha256, const char* kind);

/// How many slots the protocol has.
std::int64_t slotCount(const Database& database, const std::string& sha256);

}  // namespace passung::store
