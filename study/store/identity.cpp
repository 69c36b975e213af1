#include "study/store/identity.h"

#include <algorithm>

#include "core/base/random.h"

namespace passung::store {

const char* kindName(ParticipantKind kind) {
    switch (kind) {
        case ParticipantKind::Real:
            return "real";
        case ParticipantKind::Pilot:
            return "pilot";
        case ParticipantKind::Simulated:
            break;
    }
    return "simulated";
}

char codeLetter(ParticipantKind kind) {
    switch (kind) {
        case ParticipantKind::Real:
            return 'P';
        case ParticipantKind::Pilot:
            return 'T';
        case ParticipantKind::Simulated:
            break;
    }
    return 'S';
}

std::string participantCode(ParticipantKind kind, std::int64_t number) {
    std::string digits = std::to_string(number);
    if (digits.size() < 3) digits.insert(0, 3 - digits.size(), '0');
    return codeLetter(kind) + digits;
}

bool isParticipantCode(std::string_view code) {
    const auto isCapital = [](char c) { return c >= 'A' && c <= 'Z'; };
    const auto isDigit = [](char c) { return c >= '0' && c <= '9'; };
    return code.size() >= 2 && code.size() <= 32 && isCapital(code.front()) && isDigit(code.back()) &&
           std::all_of(code.begin(), code.end(),
                       [&](char c) { return isCapital(c) || isDigit(c) || c == '_' || c == '-'; });
}

std::string sessionId(std::string_view study, std::string_view participant, int ordinal, std::uint64_t seed) {
    std::string key(study);
    key += '|';
    key += participant;
    key += '|' + std::to_string(ordinal);
    std::uint64_t state = fnv1a64(key) ^ seed;
    return hexText(splitmix64(state));
}

std::string hexText(std::uint64_t value) {
    constexpr std::string_view kDigits = "0123456789abcdef";
    std::string text(16, '0');
    for (std::size_t i = 16; i-- > 0; value >>= 4) text[i] = kDigits[value & 15];
    return text;
}

}  // namespace passung::store
