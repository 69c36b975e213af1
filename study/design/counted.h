#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace passung::design {

/// "1 trial", "3 trials": for nouns whose plural takes an s.
inline std::string counted(std::size_t count, std::string_view noun) {
    return std::to_string(count) + ' ' + std::string(noun) + (count == 1 ? "" : "s");
}

}  // namespace passung::design
