#pragma once

#include <signal.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace passung::test {

/// What the system says of a process: its name, state and parent.
struct ListedProcess {
    std::string name;
    char state = ' ';
    pid_t parent = 0;

    /// False: it has gone.
    bool read(pid_t process) {
        std::ifstream file("/proc/" + std::to_string(process) + "/stat");
        std::string line;
        std::getline(file, line);
        const auto begin = line.find('('), end = line.rfind(')');
        if (begin == std::string::npos || end == std::string::npos) return false;
        name = line.substr(begin + 1, end - begin - 1);
        std::istringstream(line.substr(end + 1)) >> state >> parent;
        return state != 'Z';
    }
};

inline bool runs(pid_t process) { return ListedProcess().read(process); }

/// The device hosts that a process has started and that run.
inline std::vector<pid_t> hostsOf(pid_t parent) {
    std::vector<pid_t> hosts;
    std::error_code none;
    for (const auto& entry : std::filesystem::directory_iterator("/proc", none)) {
        const std::string name = entry.path().filename();
        if (name.find_first_not_of("0123456789") != std::string::npos) continue;
        const auto process = static_cast<pid_t>(std::stol(name));
        ListedProcess listed;
        // The system keeps the first 15 letters of a name.
        if (listed.read(process) && listed.parent == parent && listed.name == "passung-device-")
            hosts.push_back(process);
    }
    return hosts;
}

}  // namespace passung::test
