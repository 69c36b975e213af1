#include "study/plan/participant.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace passung::plan {

const char* participantKindName(ParticipantKind kind) {
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

std::optional<ParticipantKind> participantKindNamed(std::string_view name) {
    for (const auto kind : {ParticipantKind::Real, ParticipantKind::Pilot, ParticipantKind::Simulated})
        if (name == participantKindName(kind)) return kind;
    return std::nullopt;
}

const std::vector<std::string>& participantKindNames() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> all;
        for (const auto kind : {ParticipantKind::Real, ParticipantKind::Pilot, ParticipantKind::Simulated})
            all.emplace_back(participantKindName(kind));
        return all;
    }();
    return names;
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

std::optional<ParticipantKind> kindOfCode(std::string_view code) {
    for (const auto kind : {ParticipantKind::Real, ParticipantKind::Pilot, ParticipantKind::Simulated})
        if (code.starts_with(codeLetter(kind))) return kind;
    return std::nullopt;
}

std::string participantCode(ParticipantKind kind, std::int64_t number) {
    return fmt::format("{}{:03}", codeLetter(kind), number);
}

std::string rehearsedCode(std::string_view code) {
    std::string rehearsed(code);
    if (kindOfCode(code)) rehearsed.front() = codeLetter(ParticipantKind::Real);
    return rehearsed;
}

std::int64_t participantNumber(std::string_view code) {
    const std::size_t digits = code.find_last_not_of("0123456789") + 1;
    std::int64_t number = 0;
    std::from_chars(code.data() + digits, code.data() + code.size(), number);
    return number;
}

bool isParticipantCode(std::string_view code) {
    const auto isCapital = [](char c) { return c >= 'A' && c <= 'Z'; };
    const auto isDigit = [](char c) { return c >= '0' && c <= '9'; };
    return code.size() >= 2 && code.size() <= 32 && isCapital(code.front()) && isDigit(code.back()) &&
           std::all_of(code.begin(), code.end(),
                       [&](char c) { return isCapital(c) || isDigit(c) || c == '_' || c == '-'; });
}

}  // namespace passung::plan
