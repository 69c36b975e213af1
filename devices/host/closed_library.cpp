#include "devices/host/closed_library.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <cstdlib>

namespace passung::host {
namespace {

/// Whose file is named; empty: nobody has named one.
std::string namedFile(const std::string& file, const char* variable) {
    if (!file.empty()) return file;
    const char* named = std::getenv(variable);
    return named == nullptr ? std::string() : named;
}

}  // namespace

std::string ClosedLibrary::adviceOf(const LibraryWords& words) {
    return fmt::format("{} as `address` into the station file, or into {}", words.remedy, words.variable);
}

Result<std::unique_ptr<ClosedLibrary>> ClosedLibrary::load(const std::string& file, const LibraryWords& words) {
    std::unique_ptr<ClosedLibrary> loaded(new ClosedLibrary(words));
    loaded->path_ = namedFile(file, words.variable);
    if (!loaded->path_.empty()) {
        loaded->library_ = dlopen(loaded->path_.c_str(), RTLD_NOW | RTLD_LOCAL);
        if (loaded->library_ != nullptr) return loaded;
        const char* reason = dlerror();
        return Error{.message = fmt::format("{} does not load from {}: {}; {}", words.name, loaded->path_,
                                            reason == nullptr ? "no reason" : reason, loaded->advice())};
    }
    for (const char* usual : words.usual) {
        loaded->library_ = dlopen(usual, RTLD_NOW | RTLD_LOCAL);
        loaded->path_ = usual;
        if (loaded->library_ != nullptr) return loaded;
    }
    return Error{.message = fmt::format("{} is not found: looked for {} where the system's loader looks "
                                        "(LD_LIBRARY_PATH, /etc/ld.so.conf, /usr/lib); {}",
                                        words.name, fmt::join(words.usual, ", "), loaded->advice())};
}

ClosedLibrary::~ClosedLibrary() {
    if (library_ != nullptr) dlclose(library_);
}

Result<Done> ClosedLibrary::complete() const {
    if (missing_.empty()) return Done{};
    return Error{.message = fmt::format("{} {} has no function {}: it is older than {}, or another library; {}",
                                        words_.name, path_, missing_, words_.since, advice())};
}

void* ClosedLibrary::found(const char* name) const { return dlsym(library_, name); }

}  // namespace passung::host
