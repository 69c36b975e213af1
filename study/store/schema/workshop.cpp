#include "study/store/schema/workshop.h"

#include <filesystem>

namespace passung::store {

void removeDatabase(const std::string& path) {
    std::error_code ignored;
    for (const char* suffix : {"", "-wal", "-shm", "-journal"}) std::filesystem::remove(path + suffix, ignored);
}

Workshop::Workshop(const std::string& path)
    : part(path + ".part"), source(path + ".source.part"), damaged(path + ".damaged.part") {
    clear();
}

void Workshop::clear() const {
    for (const std::string& file : {part, source, damaged}) removeDatabase(file);
}

}  // namespace passung::store
