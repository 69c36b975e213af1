#pragma once

namespace passung::cli {

/// Does what the words say; the program's exit code: 2 for words that it does not know.
int runCommandLine(int argc, char** argv);

}  // namespace passung::cli
