#include "study/run/machine/host.h"

#include <sys/utsname.h>

#include <thread>

namespace passung::run {

std::string hostText() {
    utsname name{};
    uname(&name);
    return std::string(name.sysname) + " " + name.release + " " + name.machine;
}

std::string machineText() {
    return hostText() + ", " + std::to_string(std::thread::hardware_concurrency()) + " processors";
}

}  // namespace passung::run
