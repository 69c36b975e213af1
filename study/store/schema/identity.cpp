#include "study/store/schema/identity.h"

#include "core/base/hex_text.h"
#include "core/base/random.h"

namespace passung::store {

std::string sessionId(std::string_view study, std::string_view participant, int ordinal, std::uint64_t seed) {
    std::string key(study);
    key += '|';
    key += participant;
    key += '|' + std::to_string(ordinal);
    std::uint64_t state = fnv1a64(key) ^ seed;
    return hexText(splitmix64(state));
}

}  // namespace passung::store
