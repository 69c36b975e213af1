#include "core/base/result.h"

namespace passung {

std::string toString(const Error& error) {
    std::string text;
    if (!error.file.empty()) {
        text += error.file + ":";
        if (error.line > 0) text += std::to_string(error.line) + ":" + std::to_string(error.column) + ":";
        text += " ";
    }
    text += "error: ";
    if (!error.key.empty()) text += error.key + ": ";
    if (!error.value.empty()) text += error.value + ": ";
    return text + error.message;
}

}  // namespace passung
