#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "core/base/result.h"

struct sqlite3;
struct sqlite3_stmt;

namespace passung::store {

/// What SQLite refused, in its own words. Thrown inside this room only: every function that other rooms call
/// turns it into a Result through guarded().
class SqliteError : public std::runtime_error {
public:
    SqliteError(const std::string& message, int result_code) : std::runtime_error(message), code(result_code) {}
    int code;  // extended result code of SQLite
};

/// A text to bind, NULL for an empty one.
inline std::optional<std::string> nullIfEmpty(const std::string& text) {
    return text.empty() ? std::nullopt : std::optional(text);
}

/// One prepared statement. Parameters are numbered from 1, columns from 0.
class Statement {
public:
    Statement(sqlite3* connection, std::string_view sql);
    ~Statement();
    Statement(Statement&& other) noexcept;
    Statement& operator=(Statement&&) = delete;

    /// Binds all parameters in order; `std::nullopt` and nullptr bind NULL. Texts and blobs must outlive the steps.
    template <class... Values>
    Statement& bind(const Values&... values) {
        reset();
        int index = 0;
        (bindOne(++index, values), ...);
        return *this;
    }
    /// Binds one parameter; those that are not bound stay as they are.
    template <class Value>
    void bindAt(int index, const Value& value) {
        bindOne(index, value);
    }
    /// Moves to the next row; false when there is none.
    bool step();
    /// Runs a statement that returns no rows.
    void run();
    void reset();

    std::int64_t integer(int column) const;
    double real(int column) const;
    std::string text(int column) const;
    std::span<const std::byte> blob(int column) const;  // valid until the next step
    bool isNull(int column) const;
    std::optional<std::int64_t> optionalInteger(int column) const;
    std::optional<double> optionalReal(int column) const;
    std::optional<std::string> optionalText(int column) const;

private:
    void bindOne(int index, std::int64_t value);
    void bindOne(int index, std::uint64_t value) { bindOne(index, static_cast<std::int64_t>(value)); }
    void bindOne(int index, int value) { bindOne(index, static_cast<std::int64_t>(value)); }
    void bindOne(int index, std::uint32_t value) { bindOne(index, static_cast<std::int64_t>(value)); }
    void bindOne(int index, bool value) { bindOne(index, static_cast<std::int64_t>(value)); }
    void bindOne(int index, double value);
    void bindOne(int index, std::string_view value);
    void bindOne(int index, const std::string& value) { bindOne(index, std::string_view(value)); }
    void bindOne(int index, const char* value) { bindOne(index, std::string_view(value)); }
    void bindOne(int index, std::span<const std::byte> value);
    void bindOne(int index, std::nullptr_t);
    template <class T>
    void bindOne(int index, const std::optional<T>& value) {
        if (value) {
            bindOne(index, *value);
        } else {
            bindOne(index, nullptr);
        }
    }
    void check(int result) const;

    sqlite3_stmt* statement_ = nullptr;
};

enum class OpenMode {
    ReadOnly,
    Immutable,       // read only, without any file beside it: nobody may write it meanwhile
    Follow,          // reads; tidies SQLite's side files away when nobody else has the file open any more
    FollowUntidied,  // reads and leaves the side files as they are
    ReadWrite,
    Create,  // a new file is its owner's alone
};

/// One connection; closes itself. Foreign keys are on.
class Database {
public:
    Database(const std::string& path, OpenMode mode);
    ~Database();
    Database(const Database&) = delete;
    Database& operator=(const Database&) = delete;

    Statement prepare(std::string_view sql) const { return {connection_, sql}; }
    /// Runs one or several statements without parameters or rows of interest.
    void execute(const std::string& sql) const;
    std::int64_t integer(std::string_view sql) const;  // first column of the first row
    std::string text(std::string_view sql) const;
    /// The whole database as it is now into a new file, on the disk when this returns.
    void copyTo(const std::string& path) const;
    /// Rows of these tables that statements add or change are handed over at the end of each Transaction, within it.
    /// Not of tables WITHOUT ROWID.
    using ChangedRows = std::set<std::pair<std::string, std::int64_t>>;  // table, rowid
    void watch(std::set<std::string> tables, std::function<void(const Database&, const ChangedRows&)> changed);

    std::int64_t lastRowId() const;
    std::int64_t changes() const;  // rows that the last statement changed

private:
    void configure(OpenMode mode);
    friend class Transaction;
    struct Watch;
    void forgetChanges() const;
    void tellChanges() const;

    sqlite3* connection_ = nullptr;
    std::unique_ptr<Watch> watch_;  // null: nobody watches
};

/// How hard a commit is: Full reaches the disk before commit() returns, Normal with the next Full one.
enum class Durability { Normal, Full };

/// Rolls back unless committed.
class Transaction {
public:
    explicit Transaction(const Database& database, Durability durability = Durability::Full);
    ~Transaction();
    Transaction(const Transaction&) = delete;
    Transaction& operator=(const Transaction&) = delete;
    void commit();

private:
    const Database& database_;
    bool open_ = true;
};

/// A part of a transaction: undoes everything since it was made unless it is kept.
class Savepoint {
public:
    explicit Savepoint(const Database& database);
    ~Savepoint();
    Savepoint(const Savepoint&) = delete;
    Savepoint& operator=(const Savepoint&) = delete;
    void keep() { kept_ = true; }

private:
    const Database& database_;
    bool kept_ = false;
};

/// Tells whether the file is no sound database, as opposed to a disk, another program or a statement at fault.
bool isDamage(const SqliteError& error);
/// Tells whether the disk, memory or another program is at fault, whatever the file holds.
bool isOfTheDisk(const SqliteError& error);

/// A readable error for `path`.
Error sqliteError(const std::string& path, const SqliteError& error);

/// Runs `work` and turns what it throws into errors that name the file.
template <class Work>
auto guarded(const std::string& path, Work&& work) -> Result<decltype(work())> {
    try {
        return work();
    } catch (const SqliteError& error) {
        return sqliteError(path, error);
    } catch (const std::exception& error) {
        return Error{.message = error.what(), .file = path, .key = {}, .value = {}};
    }
}

}  // namespace passung::store
