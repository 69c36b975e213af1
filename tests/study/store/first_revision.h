#pragma once

#include <string>

#include "study/store/schema/revisions.h"
#include "study/store/schema/sqlite.h"

namespace passung::fake {

/// A file of the first schema revision, made by that revision's own statement, and what `more` executes in it.
inline void makeFirstRevision(const std::string& path, const std::string& more = {}) {
    const store::Database old(path, store::OpenMode::Create);
    old.execute("PRAGMA application_id=" + std::to_string(store::kApplicationId));
    old.execute(store::revisions().front().sql);
    old.prepare("INSERT INTO schema_revision VALUES(1, 'first', 1, '')").run();
    if (!more.empty()) old.execute(more);
}

}  // namespace passung::fake
