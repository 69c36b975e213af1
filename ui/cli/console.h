#pragma once

#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "study/run/files/builds.h"
#include "study/store/rows/rows.h"

namespace passung::cli {

/// Prints every error on a line of its own on standard error; returns exit code 1.
int fail(const Errors& errors);

/// Prints every warning about `file` on a line of its own on standard error.
void warn(const std::string& file, const std::vector<std::string>& warnings);

/// Prints what is damaged in a database, a line each on standard error, and what became of it; true if anything is.
bool tellDamages(const std::string& database, const std::vector<store::DamageRow>& damages, const char* consequence);

/// Refuses an output that is one of the input files, which would be lost, or no regular file.
Result<Done> refuseOverwriting(const std::string& out, const std::vector<std::string>& inputs);

/// A file that appears complete or not at all: written beside its place, renamed by commit(). Of a symbolic link the
/// file that it leads to; a database, and what exists and is no regular file, is refused by commit() and left as it is.
class OutputFile {
public:
    explicit OutputFile(std::string path);
    ~OutputFile();  // without commit() nothing remains
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    void write(std::string_view text);
    Result<Done> commit();

private:
    std::string path_, target_, temporary_;
    const char* refused_ = nullptr;  // why nothing is written
    std::FILE* file_ = nullptr;
    int error_ = 0;  // errno of the first failure
};

/// "####......  42 %  what"; nothing for nothing.
std::string progressBar(const std::string& what, double share);

/// A line on standard error that replaces itself on a terminal and is left out elsewhere.
class ProgressLine {
public:
    ProgressLine();
    ~ProgressLine();  // leaves an empty line
    void show(const std::string& text);
    /// What `read` returns; until then the line says which file is read, of large meshes for some seconds.
    template <class Read>
    auto whileReading(const std::string& file, const Read& read) {
        show("reading " + file);
        auto found = read();
        show("");
        return found;
    }

private:
    bool terminal_;
    std::size_t shown_ = 0;
};

/// "building plate: distance field, level 2".
std::string buildWords(const scene::BuildStep& step);

/// Shows that on the line, which outlives it.
run::BuildWatch showBuilds(ProgressLine& line);

/// Is the program's first word one of its commands? If not, says which may be meant and which there are.
bool isCommand(const std::string& word, const std::vector<std::string>& commands);

}  // namespace passung::cli
