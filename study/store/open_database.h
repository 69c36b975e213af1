#pragma once

#include <memory>
#include <string>

#include "study/store/sqlite.h"
#include "study/store/store.h"

namespace passung::store {

/// A checked, current database ready for writing, or why there is none.
struct OpenedDatabase {
    OpenOutcome outcome = OpenOutcome::Failed;
    std::unique_ptr<Database> database;
    RecoveryReport recovery;
    Errors errors;
};

/// The steps of Store::open() after its lock is taken: open, inspect, check, upgrade, mark what crashed.
OpenedDatabase openForWriting(const std::string& path, const OpenOptions& options);

/// Opens an existing Passung file that this program can read, without changing it.
Result<std::unique_ptr<Database>> openForReading(const std::string& path);

}  // namespace passung::store
