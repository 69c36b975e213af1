#pragma once

#include "study/protocol/document.h"

namespace passung::protocol {

/// Adds an error for every name, version or label of a study's or questionnaire's file that columns, lines and names of
/// files cannot be made of: longer than kMostLetters, or a version of several lines. Nothing else depends on it, so
/// that a study that began before there was a limit goes on.
void checkNames(const Node& document, Errors& errors);
inline constexpr std::size_t kMostLetters = 100;  // code points

}  // namespace passung::protocol
