#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace passung::plan {

/// Kind of participant. Data of different kinds is never mixed.
enum class ParticipantKind { Real, Pilot, Simulated };
const char* participantKindName(ParticipantKind kind);  // "real", "pilot", "simulated": as stored

std::optional<ParticipantKind> participantKindNamed(std::string_view name);

/// The names of all kinds.
const std::vector<std::string>& participantKindNames();

/// Letter that begins the codes of a kind: P for real, T for pilot, S for simulated participants.
char codeLetter(ParticipantKind kind);

/// The kind whose codes begin as this one does.
std::optional<ParticipantKind> kindOfCode(std::string_view code);

/// "P001" for number 1; grows beyond three digits.
std::string participantCode(ParticipantKind kind, std::int64_t number);

/// The code whose random draws a participant shares: P001 for P001, T001 and S001. A rehearsal by pilots or simulated
/// participants thus shows what the people of these numbers will get.
std::string rehearsedCode(std::string_view code);

/// Stratum of design::Allocation for the places of every kind, for the same reason: each kind has places of its own, in
/// the order of the people's.
inline constexpr const char* kAllocationStratum = "real";

/// The number at the end of a code: 12 of P012.
std::int64_t participantNumber(std::string_view code);

/// A code names files: a capital letter first, a digit last, only capital letters, digits, '_' and '-' between, at most
/// 32 characters.
bool isParticipantCode(std::string_view code);

}  // namespace passung::plan
