#include "study/run/person/taking_part.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <span>

#include "core/base/digest.h"
#include "study/plan/plan_warnings.h"
#include "study/protocol/consent_reader.h"
#include "study/store/people/participant_records.h"
#include "study/store/read/store_reader.h"

namespace passung::run {

namespace {

/// Whoever said no to what may be refused is not asked again; a changed text is.
bool isDecided(const plan::ConsentClause& clause, const std::vector<store::ConsentRow>& decisions,
               const std::string& participant) {
    const store::ConsentRow* latest = nullptr;  // the rows come in the order of the decisions
    for (const store::ConsentRow& row : decisions)
        if (row.participant_id == participant && row.clause == clause.clause &&
            std::any_of(clause.texts.begin(), clause.texts.end(),
                        [&](const auto& text) { return sha256Hex(text.second) == row.text_sha256; }))
            latest = &row;
    return latest != nullptr && (latest->decision == "yes" || !clause.required);
}

}  // namespace

Result<Done> askForConsent(store::Store& store, const std::string& database, const plan::StudyPlan& plan,
                           const std::string& participant, const std::string& language, const std::string& now_utc,
                           const AskConsent& ask) {
    const auto fault = [&](const std::string& what) {
        return Error{.message = participant + ": " + what, .file = database, .key = "consent"};
    };
    for (const plan::ConsentClause& clause : plan.consent)
        for (const auto& [spoken, text] : clause.texts)
            if (const auto date = protocol::unfilledDate(text); date && spoken == language)
                return fault(fmt::format("the clause {} still says {}: fill in the date before people are asked",
                                         clause.clause, *date));
    const auto reader = store::StoreReader::open(database);
    if (!reader) return reader.errors();
    const auto decisions = reader->consents();
    if (!decisions) return decisions.errors();
    store::ParticipantRecords records(store, {"participant", now_utc});
    for (const plan::ConsentClause& clause : plan.consent) {
        if (isDecided(clause, *decisions, participant)) continue;
        const auto text = std::find_if(clause.texts.begin(), clause.texts.end(),
                                       [&](const auto& each) { return each.first == language; });
        if (text == clause.texts.end()) return fault("the protocol has no text in \"" + language + "\"");
        const auto agreed = ask(clause, text->second);
        if (!agreed) return fault("nobody decided on the clause " + clause.clause);
        const auto stored =
            records.decide(participant, {clause.clause}, language, *agreed ? store::Consent::Yes : store::Consent::No);
        if (!stored) return stored.errors();
        if (!*agreed && clause.required) return fault("no consent to the clause " + clause.clause + ", no session");
    }
    return Done{};
}

Errors missingOutputs(const plan::StudyPlan& plan, const std::string& participant) {
    const auto planned = std::span(plan.conditions).first(plan::plannedConditions(plan));
    Errors missing;
    for (const std::string& sentence : plan::cuesWithoutOutput(planned))
        missing.push_back({.message = participant + " cannot take part: " + sentence, .file = plan.source_path});
    return missing;
}

Errors missingDevices(const plan::StudyPlan& plan, const std::string& participant) {
    std::set<std::string> devices;
    for (const plan::Condition& condition : plan.conditions) devices.insert(condition.device);
    Errors missing;
    for (const std::string& device : devices)
        missing.push_back({.message = fmt::format("has no driver in this program, only a model, which a simulated hand "
                                                  "moves: {} cannot take part here; rehearse with a simulated "
                                                  "participant and --answers experimenter",
                                                  participant),
                           .file = plan.source_path,
                           .key = "device.preset",
                           .value = device});
    return missing;
}

}  // namespace passung::run
