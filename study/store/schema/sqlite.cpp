#include "study/store/schema/sqlite.h"

#include <sqlite3.h>

#include "core/base/hex_text.h"
#include "core/base/regular_file.h"
#include "study/store/schema/private_files.h"

namespace passung::store {
namespace {

[[noreturn]] void fail(sqlite3* connection, int code) {
    const char* message = connection ? sqlite3_errmsg(connection) : sqlite3_errstr(code);
    throw SqliteError(message, connection ? sqlite3_extended_errcode(connection) : code);
}

constexpr int kBusyTimeoutMs = 5000;

int flagsOf(OpenMode mode) {
    constexpr int kAlways = SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_EXRESCODE;
    switch (mode) {
        case OpenMode::ReadOnly:
            return kAlways | SQLITE_OPEN_READONLY;
        case OpenMode::Immutable:
            return kAlways | SQLITE_OPEN_READONLY | SQLITE_OPEN_URI;
        case OpenMode::Create:
            return kAlways | SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
        case OpenMode::Follow:
        case OpenMode::FollowUntidied:
        case OpenMode::ReadWrite:
            break;
    }
    return kAlways | SQLITE_OPEN_READWRITE;
}

/// The characters that mean something in a URI as their codes.
std::string immutableUri(const std::string& path) {
    std::string uri = "file:";
    for (const char letter : path) {
        if (letter == '%' || letter == '?' || letter == '#')
            uri += '%' + hexText(std::span(reinterpret_cast<const unsigned char*>(&letter), 1));
        else
            uri += letter;
    }
    return uri + "?immutable=1";
}

}  // namespace

Statement::Statement(sqlite3* connection, std::string_view sql) {
    const int result = sqlite3_prepare_v2(connection, sql.data(), static_cast<int>(sql.size()), &statement_, nullptr);
    if (result != SQLITE_OK) fail(connection, result);
}

Statement::Statement(Statement&& other) noexcept : statement_(other.statement_) { other.statement_ = nullptr; }

Statement::~Statement() { sqlite3_finalize(statement_); }

void Statement::check(int result) const {
    if (result != SQLITE_OK) fail(sqlite3_db_handle(statement_), result);
}

bool Statement::step() {
    const int result = sqlite3_step(statement_);
    if (result == SQLITE_ROW) return true;
    if (result == SQLITE_DONE) return false;
    sqlite3* connection = sqlite3_db_handle(statement_);
    const SqliteError error(sqlite3_errmsg(connection), sqlite3_extended_errcode(connection));
    sqlite3_reset(statement_);
    throw error;
}

void Statement::run() {
    while (step()) {
    }
    sqlite3_reset(statement_);
}

void Statement::reset() {
    sqlite3_reset(statement_);
    sqlite3_clear_bindings(statement_);
}

std::int64_t Statement::integer(int column) const { return sqlite3_column_int64(statement_, column); }
double Statement::real(int column) const { return sqlite3_column_double(statement_, column); }

std::string Statement::text(int column) const {
    const auto* start = reinterpret_cast<const char*>(sqlite3_column_text(statement_, column));
    if (!start) return {};
    return {start, static_cast<std::size_t>(sqlite3_column_bytes(statement_, column))};
}

std::span<const std::byte> Statement::blob(int column) const {
    const auto* start = static_cast<const std::byte*>(sqlite3_column_blob(statement_, column));
    return {start, start ? static_cast<std::size_t>(sqlite3_column_bytes(statement_, column)) : 0};
}

bool Statement::isNull(int column) const { return sqlite3_column_type(statement_, column) == SQLITE_NULL; }

std::optional<std::int64_t> Statement::optionalInteger(int column) const {
    if (isNull(column)) return std::nullopt;
    return integer(column);
}

std::optional<double> Statement::optionalReal(int column) const {
    if (isNull(column)) return std::nullopt;
    return real(column);
}

std::optional<std::string> Statement::optionalText(int column) const {
    if (isNull(column)) return std::nullopt;
    return text(column);
}

void Statement::bindOne(int index, std::int64_t value) { check(sqlite3_bind_int64(statement_, index, value)); }
void Statement::bindOne(int index, double value) { check(sqlite3_bind_double(statement_, index, value)); }
void Statement::bindOne(int index, std::nullptr_t) { check(sqlite3_bind_null(statement_, index)); }

void Statement::bindOne(int index, std::string_view value) {
    check(sqlite3_bind_text64(statement_, index, value.data() ? value.data() : "", value.size(), SQLITE_STATIC,
                              SQLITE_UTF8));
}

void Statement::bindOne(int index, std::span<const std::byte> value) {
    check(sqlite3_bind_blob64(statement_, index, value.data(), value.size(), SQLITE_STATIC));
}

struct Database::Watch {
    std::set<std::string> tables;
    std::function<void(const Database&, const ChangedRows&)> tell;
    ChangedRows changed;
};

Database::Database(const std::string& path, OpenMode mode) {
    if (const auto why = whyNoRegularFile(path)) throw SqliteError(*why, SQLITE_CANTOPEN);
    for (const std::string& beside : {path + "-journal", path + "-wal"})  // which SQLite opens by itself
        if (const auto why = whyNoRegularFile(beside)) throw SqliteError(beside + ": " + *why, SQLITE_CANTOPEN);
    if (mode == OpenMode::Create) makePrivate(path);
    const std::string name = mode == OpenMode::Immutable ? immutableUri(path) : path;
    const int result = sqlite3_open_v2(name.c_str(), &connection_, flagsOf(mode), nullptr);
    if (result != SQLITE_OK) {
        const SqliteError error(connection_ ? sqlite3_errmsg(connection_) : sqlite3_errstr(result), result);
        sqlite3_close_v2(connection_);
        throw error;
    }
    try {
        configure(mode);
    } catch (...) {
        sqlite3_close_v2(connection_);
        throw;
    }
}

void Database::configure(OpenMode mode) {
    sqlite3_busy_timeout(connection_, kBusyTimeoutMs);
    if (mode == OpenMode::FollowUntidied) sqlite3_db_config(connection_, SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, 1, nullptr);
    // A connection that may write tidies the side files away when it closes; query_only keeps it from writing.
    if (mode == OpenMode::Follow || mode == OpenMode::FollowUntidied) execute("PRAGMA query_only=ON");
    execute("PRAGMA foreign_keys=ON");
}

Database::~Database() { sqlite3_close_v2(connection_); }

void Database::watch(std::set<std::string> tables, std::function<void(const Database&, const ChangedRows&)> changed) {
    watch_ = std::make_unique<Watch>(Watch{std::move(tables), std::move(changed), {}});
    sqlite3_update_hook(
        connection_,
        [](void* context, int, const char* schema, const char* table, sqlite3_int64 rowid) {
            auto& watch = *static_cast<Watch*>(context);
            if (std::string_view(schema) == "main" && watch.tables.count(table) != 0)
                watch.changed.emplace(table, rowid);
        },
        watch_.get());
}

void Database::forgetChanges() const {
    if (watch_) watch_->changed.clear();
}

void Database::tellChanges() const {
    if (!watch_ || watch_->changed.empty()) return;
    const ChangedRows changed = std::exchange(watch_->changed, {});
    watch_->tell(*this, changed);
}

void Database::execute(const std::string& sql) const {
    const int result = sqlite3_exec(connection_, sql.c_str(), nullptr, nullptr, nullptr);
    if (result != SQLITE_OK) fail(connection_, result);
}

std::int64_t Database::integer(std::string_view sql) const {
    Statement statement = prepare(sql);
    return statement.step() ? statement.integer(0) : 0;
}

std::string Database::text(std::string_view sql) const {
    Statement statement = prepare(sql);
    return statement.step() ? statement.text(0) : std::string();
}

void Database::copyTo(const std::string& path) const {
    const Database copy(path, OpenMode::Create);
    sqlite3_backup* backup = sqlite3_backup_init(copy.connection_, "main", connection_, "main");
    if (backup == nullptr) fail(copy.connection_, sqlite3_errcode(copy.connection_));
    const int result = sqlite3_backup_step(backup, -1);
    sqlite3_backup_finish(backup);
    if (result != SQLITE_DONE) throw SqliteError(sqlite3_errstr(result), result);
}

std::int64_t Database::lastRowId() const { return sqlite3_last_insert_rowid(connection_); }
std::int64_t Database::changes() const { return sqlite3_changes64(connection_); }

Transaction::Transaction(const Database& database, Durability durability) : database_(database) {
    database_.execute(durability == Durability::Full ? "PRAGMA synchronous=FULL; BEGIN IMMEDIATE"
                                                     : "PRAGMA synchronous=NORMAL; BEGIN IMMEDIATE");
    database_.forgetChanges();
}

Transaction::~Transaction() {
    if (!open_) return;
    try {
        database_.execute("ROLLBACK");
    } catch (const SqliteError&) {
        // SQLite has already rolled back by itself (a full disk does that): nothing is left to undo.
    }
}

void Transaction::commit() {
    database_.tellChanges();
    database_.execute("COMMIT");
    open_ = false;
}

Savepoint::Savepoint(const Database& database) : database_(database) { database_.execute("SAVEPOINT part"); }

Savepoint::~Savepoint() {
    try {
        database_.execute(kept_ ? "RELEASE part" : "ROLLBACK TO part; RELEASE part");
    } catch (const SqliteError&) {
        // SQLite has already rolled the whole transaction back (a full disk does that): the next statement says so.
    }
}

bool isDamage(const SqliteError& error) {
    const int code = error.code & 0xff;
    return code == SQLITE_CORRUPT || code == SQLITE_NOTADB;
}

bool isOfTheDisk(const SqliteError& error) {
    const int code = error.code & 0xff;
    return code == SQLITE_FULL || code == SQLITE_IOERR || code == SQLITE_NOMEM || code == SQLITE_READONLY ||
           code == SQLITE_CANTOPEN || code == SQLITE_BUSY;
}

Error sqliteError(const std::string& path, const SqliteError& error) {
    std::string message = error.what();
    switch (error.code & 0xff) {
        case SQLITE_FULL:
            message = "no space left for the database (" + message + ")";
            break;
        case SQLITE_BUSY:
        case SQLITE_LOCKED:
            message = "another program is using the database (" + message + ")";
            break;
        case SQLITE_NOTADB:
            message = "not a Passung database (" + message + ")";
            break;
        case SQLITE_CORRUPT:
            message = "the database is damaged (" + message + ")";
            break;
        case SQLITE_CANTOPEN:
            message = "cannot be opened (" + message + ")";
            break;
        case SQLITE_IOERR:
            message = "the disk refuses it (" + message + ")";
            break;
        case SQLITE_READONLY:
            message = "cannot be written (" + message + ")";
            break;
        default:
            break;
    }
    return Error{.message = message, .file = path, .key = {}, .value = {}};
}

}  // namespace passung::store
