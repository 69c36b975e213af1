#pragma once

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include "tests/study/store/fake_study.h"

namespace passung::fake {

/// A copy of a database as a program that was killed leaves it: what it did last, the enrolment of S009, stands in the
/// log beside the file alone.
class KilledFile {
public:
    KilledFile(const std::string& database, std::string copy) : path_(std::move(copy)) {
        const auto store = openStore(database);
        require(store->enrol("S009", plan::ParticipantKind::Simulated, "2001"));
        for (const char* suffix : {"", kLog}) std::filesystem::copy_file(database + suffix, path_ + suffix);
        file_ = bytesOf(path_);
        log_ = bytesOf(path_ + kLog);
        if (log_.empty()) throw std::runtime_error(path_ + " has no log");
    }
    const std::string& path() const { return path_; }
    /// Is every byte of file and log as it was?
    bool isUntouched() const { return bytesOf(path_) == file_ && bytesOf(path_ + kLog) == log_; }

private:
    static constexpr const char* kLog = "-wal";

    static std::string bytesOf(const std::string& path) {
        std::ifstream file(path, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }

    std::string path_, file_, log_;
};

}  // namespace passung::fake
