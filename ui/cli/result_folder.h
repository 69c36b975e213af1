#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace passung::cli {

/// A folder for the results of `accuracy`; whatever of it was not there before and is still empty in the end is
/// removed.
class ResultFolder {
public:
    /// `files`: what results are, of which the first is a picture that tells whose they are.
    ResultFolder(const std::string& name, std::span<const char* const> files) : folder_(name), files_(files) {}
    ~ResultFolder();
    ResultFolder(const ResultFolder&) = delete;
    ResultFolder& operator=(const ResultFolder&) = delete;

    /// Only nothing, an empty folder, or earlier results of the same and nothing else may be replaced. `isOurs`: of the
    /// picture there; `whose`: "peg against plate".
    Result<Done> begin(const std::function<bool(const std::string&)>& isOurs, const std::string& whose);

    /// One of the files, in whole or not at all.
    Result<Done> write(const char* file, const std::string& text) const;

private:
    Error error(std::string message) const { return {.message = std::move(message), .file = folder_.string()}; }
    Result<Done> checkReplaceable(const std::function<bool(const std::string&)>& isOurs,
                                  const std::string& whose) const;

    std::filesystem::path folder_;
    std::span<const char* const> files_;
    std::vector<std::filesystem::path> made_;  // innermost first
};

}  // namespace passung::cli
