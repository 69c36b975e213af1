#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include "ui/cli/commands.h"

namespace passung::cli {

void openWindows() {
    const auto isSet = [](const char* name) {
        const char* value = std::getenv(name);
        return value != nullptr && *value != '\0';
    };
    if (!isSet("DISPLAY") && !isSet("WAYLAND_DISPLAY")) return;
    std::error_code unknown;
    const auto program = std::filesystem::read_symlink("/proc/self/exe", unknown).parent_path() / "passung-window";
    execl(program.c_str(), program.c_str(), static_cast<char*>(nullptr));
}

}  // namespace passung::cli
