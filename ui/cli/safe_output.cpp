#include "ui/cli/safe_output.h"

#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <string>

#include "core/base/printable.h"

namespace passung::cli {

namespace {

/// One of the two outputs, and the beginning of a character that has not been printed whole.
struct Output {
    int descriptor;
    bool returns;  // the line of progress goes back to its beginning
    std::string begun = {};
};

bool writeAll(int descriptor, const std::string& text) {
    for (std::size_t done = 0; done < text.size();) {
        const ssize_t written = ::write(descriptor, text.data() + done, text.size() - done);
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return false;
        done += static_cast<std::size_t>(written);
    }
    return true;
}

ssize_t print(void* cookie, const char* bytes, size_t size) {
    auto& output = *static_cast<Output*>(cookie);
    std::string text = std::move(output.begun);
    text.append(bytes, size);
    const std::size_t cut = cutOff(text);
    output.begun = text.substr(text.size() - cut);
    text.resize(text.size() - cut);
    return writeAll(output.descriptor, printableLines(text, output.returns)) ? static_cast<ssize_t>(size) : 0;
}

int end(void* cookie) {
    const auto* output = static_cast<const Output*>(cookie);
    return writeAll(output->descriptor, printableLines(output->begun)) ? 0 : EOF;
}

/// A stream through which everything passes to `output`, which outlives it; nullptr if there is none to be had.
std::FILE* safeStream(Output& output, int buffering) {
    std::FILE* stream = fopencookie(&output, "w", {.read = nullptr, .write = print, .seek = nullptr, .close = end});
    if (stream != nullptr) std::setvbuf(stream, nullptr, buffering, BUFSIZ);
    return stream;
}

}  // namespace

void makeOutputSafe() {
    // The C library flushes after everything static is gone: these two are never destroyed.
    static Output* const out = new Output{STDOUT_FILENO, false};
    static Output* const error = new Output{STDERR_FILENO, isatty(STDERR_FILENO) != 0};
    if (std::FILE* safe = safeStream(*out, isatty(STDOUT_FILENO) != 0 ? _IOLBF : _IOFBF)) stdout = safe;
    if (std::FILE* safe = safeStream(*error, _IONBF)) stderr = safe;
}

}  // namespace passung::cli
