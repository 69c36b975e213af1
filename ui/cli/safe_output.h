#pragma once

namespace passung::cli {

/// From here on everything that this program prints on standard output and standard error passes one place, where
/// control characters, of a file or a name, are written out (core/base/printable.h): a terminal obeys none of them.
/// Ends of lines and tabs stay, and what is no text is not printed by this program. To be called once, first of all.
void makeOutputSafe();

}  // namespace passung::cli
