#pragma once

#include <sqlite3.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <vector>

/// A disk between SQLite and the real one, for faults at a chosen moment. Valid for every database opened in this
/// process while the object lives.
namespace passung::fake {

/// A moment at which the file system is about to change, counted from 1.
/// Commit: a write that makes a transaction of the log count.
enum class DiskWork { Write, Commit, Sync, Truncate, Delete };

struct DiskFault {
    int result = SQLITE_OK;  // what SQLite is told instead of a success; SQLITE_OK: the work is done
    double share = 1.0;      // of a write's bytes that reach the disk all the same
};

class FaultyDisk {
public:
    /// `before` is asked before every work; it may also wait, or end the process.
    explicit FaultyDisk(std::function<DiskFault(DiskWork, std::int64_t number)> before) : before_(std::move(before)) {
        real_ = sqlite3_vfs_find(nullptr);
        vfs_ = *real_;
        vfs_.zName = "passung_faulty";
        vfs_.szOsFile = static_cast<int>(sizeof(File)) + real_->szOsFile;
        vfs_.pAppData = this;
        vfs_.xOpen = [](sqlite3_vfs* vfs, const char* name, sqlite3_file* file, int flags, int* out) {
            auto* self = static_cast<FaultyDisk*>(vfs->pAppData);
            auto* mine = reinterpret_cast<File*>(file);
            mine->disk = self;
            const int result = self->real_->xOpen(self->real_, name, below(file), flags, out);
            file->pMethods = below(file)->pMethods != nullptr ? &methods() : nullptr;
            return result;
        };
        vfs_.xDelete = [](sqlite3_vfs* vfs, const char* name, int sync) {
            auto* self = static_cast<FaultyDisk*>(vfs->pAppData);
            const DiskFault fault = self->before_(DiskWork::Delete, ++self->count_);
            return fault.result != SQLITE_OK ? fault.result : self->real_->xDelete(self->real_, name, sync);
        };
        sqlite3_vfs_register(&vfs_, 1);
    }
    ~FaultyDisk() {
        sqlite3_vfs_unregister(&vfs_);
        sqlite3_vfs_register(real_, 1);
    }
    FaultyDisk(const FaultyDisk&) = delete;
    FaultyDisk& operator=(const FaultyDisk&) = delete;

private:
    struct File {
        sqlite3_file base;
        FaultyDisk* disk;
    };

    static sqlite3_file* below(sqlite3_file* file) {
        return reinterpret_cast<sqlite3_file*>(reinterpret_cast<File*>(file) + 1);
    }

    DiskFault ask(DiskWork work) { return before_(work, ++count_); }

    /// The header of a frame in the log has 24 bytes; those from the fifth on say how large the database is after a
    /// commit, and are 0 in every other frame.
    static bool isCommit(const void* bytes, int count) {
        const auto* header = static_cast<const unsigned char*>(bytes);
        return count == 24 && std::any_of(header + 4, header + 8, [](unsigned char byte) { return byte != 0; });
    }

    static int write(sqlite3_file* file, const void* bytes, int count, sqlite3_int64 offset) {
        const DiskWork work = isCommit(bytes, count) ? DiskWork::Commit : DiskWork::Write;
        const DiskFault fault = reinterpret_cast<File*>(file)->disk->ask(work);
        const int reached = static_cast<int>(fault.share * count);
        const int result = below(file)->pMethods->xWrite(below(file), bytes, reached, offset);
        return fault.result != SQLITE_OK ? fault.result : result;
    }

    static const sqlite3_io_methods& methods() {
        static const sqlite3_io_methods table = [] {
            sqlite3_io_methods m{};
            m.iVersion = 3;
            m.xClose = [](sqlite3_file* f) { return below(f)->pMethods->xClose(below(f)); };
            m.xRead = [](sqlite3_file* f, void* to, int n, sqlite3_int64 at) {
                return below(f)->pMethods->xRead(below(f), to, n, at);
            };
            m.xWrite = write;
            m.xTruncate = [](sqlite3_file* f, sqlite3_int64 size) {
                const DiskFault fault = reinterpret_cast<File*>(f)->disk->ask(DiskWork::Truncate);
                return fault.result != SQLITE_OK ? fault.result : below(f)->pMethods->xTruncate(below(f), size);
            };
            m.xSync = [](sqlite3_file* f, int flags) {
                const DiskFault fault = reinterpret_cast<File*>(f)->disk->ask(DiskWork::Sync);
                return fault.result != SQLITE_OK ? fault.result : below(f)->pMethods->xSync(below(f), flags);
            };
            m.xFileSize = [](sqlite3_file* f, sqlite3_int64* size) {
                return below(f)->pMethods->xFileSize(below(f), size);
            };
            m.xLock = [](sqlite3_file* f, int lock) { return below(f)->pMethods->xLock(below(f), lock); };
            m.xUnlock = [](sqlite3_file* f, int lock) { return below(f)->pMethods->xUnlock(below(f), lock); };
            m.xCheckReservedLock = [](sqlite3_file* f, int* out) {
                return below(f)->pMethods->xCheckReservedLock(below(f), out);
            };
            m.xFileControl = [](sqlite3_file* f, int op, void* arg) {
                return below(f)->pMethods->xFileControl(below(f), op, arg);
            };
            m.xSectorSize = [](sqlite3_file* f) { return below(f)->pMethods->xSectorSize(below(f)); };
            m.xDeviceCharacteristics = [](sqlite3_file* f) {
                return below(f)->pMethods->xDeviceCharacteristics(below(f));
            };
            m.xShmMap = [](sqlite3_file* f, int page, int size, int extend, void volatile** out) {
                return below(f)->pMethods->xShmMap(below(f), page, size, extend, out);
            };
            m.xShmLock = [](sqlite3_file* f, int offset, int n, int flags) {
                return below(f)->pMethods->xShmLock(below(f), offset, n, flags);
            };
            m.xShmBarrier = [](sqlite3_file* f) { below(f)->pMethods->xShmBarrier(below(f)); };
            m.xShmUnmap = [](sqlite3_file* f, int remove) { return below(f)->pMethods->xShmUnmap(below(f), remove); };
            m.xFetch = [](sqlite3_file* f, sqlite3_int64 at, int n, void** out) {
                return below(f)->pMethods->xFetch(below(f), at, n, out);
            };
            m.xUnfetch = [](sqlite3_file* f, sqlite3_int64 at, void* page) {
                return below(f)->pMethods->xUnfetch(below(f), at, page);
            };
            return m;
        }();
        return table;
    }

    std::function<DiskFault(DiskWork, std::int64_t)> before_;
    std::int64_t count_ = 0;  // used by one connection's thread at a time
    sqlite3_vfs* real_ = nullptr;
    sqlite3_vfs vfs_{};
};

}  // namespace passung::fake
