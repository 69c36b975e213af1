#include "study/run/files/disk_store.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>

#include "study/run/files/synced_write.h"

namespace passung::run {

namespace {

constexpr std::uintmax_t kLargest = std::uintmax_t{4} << 30;  // [bytes]; what no field of ours reaches is not read

}  // namespace

std::optional<std::string> DiskStore::load(const std::string& name) {
    std::error_code failure;
    const std::filesystem::path path = folder_ / name;
    if (!std::filesystem::is_regular_file(path, failure) || failure) return std::nullopt;
    const std::uintmax_t size = std::filesystem::file_size(path, failure);
    if (failure || size > kLargest) return std::nullopt;
    std::ifstream file(path, std::ios::binary);
    std::string bytes(static_cast<std::size_t>(size), '\0');
    file.read(bytes.data(), static_cast<std::streamsize>(size));
    bytes.resize(static_cast<std::size_t>(std::max<std::streamsize>(file.gcount(), 0)));
    return bytes;
}

void DiskStore::keep(const std::string& name, std::string_view bytes) {
    std::error_code failure;
    std::filesystem::create_directories(folder_, failure);
    std::string temporary = (folder_ / (name + ".XXXXXX")).string();
    const int file = mkostemp(temporary.data(), O_CLOEXEC);
    if (file < 0) return;
    bool whole = writeSynced(file, bytes);
    whole = close(file) == 0 && whole;
    if (whole) std::filesystem::rename(temporary, folder_ / name, failure);
    if (!whole || failure) {
        std::filesystem::remove(temporary, failure);
        return;
    }
    syncFolder(folder_);
}

std::unique_ptr<DiskStore> openDiskStore() {
    const auto variable = [](const char* name) {
        const char* value = std::getenv(name);
        return std::filesystem::path(value == nullptr ? "" : value);
    };
    if (!variable("PASSUNG_NO_CACHE").empty()) return nullptr;
    // A relative path there is to be ignored (XDG Base Directory Specification).
    if (const auto caches = variable("XDG_CACHE_HOME"); caches.is_absolute())
        return std::make_unique<DiskStore>(caches / "passung");
    if (const auto home = variable("HOME"); home.is_absolute())
        return std::make_unique<DiskStore>(home / ".cache" / "passung");
    return nullptr;
}

}  // namespace passung::run
