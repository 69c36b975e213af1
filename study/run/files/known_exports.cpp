#include "study/run/files/known_exports.h"

#include <fcntl.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <set>

#include "study/run/files/data_folder.h"

namespace passung::run {

namespace {

namespace fs = std::filesystem;

constexpr const char* kFile = "exports";
constexpr char kEnd = '\0';  // of a path; two paths are an entry

std::string properName(const std::string& path) {
    std::error_code error;
    const auto proper = fs::weakly_canonical(path, error);
    return error ? path : proper.string();
}

}  // namespace

bool rememberExport(const std::string& database, const std::string& folder) {
    const fs::path data = dataFolder();
    std::error_code error;
    if (data.empty() || (fs::create_directories(data, error), error)) return false;
    const std::string entry = properName(database) + kEnd + properName(folder) + kEnd;
    const int file = open((data / kFile).c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0600);
    if (file < 0) return false;
    const bool whole = write(file, entry.data(), entry.size()) == static_cast<ssize_t>(entry.size());
    return close(file) == 0 && whole;
}

std::vector<std::string> knownExports(const std::string& database) {
    std::set<std::string> folders;
    std::error_code none;
    const std::string proper = properName(database);
    std::ifstream file(dataFolder() / kFile, std::ios::binary);
    for (std::string of, folder; std::getline(file, of, kEnd) && std::getline(file, folder, kEnd);)
        if ((of == proper || !fs::exists(of, none)) && fs::is_directory(folder, none)) folders.insert(folder);
    return {folders.begin(), folders.end()};
}

}  // namespace passung::run
