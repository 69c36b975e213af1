#include "core/base/result.h"

#include "core/base/printable.h"

namespace passung {

std::string toString(const Error& error) {
    std::string text;
    if (!error.file.empty()) {
        text += printable(error.file) + ":";
        if (error.line > 0) text += std::to_string(error.line) + ":" + std::to_string(error.column) + ":";
        text += " ";
    }
    text += "error: ";
    if (!error.key.empty()) text += printable(error.key) + ": ";
    if (!error.value.empty()) text += printable(error.value) + ": ";
    return text + printableLines(error.message);
}

}  // namespace passung
