#pragma once

#include <grp.h>
#include <pwd.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/support/temp_folder.h"

namespace passung::fake {

/// A PostgreSQL server of its own: in a temporary folder, reached by a socket in it, gone with the object. A server
/// refuses to run as root, so root starts it as the user postgres.
class Postgres {
public:
    /// Is there one to start?
    static bool installed() { return !programs().empty() && (geteuid() != 0 || getpwnam("postgres") != nullptr); }

    Postgres() {
        if (geteuid() == 0) {
            const passwd* user = getpwnam("postgres");
            if (chown(folder_.path().c_str(), user->pw_uid, user->pw_gid) != 0) throw std::runtime_error("chown");
        }
        run({"initdb", "-D", data(), "-A", "trust", "-U", "passung", "-E", "UTF8", "--no-locale", "--no-sync"});
        run({"pg_ctl", "-D", data(), "-w", "-t", "120", "-l", folder_ / "log", "-o",
             "-F -k " + folder_.path().string() + " -c listen_addresses=''", "start"});
    }
    ~Postgres() {
        try {
            run({"pg_ctl", "-D", data(), "-m", "immediate", "-w", "stop"});
        } catch (const std::exception&) {
        }
    }
    Postgres(const Postgres&) = delete;
    Postgres& operator=(const Postgres&) = delete;

    std::string uri() const { return "postgresql:///postgres?host=" + folder_.path().string() + "&user=passung"; }

private:
    /// Folder of the newest server's programs; empty if there is none.
    static std::string programs() {
        std::string newest;
        std::error_code none;
        for (const auto& version : std::filesystem::directory_iterator("/usr/lib/postgresql", none))
            if (std::filesystem::exists(version.path() / "bin/initdb"))
                newest = std::max(newest, (version.path() / "bin").string());
        return newest;
    }

    std::string data() const { return folder_ / "data"; }

    void run(std::vector<std::string> arguments) const {
        const std::string name = arguments[0];
        arguments[0] = programs() + "/" + name;
        const pid_t child = fork();
        if (child == 0) become(arguments);
        int status = 0;
        waitpid(child, &status, 0);
        if (status != 0) throw std::runtime_error(name + " failed: see " + folder_.path().string());
    }

    [[noreturn]] void become(const std::vector<std::string>& arguments) const {
        if (geteuid() == 0) {
            const passwd* user = getpwnam("postgres");
            if (initgroups("postgres", user->pw_gid) != 0 || setgid(user->pw_gid) != 0 || setuid(user->pw_uid) != 0)
                _exit(125);
        }
        if (chdir(folder_.path().c_str()) != 0 || freopen("/dev/null", "w", stdout) == nullptr) _exit(126);
        std::vector<char*> argv;
        for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
        argv.push_back(nullptr);
        execv(argv[0], argv.data());
        _exit(127);
    }

    test::TempFolder folder_;
};

}  // namespace passung::fake
