#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/shell/point_shell.h"

namespace passung::shell {

/// A point shell as bytes and back, the same bits; nothing if the bytes hold no shell.
std::string toBytes(const PointShell& shell);
std::optional<PointShell> shellFrom(std::string_view bytes);

}  // namespace passung::shell
