#include "ui/cli/console.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "study/protocol/key_table.h"
#include "study/store/schema/database_file.h"

namespace passung::cli {

namespace {

/// errno right after a call that failed; never 0.
int failure() { return errno != 0 ? errno : EIO; }

/// The file that `path` names, through symbolic links, whether it exists or not.
std::string followed(const std::string& path) {
    constexpr int kMostLinks = 40;  // as the kernel follows
    std::filesystem::path file(path);
    std::error_code none;
    for (int i = 0; i < kMostLinks && std::filesystem::is_symlink(file, none); ++i) {
        const auto to = std::filesystem::read_symlink(file, none);
        if (none) break;
        file = file.parent_path() / to;
    }
    return file.string();
}

constexpr const char* kNoPlainFile = "is no regular file (a folder, a pipe or a device): name a file";

/// True for a folder, pipe, device and the like, which a rename would replace instead of writing to it.
bool isNoPlainFile(const std::string& path) {
    std::error_code none;
    const auto status = std::filesystem::status(path, none);
    if (std::filesystem::exists(status)) return !std::filesystem::is_regular_file(status);
    return std::filesystem::is_symlink(followed(path), none);  // links in a circle
}

}  // namespace

int fail(const Errors& errors) {
    constexpr std::size_t kMostShown = 500;
    for (std::size_t i = 0; i < std::min(errors.size(), kMostShown); ++i)
        std::fprintf(stderr, "%s\n", toString(errors[i]).c_str());
    if (errors.size() > kMostShown) std::fprintf(stderr, "and %zu errors more\n", errors.size() - kMostShown);
    return 1;
}

bool tellDamages(const std::string& database, const std::vector<store::DamageRow>& damages, const char* consequence) {
    for (const store::DamageRow& damage : damages) {
        const std::string where = damage.session_ordinal ? fmt::format("{}, session {}, {}: ", damage.participant_id,
                                                                       *damage.session_ordinal, damage.part)
                                                         : std::string();
        fmt::print(stderr, "{}: error: {}{}: {}\n", database, where, damage.what, consequence);
    }
    return !damages.empty();
}

void warn(const std::string& file, const std::vector<std::string>& warnings) {
    for (const std::string& warning : warnings)
        std::fprintf(stderr, "%s: warning: %s\n", file.c_str(), warning.c_str());
}

Result<Done> refuseOverwriting(const std::string& out, const std::vector<std::string>& inputs) {
    if (isNoPlainFile(out)) return Error{.message = kNoPlainFile, .file = out};
    for (const std::string& input : inputs) {
        std::error_code none;  // a file that is not there is another one
        if (std::filesystem::equivalent(out, input, none) && !none)
            return Error{.message = "is an input of this command and would be lost: name another file for --out",
                         .file = out};
    }
    return Done{};
}

OutputFile::OutputFile(std::string path)
    : path_(std::move(path)), target_(followed(path_)), temporary_(target_ + ".part") {
    if (isNoPlainFile(target_) || isNoPlainFile(temporary_)) refused_ = kNoPlainFile;
    if (store::beginsAsDatabase(target_)) refused_ = "is a database and would be lost: name another file";
    if (refused_ != nullptr) return;
    file_ = std::fopen(temporary_.c_str(), "wb");
    if (file_ == nullptr) error_ = failure();
}

OutputFile::~OutputFile() {
    if (file_ == nullptr) return;
    std::fclose(file_);
    std::remove(temporary_.c_str());
}

void OutputFile::write(std::string_view text) {
    if (refused_ != nullptr) return;
    if (error_ == 0 && std::fwrite(text.data(), 1, text.size(), file_) != text.size()) error_ = failure();
}

Result<Done> OutputFile::commit() {
    if (refused_ != nullptr) return Error{.message = refused_, .file = path_};
    const bool opened = file_ != nullptr;
    // The number of the first failure: every later call may change it.
    const auto note = [this](bool good) {
        if (!good && error_ == 0) error_ = failure();
    };
    if (opened) {
        note(std::fflush(file_) == 0);
        note(std::fclose(file_) == 0);
        file_ = nullptr;
        if (error_ == 0) note(std::rename(temporary_.c_str(), target_.c_str()) == 0);
    }
    if (error_ == 0) return Done{};
    const std::string reason = std::strerror(error_);
    if (opened) std::remove(temporary_.c_str());
    return Error{.message = "cannot be written: " + reason, .file = path_};
}

std::string progressBar(const std::string& what, double share) {
    if (what.empty()) return "";
    constexpr int kWidth = 30;
    const int done = std::clamp(static_cast<int>(share * kWidth), 0, kWidth);
    return fmt::format("{}{} {:3.0f} %  {}", std::string(static_cast<std::size_t>(done), '#'),
                       std::string(static_cast<std::size_t>(kWidth - done), '.'), 100.0 * share, what);
}

ProgressLine::ProgressLine() : terminal_(isatty(STDERR_FILENO) != 0) {}

ProgressLine::~ProgressLine() { show(""); }

void ProgressLine::show(const std::string& text) {
    if (!terminal_) return;
    const std::size_t blank = shown_ > text.size() ? shown_ - text.size() : 0;
    std::fprintf(stderr, "\r%s%s\r", text.c_str(), std::string(blank, ' ').c_str());
    if (!text.empty()) std::fprintf(stderr, "%s", text.c_str());
    shown_ = text.size();
}

std::string buildWords(const scene::BuildStep& step) {
    const std::string words = "building " + step.part + ": " + step.what;
    return step.share > 0.0 ? progressBar(words, step.share) : words;
}

run::BuildWatch showBuilds(ProgressLine& line) {
    return [&line](const scene::BuildStep& step) { line.show(buildWords(step)); };
}

bool isCommand(const std::string& word, const std::vector<std::string>& commands) {
    const std::vector<std::string_view> names(commands.begin(), commands.end());
    if (std::find(names.begin(), names.end(), word) != names.end()) return true;
    const auto close = protocol::closestWord(word, names);
    std::string list = "commands:";
    std::size_t begin = 0;  // of its last line
    for (const std::string_view name : names) {
        constexpr std::size_t kLongest = 100;
        if (list.size() - begin + name.size() > kLongest) {
            begin = list.size() + 1;
            list += "\n         ";
        }
        list.append(" ").append(name).append(name == names.back() ? "" : ",");
    }
    fmt::print(stderr, "error: unknown command \"{}\"{}\n{}\n", word,
               close ? fmt::format("; did you mean \"{}\"?", *close) : "", list);
    return false;
}

}  // namespace passung::cli
