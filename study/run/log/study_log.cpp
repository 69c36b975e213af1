#include "study/run/log/study_log.h"

#include <fcntl.h>
#include <spdlog/logger.h>
#include <spdlog/sinks/rotating_file_sink.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "core/tick/numerics.h"
#include "study/run/files/data_folder.h"
#include "study/run/log/discreet.h"
#include "study/run/machine/host.h"
#include "study/store/schema/private_files.h"

namespace passung::run {

namespace {

namespace fs = std::filesystem;

std::string startText(const std::string& program) {
    return program + " " + PASSUNG_VERSION + " starts; numerics " + std::to_string(tick::kNumerics) + ", compiler " +
           __VERSION__ + ", " + machineText();
}

/// Nothing that waits for a reader or leads elsewhere.
bool isPlain(const fs::path& path) {
    std::error_code none;
    return fs::is_regular_file(fs::symlink_status(path, none));
}

std::unique_ptr<spdlog::logger> openLogger(const std::string& database) {
    spdlog::file_event_handlers handlers;
    handlers.before_open = [](const std::string& path) {
        store::makePrivate(path);
        if (!isPlain(path)) throw std::runtime_error("is no regular file");
    };
    handlers.after_open = [database](const std::string& path, std::FILE* file) {
        fcntl(fileno(file), F_SETFD, FD_CLOEXEC);
        store::shareLike(database, path);
    };
    auto sink = std::make_shared<spdlog::sinks::rotating_file_sink_st>(  // shared_ptr: what a logger takes
        database + store::kLogFiles.front(), kLogBytes, store::kLogFiles.size() - 1, false, handlers);
    auto logger = std::make_unique<spdlog::logger>("study", std::move(sink));
    logger->set_pattern("%Y-%m-%dT%H:%M:%S.%eZ %l: %v", spdlog::pattern_time_type::utc);
    logger->flush_on(spdlog::level::trace);
    return logger;
}

}  // namespace

struct StudyLog::File {
    struct Line {
        spdlog::log_clock::time_point when;
        spdlog::level::level_enum level;
        std::string text;
    };

    std::string database;
    Warn warn;
    std::vector<std::string> left_out = {};
    std::vector<Line> waiting = {};  // for begin()
    bool begun = false;
    std::unique_ptr<spdlog::logger> logger = nullptr;
    bool failed = false;

    void write(spdlog::level::level_enum level, const std::string& text) {
        if (failed) return;
        waiting.push_back({spdlog::log_clock::now(), level, discreet(text, left_out)});
        std::error_code none;
        if (begun || fs::exists(fs::symlink_status(path(), none))) flush();
    }

    void flush() {
        if (failed) return;
        try {
            if (!logger) open();
            for (const Line& line : waiting)
                if (!failed) logger->log(line.when, {}, line.level, line.text);
        } catch (const std::exception& problem) {
            giveUp(problem.what());
        }
        waiting.clear();
        if (failed) logger.reset();
    }

    std::string path() const { return store::behindLink(database) + store::kLogFiles.front(); }

    void open() {
        logger = openLogger(store::behindLink(database));
        logger->set_error_handler([this](const std::string& problem) { giveUp(problem); });
    }

    void giveUp(const std::string& problem) {
        if (!std::exchange(failed, true) && warn) warn("no log is kept beside the database: " + problem);
    }
};

StudyLog::StudyLog(std::string database, const std::string& program, Warn warn)
    : file_(std::make_unique<File>(File{.database = std::move(database), .warn = std::move(warn)})) {
    tell(startText(program));
}

StudyLog::~StudyLog() = default;

void StudyLog::begin() {
    file_->begun = true;
    file_->flush();
}

void StudyLog::leaveOut(const std::string& who) { file_->left_out.push_back(who); }

void StudyLog::tell(const std::string& what) { file_->write(spdlog::level::info, what); }

void StudyLog::warn(const std::string& what) { file_->write(spdlog::level::warn, what); }

void StudyLog::fail(const std::string& what, const Errors& errors) {
    for (Error error : errors) {
        error.value.clear();
        file_->write(spdlog::level::err, what + ": " + toString(error));
    }
}

std::string logText(const std::string& database) {
    std::string text;
    for (auto name = store::kLogFiles.rbegin(); name != store::kLogFiles.rend(); ++name) {
        const std::string path = store::behindLink(database) + *name;
        if (!isPlain(path)) continue;
        std::ifstream file(path, std::ios::binary);
        text.append(std::istreambuf_iterator<char>(file), {});
    }
    return text;
}

std::vector<std::string> loggedDatabases() {
    const std::string ending = std::string(".db") + store::kLogFiles.front();
    std::vector<std::string> databases;
    for (const fs::path& folder : {fs::path("."), dataFolder() / "studies", dataFolder() / "tryouts"}) {
        std::error_code none;
        for (const auto& entry : fs::directory_iterator(folder, none)) {
            const std::string path = entry.path().lexically_normal().string();
            if (path.ends_with(ending) && isPlain(path))
                databases.push_back(path.substr(0, path.size() - std::string_view(store::kLogFiles.front()).size()));
        }
    }
    std::sort(databases.begin(), databases.end());
    return databases;
}

}  // namespace passung::run
