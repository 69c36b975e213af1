#pragma once

#include <dlfcn.h>

#include <stdexcept>
#include <string>

namespace passung::fake {

/// A shim that is loaded as a backend loads a vendor's library, with its functions by name.
class ShimLibrary {
public:
    explicit ShimLibrary(const char* path) : library_(dlopen(path, RTLD_NOW | RTLD_LOCAL)) {
        if (library_ == nullptr) throw std::runtime_error(dlerror());
    }
    ~ShimLibrary() { dlclose(library_); }
    ShimLibrary(const ShimLibrary&) = delete;
    ShimLibrary& operator=(const ShimLibrary&) = delete;

    bool has(const char* name) const { return dlsym(library_, name) != nullptr; }

    /// get<int(char)>("dhdClose")
    template <typename Function>
    Function* get(const char* name) const {
        void* symbol = dlsym(library_, name);
        if (symbol == nullptr) throw std::runtime_error(std::string("no symbol ") + name);
        return reinterpret_cast<Function*>(symbol);
    }

private:
    void* library_;
};

}  // namespace passung::fake
