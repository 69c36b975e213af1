#include "ui/presenter/participant_access.h"

#include <filesystem>

#include "study/run/files/known_copies.h"
#include "study/run/files/wall_clock.h"

namespace passung::presenter {

namespace fs = std::filesystem;

Result<Done> withParticipants(const ParticipantAccess& access,
                              const std::function<Result<Done>(store::Store&, store::ParticipantRecords&)>& work) {
    auto open = run::openOptionsNow();
    open.station = access.station;
    open.create = access.create;
    open.group = access.group;
    const auto opened = store::Store::open(access.database, open);
    if (!opened.store) return opened.errors;
    store::ParticipantRecords records(*opened.store, {access.by, open.now_utc});
    return work(*opened.store, records);
}

Result<std::string> enrolAt(store::Store& store, store::ParticipantRecords& records, plan::ParticipantKind kind,
                            std::string code) {
    if (code.empty()) {
        const auto next = store.nextCode(kind);
        if (!next) return next.errors();
        code = *next;
    }
    const bool simulated = kind == plan::ParticipantKind::Simulated;
    const auto clock = simulated ? store::UtcClock::virtualEpoch() : store::UtcClock::wall(run::unixMilliseconds());
    if (const auto done = records.enrol(code, kind, clock.at(0)); !done) return done.errors();
    return code;
}

Result<Left> leave(const ParticipantAccess& access, const presenter::Leaving& leaving) {
    using presenter::Scope;
    Left left;
    const auto done = withParticipants(access, [&](store::Store&, store::ParticipantRecords& records) -> Result<Done> {
        if (leaving.scope == Scope::Stop) return records.withdraw(leaving.code, leaving.reason);
        if (leaving.scope == Scope::Exclude) return records.exclude(leaving.code, leaving.reason, "withdraw");
        if (leaving.scope == Scope::Dismiss) return records.exclude(leaving.code, leaving.reason);
        if (leaving.backup_too) {
            const auto erased = records.eraseFromBackup(leaving.code);
            left.backup = erased && *erased;
            if (!erased) left.backup_problem = erased.errors().front().message;
        }
        const auto surrogate = records.erase(leaving.code);
        if (!surrogate) return surrogate.errors();
        left.surrogate = *surrogate;
        left.copies = run::knownCopies(access.database, leaving.code);
        return Done{};
    });
    if (!done) return done.errors();
    return left;
}

std::string studyDatabase(const std::string& tryouts, const std::string& study) {
    return (fs::path(tryouts).parent_path() / "studies" / (study + ".db")).string();
}

}  // namespace passung::presenter
