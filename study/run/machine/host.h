#pragma once

#include <string>

namespace passung::run {

/// System of this machine, without the machine's name: "Linux 6.1.0 x86_64".
std::string hostText();

/// The same with the number of its processors.
std::string machineText();

}  // namespace passung::run
