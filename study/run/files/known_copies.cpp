#include "study/run/files/known_copies.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <sstream>

#include "core/base/regular_file.h"
#include "study/run/files/known_exports.h"
#include "study/store/read/store_reader.h"
#include "study/store/schema/backup.h"
#include "study/store/schema/database_file.h"

namespace passung::run {

namespace {

namespace fs = std::filesystem;

bool exportNames(const fs::path& folder, const std::string& participant) {
    const auto text = readFile(folder / "participants.csv");
    if (!text) return false;
    std::istringstream table(*text);
    for (std::string line; std::getline(table, line);)
        if (line.starts_with(participant + ",")) return true;
    return false;
}

/// A backup that nobody can read may hold anybody.
bool backupNames(const std::string& backup, const std::string& participant) {
    std::error_code none;
    if (!fs::exists(backup, none)) return false;
    const auto reader = store::StoreReader::open(backup);
    if (!reader) return true;
    const auto people = reader->participants();
    return !people || std::any_of(people->begin(), people->end(),
                                  [&](const auto& person) { return person.participant_id == participant; });
}

}  // namespace

std::vector<std::string> knownCopies(const std::string& database, const std::string& participant) {
    std::set<std::string> copies;
    std::error_code none;
    if (const std::string backup = store::backupPath(database); backupNames(backup, participant)) copies.insert(backup);
    const fs::path parent = fs::weakly_canonical(database, none).parent_path();
    // What restoring, a kill in its middle or an earlier backup left beside it.
    const std::string name = fs::weakly_canonical(database, none).filename().string() + ".";
    for (const auto& entry : fs::directory_iterator(parent, none))
        if (entry.is_regular_file(none) && entry.path().filename().string().starts_with(name) &&
            store::beginsAsDatabase(entry.path().string()) && backupNames(entry.path().string(), participant))
            copies.insert(entry.path().string());
    for (const auto& entry : fs::directory_iterator(parent, none))
        if (entry.is_directory(none) && exportNames(entry.path(), participant)) copies.insert(entry.path().string());
    for (const std::string& folder : knownExports(database))
        if (exportNames(folder, participant)) copies.insert(folder);
    return {copies.begin(), copies.end()};
}

}  // namespace passung::run
