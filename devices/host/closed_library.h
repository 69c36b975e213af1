#pragma once

#include <memory>
#include <span>
#include <string>

#include "core/base/result.h"

namespace passung::host {

/// How a vendor's library is looked for, and what is said where it is not there.
struct LibraryWords {
    const char* name;                    // for people: "Force Dimension's library"
    const char* variable;                // of the environment, that names its file
    std::span<const char* const> usual;  // names of its file
    const char* since;                   // version that has all functions
    const char* remedy;                  // what to install, and which file of it
};

/// A library that nobody links: loaded at run time, its functions taken by name.
class ClosedLibrary {
public:
    /// Loads `file`, else the one that the variable names, else one of the usual names. Errors: which file was looked
    /// for where.
    static Result<std::unique_ptr<ClosedLibrary>> load(const std::string& file, const LibraryWords& words);
    ~ClosedLibrary();
    ClosedLibrary(const ClosedLibrary&) = delete;
    ClosedLibrary& operator=(const ClosedLibrary&) = delete;

    /// Null where it has none of that name.
    template <class Function>
    void take(Function*& function, const char* name) {
        function = reinterpret_cast<Function*>(found(name));
    }
    /// The same, and complete() tells.
    template <class Function>
    void need(Function*& function, const char* name) {
        take(function, name);
        if (function == nullptr && missing_.empty()) missing_ = name;
    }
    /// Errors: the first name that was needed and is not there.
    Result<Done> complete() const;
    const std::string& path() const { return path_; }
    /// What to do where it is not the right one.
    std::string advice() const { return adviceOf(words_); }

private:
    explicit ClosedLibrary(const LibraryWords& words) : words_(words) {}
    static std::string adviceOf(const LibraryWords& words);
    void* found(const char* name) const;

    const LibraryWords& words_;
    void* library_ = nullptr;
    std::string path_, missing_;
};

}  // namespace passung::host
