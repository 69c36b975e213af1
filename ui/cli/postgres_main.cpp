#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <string>

#include "study/run/files/wall_clock.h"
#include "study/store/postgres/pull.h"
#include "study/store/postgres/push.h"
#include "study/store/transfer/restore.h"
#include "ui/cli/console.h"
#include "ui/cli/restore_report.h"
#include "ui/cli/safe_output.h"

// The program passung-postgres: `passung push`, and `passung restore` from a server, become it, so that nothing else
// loads libpqxx and what libpq brings. Words: push DATABASE SERVER, or restore DATABASE SERVER.

namespace {

using namespace passung;

constexpr int kWords = 4;

int push(const std::string& database, const std::string& to) {
    const auto report = store::pushDatabase(database, to);
    if (!report) return cli::fail(report.errors());
    for (const std::string& session : report->unfinished)
        fmt::print("{}: left out: it runs, or was killed and its database not opened since\n", session);
    for (const std::string& damage : report->damaged)
        fmt::print(stderr, "{}: error: {}: damaged here and not pushed; passung restore heals from a copy\n", database,
                   damage);
    for (const std::string& session : report->newer_there)
        fmt::print(stderr,
                   "{}: error: {}: not pushed: there are rows of it that this file lacks; push the newer "
                   "copy, or passung merge of both\n",
                   database, session);
    for (const std::string& code : report->erased_there)
        fmt::print(
            "{}: was erased here and is deleted there; VACUUM FULL takes the last bytes out of PostgreSQL's tables, "
            "not "
            "out of its backups and archived logs\n",
            code);
    for (const std::string& code : report->left_out)
        fmt::print("{}: left out: was erased there; passung participant withdraw --scope erase removes them here\n",
                   code);
    for (const std::string& people : report->shared_places)
        fmt::print("{}: have one slot; passung merge would part them\n", people);
    fmt::print("{}: {} sessions added, {} brought up to date, {} known{}\n", database, report->sessions,
               report->replaced, report->known,
               report->healed == 0 ? "" : fmt::format(", {} healed that were damaged there", report->healed));
    return report->newer_there.empty() && report->damaged.empty() ? 0 : 1;
}

int restore(const std::string& database, const std::string& from) {
    const auto report = store::restoreDatabase(database, from, run::openOptionsNow(), store::pullSessions);
    return report ? cli::tellRestore(database, from, *report) : cli::fail(report.errors());
}

}  // namespace

int main(int argc, char** argv) {
    const std::string command = argc == kWords ? argv[1] : "";
    if (command != "push" && command != "restore") {
        std::fprintf(stderr, "passung-postgres speaks to PostgreSQL for passung: passung push DB --to URI\n");
        return 2;
    }
    cli::makeOutputSafe();
    try {
        return command == "push" ? push(argv[2], argv[3]) : restore(argv[2], argv[3]);
    } catch (const std::exception& error) {
        return cli::fail({{.message = error.what()}});
    }
}
