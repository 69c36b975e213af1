#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <stdexcept>
#include <string>

#include "core/base/sanitizer.h"
#include "core/import/mesh_bytes.h"
#include "core/import/mesh_import.h"
#include "study/run/import_exit.h"

// The program passung-import: reads one mesh file for passung, so that no file can do to passung what it may do to its
// reader. Words: FILE METRES_PER_UNIT SECONDS BYTES. The answer, a mesh with its report or errors, goes to the standard
// output as bytes (core/import/mesh_bytes.h).

namespace {

using namespace passung;

/// Lowers a limit of this process; what it had already and was lower stays.
void lower(int resource, rlim_t to) {
    rlimit limit{};
    if (getrlimit(resource, &limit) != 0) return;
    limit.rlim_cur = limit.rlim_cur == RLIM_INFINITY ? to : std::min(limit.rlim_cur, to);
    setrlimit(resource, &limit);
}

void limitOneself(rlim_t seconds, rlim_t bytes) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);  // nobody waits for the answer any more
    lower(RLIMIT_CORE, 0);
    lower(RLIMIT_CPU, seconds);
    if (!kSanitized) lower(RLIMIT_AS, bytes);
}

bool writeAll(int to, const std::string& bytes) {
    for (std::size_t done = 0; done < bytes.size();) {
        const ssize_t written = write(to, bytes.data() + done, bytes.size() - done);
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return false;
        done += static_cast<std::size_t>(written);
    }
    return true;
}

}  // namespace

int main(int argc, char** argv) {
    constexpr int kWords = 5;
    if (argc != kWords) {
        std::fprintf(stderr, "passung-import reads meshes for passung: passung mesh FILE\n");
        return run::kWrongWords;
    }
    limitOneself(std::strtoull(argv[3], nullptr, 10), std::strtoull(argv[4], nullptr, 10));
    try {
        const auto imported = importer::importMesh(argv[1], std::strtod(argv[2], nullptr));
        return writeAll(STDOUT_FILENO, importer::toBytes(imported)) ? 0 : run::kNotWritten;
    } catch (const std::bad_alloc&) {
        return run::kOutOfMemory;
    } catch (const std::length_error&) {
        return run::kOutOfMemory;
    } catch (const std::exception& problem) {
        const Result<importer::ImportedMesh> refused(
            Error{.message = std::string("cannot be read: ") + problem.what(), .file = argv[1]});
        return writeAll(STDOUT_FILENO, importer::toBytes(refused)) ? 0 : run::kNotWritten;
    }
}
