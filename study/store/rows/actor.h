#pragma once

#include <string>

namespace passung::store {

/// Who does something, and when.
struct Actor {
    std::string name;
    std::string now_utc;
};

}  // namespace passung::store
