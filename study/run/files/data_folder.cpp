#include "study/run/files/data_folder.h"

#include <cstdlib>

namespace passung::run {

std::filesystem::path dataFolder() {
    const auto variable = [](const char* name) {
        const char* value = std::getenv(name);
        return std::filesystem::path(value == nullptr ? "" : value);
    };
    if (const auto data = variable("XDG_DATA_HOME"); data.is_absolute()) return data / "passung";
    if (const auto home = variable("HOME"); home.is_absolute()) return home / ".local" / "share" / "passung";
    return {};
}

}  // namespace passung::run
