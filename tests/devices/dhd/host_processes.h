#pragma once

#include <signal.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace passung::test {

/// The device hosts that a process has started and that run, as the system lists them.
inline std::vector<pid_t> hostsOf(pid_t parent) {
    std::vector<pid_t> hosts;
    std::error_code none;
    for (const auto& entry : std::filesystem::directory_iterator("/proc", none)) {
        const std::string name = entry.path().filename();
        if (name.find_first_not_of("0123456789") != std::string::npos) continue;
        std::ifstream file(entry.path() / "stat");
        std::string line;
        std::getline(file, line);
        const auto begin = line.find('('), end = line.rfind(')');
        if (begin == std::string::npos || end == std::string::npos) continue;
        std::istringstream rest(line.substr(end + 1));
        char state = ' ';
        pid_t of = 0;
        rest >> state >> of;
        // The system keeps the first 15 letters of a name.
        if (of == parent && state != 'Z' && line.substr(begin + 1, end - begin - 1) == "passung-device-")
            hosts.push_back(static_cast<pid_t>(std::stol(name)));
    }
    return hosts;
}

}  // namespace passung::test
