#include <csignal>
#include <cstdio>
#include <exception>

#include "ui/cli/command_line.h"
#include "ui/cli/commands.h"
#include "ui/cli/safe_output.h"

int main(int argc, char** argv) {
    std::signal(SIGXFSZ, SIG_IGN);  // a write beyond the user's limit of a file's size is an error like any other
    passung::cli::makeOutputSafe();
    try {
        if (argc == 1) passung::cli::openWindows();
        return passung::cli::runCommandLine(argc, argv);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "error: %s\n", error.what());
        return 1;
    }
}
