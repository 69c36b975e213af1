#pragma once

#include <string>
#include <vector>

namespace passung::cli {

/// A program of ours that only some commands need: what it links is loaded by no other command.
struct OtherProgram {
    const char* name;
    const char* made_by;  // how somebody gets it who has it not
};

/// This process becomes the program with these words: its exit code is ours. It lies beside this one or where ./dev
/// build puts both. Returns an exit code only where it cannot be started, with the reason on standard error.
int becomeProgram(const OtherProgram& program, const std::vector<std::string>& words);

/// The same with passung-postgres, which speaks to the server for the command, `push` or `restore`.
int becomePostgres(const char* command, const std::string& database, const std::string& server);

}  // namespace passung::cli
