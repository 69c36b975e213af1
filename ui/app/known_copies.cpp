#include "ui/app/known_copies.h"

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace passung::app {

namespace {

namespace fs = std::filesystem;

bool exportNames(const fs::path& folder, const std::string& participant) {
    std::ifstream table(folder / "participants.csv");
    for (std::string line; std::getline(table, line);)
        if (line.starts_with(participant + ",")) return true;
    return false;
}

}  // namespace

std::vector<std::string> knownCopies(const std::string& database, const std::string& participant) {
    std::vector<std::string> copies;
    std::error_code none;
    for (const char* suffix : {".backup", ".backup.sha256"})
        if (fs::exists(database + suffix, none)) copies.push_back(database + suffix);
    const fs::path parent = fs::path(database).parent_path();
    for (const auto& entry : fs::directory_iterator(parent.empty() ? fs::path(".") : parent, none))
        if (entry.is_directory(none) && exportNames(entry.path(), participant))
            copies.push_back((parent / entry.path().filename()).string());
    std::sort(copies.begin(), copies.end());
    return copies;
}

}  // namespace passung::app
