#pragma once

#include <string>

namespace passung::store {

/// Person who does something, and the time.
struct Actor {
    std::string name;
    std::string now_utc;
};

}  // namespace passung::store
