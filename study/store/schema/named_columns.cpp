#include "study/store/schema/named_columns.h"

namespace passung::store {

std::string insertText(const char* verb, const char* table, std::initializer_list<const char*> columns) {
    std::string names, places;
    for (const char* column : columns) {
        names += (names.empty() ? "" : ", ") + std::string(column);
        places += places.empty() ? "?" : ", ?";
    }
    return std::string(verb) + " INTO " + table + "(" + names + ") VALUES(" + places + ")";
}

}  // namespace passung::store
