#pragma once

#include <sqlite3.h>

#include <atomic>
#include <string_view>

namespace passung::test {

/// Counts how often a whole database is walked through by SQLite's own checks, over all connections of the process
/// that are opened while it lives.
class CountChecks {
public:
    CountChecks() {
        count_ = 0;
        sqlite3_auto_extension(reinterpret_cast<void (*)()>(watch));
    }
    ~CountChecks() { sqlite3_cancel_auto_extension(reinterpret_cast<void (*)()>(watch)); }
    CountChecks(const CountChecks&) = delete;
    CountChecks& operator=(const CountChecks&) = delete;

    int count() const { return count_; }

private:
    static int watch(sqlite3* connection, char**, const sqlite3_api_routines*) {
        return sqlite3_trace_v2(connection, SQLITE_TRACE_STMT, see, nullptr);
    }
    static int see(unsigned, void*, void*, void* text) {
        const std::string_view statement(static_cast<const char*>(text));
        // What SQLite runs within another statement, as for a new column of a table, begins with a comment.
        if (statement.starts_with("PRAGMA quick_check") || statement.starts_with("PRAGMA integrity_check")) ++count_;
        return 0;
    }

    static inline std::atomic<int> count_{0};
};

}  // namespace passung::test
