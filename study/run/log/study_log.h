#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace passung::run {

/// The log beside a study's database, DB.log: what ran, on what, how well, and what failed, for a bug report. Never who
/// took part or what they did: every line passes discreet(). At most kLogBytes a file and store::kLogFiles of them; of
/// the database's mode and group. Lines wait for begin() where no log is yet: beside a file that is no study's none
/// appears.
///   Nothing depends on the log: the first line that cannot be written is told as one warning, and no other is tried.
/// Used by one thread, never the tick's.
class StudyLog {
public:
    using Warn = std::function<void(const std::string&)>;

    /// `program`: which one writes. `warn` may be empty.
    StudyLog(std::string database, const std::string& program, Warn warn);
    ~StudyLog();
    StudyLog(const StudyLog&) = delete;
    StudyLog& operator=(const StudyLog&) = delete;

    /// The database is a study's: what waits is written.
    void begin();
    /// A name or code that no line may hold.
    void leaveOut(const std::string& who);

    void tell(const std::string& what);
    void warn(const std::string& what);
    /// Each error with its place, without its value.
    void fail(const std::string& what, const Errors& errors);

private:
    struct File;
    std::unique_ptr<File> file_;
};

inline constexpr std::size_t kLogBytes = 1 << 20;

/// The log of a database as far as it is there, the oldest line first.
std::string logText(const std::string& database);

/// Those with a log in the working directory and where the windows keep theirs.
std::vector<std::string> loggedDatabases();

}  // namespace passung::run
