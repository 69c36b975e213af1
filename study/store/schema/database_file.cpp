#include "study/store/schema/database_file.h"

#include <array>
#include <fstream>
#include <string_view>

#include "core/base/regular_file.h"

namespace passung::store {

bool beginsAsDatabase(const std::string& path) {
    if (whyNoRegularFile(path)) return false;
    constexpr std::string_view kMagic("SQLite format 3\0", 16);
    std::array<char, kMagic.size()> head{};
    std::ifstream(path, std::ios::binary).read(head.data(), head.size());
    int same = 0;
    for (std::size_t i = 0; i < kMagic.size(); ++i) same += head[i] == kMagic[i] ? 1 : 0;
    return 2 * same >= static_cast<int>(kMagic.size());
}

}  // namespace passung::store
