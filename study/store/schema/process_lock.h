#pragma once

#include <string>

#include "core/base/result.h"

namespace passung::store {

/// Lets one process at a time write a database: an advisory lock on `<database>.lock` (links resolved), which the
/// system releases however the process ends. SQLite's own locks last only for a transaction, and recovery must not meet
/// a live session.
class ProcessLock {
public:
    /// Fails at once if another process (or another store of this one) holds it.
    static Result<ProcessLock> take(const std::string& database_path);
    ~ProcessLock();
    ProcessLock(ProcessLock&& other) noexcept;
    ProcessLock& operator=(ProcessLock&&) = delete;

private:
    ProcessLock(std::string path, int descriptor) : path_(std::move(path)), descriptor_(descriptor) {}

    std::string path_;
    int descriptor_ = -1;
};

/// Tells whether a process holds that lock, or one that this user may not look at. `database_path`: links resolved.
bool isBeingWritten(const std::string& database_path);

}  // namespace passung::store
