#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace passung::store {

enum class ParticipantKind { Real, Pilot, Simulated };
const char* kindName(ParticipantKind kind);  // "real", "pilot", "simulated": as stored

/// Letter that begins the codes of a kind: P for real, T for pilot, S for simulated participants.
char codeLetter(ParticipantKind kind);

/// "P001" for number 1; grows beyond three digits.
std::string participantCode(ParticipantKind kind, std::int64_t number);

/// A code names files: a capital letter first, a digit last, only capital letters, digits, '_' and '-' between, at most
/// 32 characters.
bool isParticipantCode(std::string_view code);

/// 16 hexadecimal digits; the same study, participant, ordinal and seed give the same session.
std::string sessionId(std::string_view study, std::string_view participant, int ordinal, std::uint64_t seed);

/// 16 lower-case hexadecimal digits.
std::string hexText(std::uint64_t value);

}  // namespace passung::store
