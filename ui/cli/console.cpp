#include "ui/cli/console.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace passung::cli {

int fail(const Errors& errors) {
    for (const Error& error : errors) std::fprintf(stderr, "%s\n", toString(error).c_str());
    return 1;
}

OutputFile::OutputFile(std::string path) : path_(std::move(path)), temporary_(path_ + ".part") {
    file_ = std::fopen(temporary_.c_str(), "wb");
    failed_ = file_ == nullptr;
}

OutputFile::~OutputFile() {
    if (file_ == nullptr) return;
    std::fclose(file_);
    std::remove(temporary_.c_str());
}

void OutputFile::write(std::string_view text) {
    if (failed_) return;
    failed_ = std::fwrite(text.data(), 1, text.size(), file_) != text.size();
}

Result<Done> OutputFile::commit() {
    bool good = !failed_ && std::fflush(file_) == 0;
    if (file_ != nullptr) good = std::fclose(file_) == 0 && good;
    const bool opened = file_ != nullptr;
    file_ = nullptr;
    if (good && std::rename(temporary_.c_str(), path_.c_str()) == 0) return Done{};
    const std::string reason = std::strerror(errno);
    if (opened) std::remove(temporary_.c_str());
    return Error{.message = "cannot be written: " + reason, .file = path_};
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

}  // namespace passung::cli
