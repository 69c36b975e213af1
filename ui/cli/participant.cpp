#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <iostream>
#include <map>
#include <optional>

#include "study/run/files/protocol_files.h"
#include "study/store/people/participant_records.h"
#include "study/store/read/store_reader.h"
#include "study/store/schema/backup.h"
#include "ui/cli/commands.h"
#include "ui/cli/console.h"
#include "ui/cli/places.h"
#include "ui/cli/station.h"
#include "ui/presenter/participant_access.h"

namespace passung::cli {

namespace {

/// What `work` does on the study's participants as an exit code. The database has to be there unless `create`.
int withParticipants(const ParticipantArguments& options, bool create,
                     const std::function<Result<Done>(store::Store&, store::ParticipantRecords&)>& work) {
    const auto station = stationOf(options.station);
    if (!station) return fail(station.errors());
    const auto done =
        presenter::withParticipants({options.database, options.by, *station, create, options.group}, work);
    return done ? 0 : fail(done.errors());
}

/// The latest decision on each clause, whatever the words: "data_use yes, photos no".
std::string consentText(const std::vector<store::ConsentRow>& consents, const std::string& participant) {
    std::map<std::string, std::string> latest;
    for (const auto& row : consents)
        if (row.participant_id == participant) latest[row.clause] = row.decision;
    std::string text;
    for (const auto& [clause, decision] : latest)
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", clause, decision);
    return text.empty() ? "-" : text;
}

}  // namespace

int enrolParticipant(const ParticipantArguments& options) {
    std::optional<plan::StudyPlan> plan;
    if (!options.protocol.empty()) {
        auto read = run::readProtocol(options.protocol);
        if (!read) return fail(read.errors());
        plan = *std::move(read);
    }
    return withParticipants(
        options, plan.has_value(), [&](store::Store& store, store::ParticipantRecords& records) -> Result<Done> {
            if (plan)
                if (const auto imported = store.importProtocol(*plan); !imported) return imported.errors();
            const auto code =
                presenter::enrolAt(store, records, *plan::participantKindNamed(options.kind), options.code);
            if (!code) return code.errors();
            fmt::print("{}: {} participant, enrolled\n", *code, options.kind);
            return Done{};
        });
}

int listParticipants(const ParticipantArguments& options) {
    const auto reader = store::StoreReader::open(options.database);
    if (!reader) return fail(reader.errors());
    const auto people = reader->participants();
    if (!people) return fail(people.errors());
    const auto consents = reader->consents();
    if (!consents) return fail(consents.errors());
    const auto protocols = reader->protocols();
    if (!protocols) return fail(protocols.errors());
    fmt::print("{:<12} {:<10} {:<10} {:>5} {:<8} {:>8}  {}\n", "code", "kind", "status", "slot", "version", "sessions",
               "consent; reason of the status");
    for (const auto& person : *people) {
        const std::string slot =
            person.sequence_index ? fmt::format("{}.{}", *person.replicate + 1, *person.sequence_index + 1) : "-";
        const auto protocol = std::find_if(protocols->begin(), protocols->end(),
                                           [&](const auto& row) { return row.sha256 == person.place_sha256; });
        fmt::print("{:<12} {:<10} {:<10} {:>5} {:<8} {:>8}  {}{}\n", person.participant_id, person.kind, person.status,
                   slot, protocol == protocols->end() ? "-" : protocol->version, person.sessions,
                   consentText(*consents, person.participant_id),
                   person.status_reason ? "; " + *person.status_reason : "");
    }
    printTakenPlaces(*reader);
    return 0;
}

int decideConsent(const ParticipantArguments& options) {
    const auto decision = options.decision == "yes"  ? store::Consent::Yes
                          : options.decision == "no" ? store::Consent::No
                                                     : store::Consent::Withdrawn;
    return withParticipants(options, false, [&](store::Store&, store::ParticipantRecords& records) -> Result<Done> {
        const auto decided = records.decide(options.code, options.clauses, options.language, decision);
        if (!decided) return decided.errors();
        fmt::print("{}: {}: {}\n", options.code, options.decision, fmt::join(*decided, ", "));
        return Done{};
    });
}

namespace {

/// Asked where somebody can answer; nothing if nobody does.
std::optional<bool> takesBackupAlong(const ParticipantArguments& options) {
    const std::string backup = store::backupPath(options.database);
    std::error_code none;
    if (!options.backup.empty()) return options.backup == "erase";
    if (isatty(STDIN_FILENO) == 0 || !std::filesystem::exists(backup, none)) return true;
    fmt::print("Erase {} from the backup {} as well? [Y/n] ", options.code, backup);
    std::fflush(stdout);
    for (std::string line; std::getline(std::cin, line);) {
        if (line.empty() || line == "y" || line == "Y" || line == "yes") return true;
        if (line == "n" || line == "N" || line == "no") return false;
        fmt::print("y or n: ");
        std::fflush(stdout);
    }
    return std::nullopt;
}

void tellErasure(const ParticipantArguments& options, const presenter::Left& left) {
    fmt::print("{}: erased from {}; the audit says {} in its place\n", options.code, options.database, left.surrogate);
    const std::string backup = store::backupPath(options.database);
    if (left.backup) fmt::print("{}: erased from the backup {} too\n", options.code, backup);
    if (!left.backup_problem.empty())
        fmt::print("{}: could not be erased from the backup {}: {}\n", options.code, backup, left.backup_problem);
    for (const std::string& copy : left.copies)
        fmt::print("names {} too, delete it if it is a copy of this database: {}\n", options.code, copy);
    fmt::print(
        "and whatever copies of the database and exports of other users lie elsewhere; erase them as well in the "
        "databases of other stations and in those merged from this one, and push to PostgreSQL again\n");
}

}  // namespace

int withdrawParticipant(const ParticipantArguments& options) {
    const auto station = stationOf(options.station);
    if (!station) return fail(station.errors());
    presenter::Leaving leaving;
    leaving.code = options.code;
    leaving.reason = options.reason;
    leaving.scope = options.scope == "stop"      ? presenter::Scope::Stop
                    : options.scope == "exclude" ? presenter::Scope::Exclude
                                                 : presenter::Scope::Erase;
    if (leaving.scope == presenter::Scope::Erase) {
        const auto along = takesBackupAlong(options);
        if (!along) return fail({{.message = "nobody answered: nothing was erased", .file = options.database}});
        leaving.backup_too = *along;
    }
    const auto left = presenter::leave({options.database, options.by, *station}, leaving);
    if (!left) return fail(left.errors());
    if (leaving.scope != presenter::Scope::Erase) {
        fmt::print("{}: withdrawn; {}\n", options.code,
                   options.scope == "stop" ? "the data stays in the analysis" : "the data counts nowhere any more");
        return 0;
    }
    tellErasure(options, *left);
    return left->backup_problem.empty() ? 0 : 1;
}

int excludeParticipant(const ParticipantArguments& options) {
    return withParticipants(options, false, [&](store::Store&, store::ParticipantRecords& records) -> Result<Done> {
        if (const auto done = records.exclude(options.code, options.reason); !done) return done;
        fmt::print("{}: excluded; the data counts nowhere any more and the slot is free\n", options.code);
        return Done{};
    });
}

int readmitParticipant(const ParticipantArguments& options) {
    return withParticipants(options, false, [&](store::Store&, store::ParticipantRecords& records) -> Result<Done> {
        const auto placed = records.readmit(options.code, options.reason);
        if (!placed) return placed.errors();
        fmt::print("{}: takes part again and the data counts{}\n", options.code,
                   *placed ? "" : "; the slot has another owner by now");
        return Done{};
    });
}

int auditParticipants(const ParticipantArguments& options) {
    const auto reader = store::StoreReader::open(options.database);
    if (!reader) return fail(reader.errors());
    const auto report = reader->audit();
    if (!report) return fail(report.errors());
    Errors faults;
    for (const std::string& fault : report->faults)
        faults.push_back({.message = fault, .file = options.database, .key = "audit"});
    if (!faults.empty()) return fail(faults);
    fmt::print("{}: ok: {} actions in {}, the details of {} erased\n", options.database, report->rows,
               report->chains > 1 ? fmt::format("{} unbroken chains", report->chains) : "an unbroken chain",
               report->erased);
    return 0;
}

}  // namespace passung::cli
