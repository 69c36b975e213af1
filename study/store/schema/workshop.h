#pragma once

#include <string>

namespace passung::store {

/// Removes a database and SQLite's files beside it.
void removeDatabase(const std::string& path);

/// Private files beside a database that last as long as the work on it.
struct Workshop {
    std::string part;     // what takes the database's place in the end
    std::string source;   // a copy of another database
    std::string damaged;  // a copy of the database itself
    explicit Workshop(const std::string& path);
    ~Workshop() { clear(); }
    Workshop(const Workshop&) = delete;
    Workshop& operator=(const Workshop&) = delete;

private:
    void clear() const;
};

}  // namespace passung::store
