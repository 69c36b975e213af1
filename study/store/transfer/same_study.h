#pragma once

#include <functional>
#include <string>

#include "study/store/schema/sqlite.h"

namespace passung::store {

/// Whether the rows of the attached database `other` may be put beside those of the main one: the same study, one text,
/// seed, meshes, pictures, stiffness and pick of accuracy for every version of the protocol, one formula for every
/// measure, and one person for every code. Hands the first thing that differs to `refuse`, which throws.
void requireSameStudy(const Database& database, const std::string& other,
                      const std::function<void(const std::string& reason)>& refuse);

}  // namespace passung::store
