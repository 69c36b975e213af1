#pragma once

#include <exception>
#include <string>

namespace passung::store {

/// What went wrong in PostgreSQL: of its message, which has several lines, the first.
inline std::string postgresMessage(const std::exception& error) {
    const std::string text = error.what();
    return "PostgreSQL: " + text.substr(0, text.find('\n'));
}

}  // namespace passung::store
