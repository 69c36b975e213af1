#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"
#include "study/plan/participant.h"
#include "study/store/rows/actor.h"

namespace passung::store {

class Store;

enum class Consent { Yes, No, Withdrawn };
const char* consentName(Consent decision);  // "yes", "no", "withdrawn": as stored

/// What experimenters do about participants outside of sessions. Every action is one durable transaction with its row
/// in the audit; texts are codes and reasons, never names of participants.
class ParticipantRecords {
public:
    ParticipantRecords(Store& store, Actor actor) : store_(store), actor_(std::move(actor)) {}

    /// Adds somebody new. A code that is there already is an error, and so is one that an erased participant may have
    /// had.
    Result<Done> enrol(const std::string& code, plan::ParticipantKind kind, const std::string& created_utc);

    /// Stores decisions on clauses of the protocol imported last, as its text in `language` has them. No clauses: all.
    /// Returns the clauses decided.
    Result<std::vector<std::string>> decide(const std::string& code, const std::vector<std::string>& clauses,
                                            const std::string& language, Consent decision);

    /// Takes part no more; what is there stays in the analysis.
    Result<Done> withdraw(const std::string& code, const std::string& reason);

    /// What is there stays and counts nowhere; the slot is free again. `action` is what the audit calls
    /// it: "exclude", or "withdraw" where the participant asked for it.
    Result<Done> exclude(const std::string& code, const std::string& reason, const std::string& action = "exclude");

    /// Takes an exclusion (not a withdrawal) back: data counts again. False if somebody else has the place by now.
    Result<bool> readmit(const std::string& code, const std::string& reason);

    /// Nothing of them is left in the database's files (see eraseParticipant()). Returns the surrogate in the audit.
    Result<std::string> erase(const std::string& code);

    /// Nor in its backup (see eraseFromBackup()), before that. False if it does not hold them.
    Result<bool> eraseFromBackup(const std::string& code);

private:
    Store& store_;
    Actor actor_;
};

}  // namespace passung::store
