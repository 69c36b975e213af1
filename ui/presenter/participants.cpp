#include "ui/presenter/participants.h"

#include <algorithm>
#include <map>

#include "core/base/digest.h"
#include "study/plan/plan_warnings.h"

namespace passung::presenter {

namespace {

using plan::ParticipantKind;

constexpr ParticipantKind kKinds[] = {ParticipantKind::Real, ParticipantKind::Pilot, ParticipantKind::Simulated};

Standing standingOf(const store::ParticipantRow& row) {
    if (row.status == "withdrawn") return Standing::Withdrawn;
    if (row.status != "excluded") return Standing::TakesPart;
    return row.standing_by == "withdraw" ? Standing::WithdrawnWithData : Standing::Excluded;
}

SessionEnd stateNamed(const std::optional<std::string>& end) {
    if (!end) return SessionEnd::Open;
    return *end == "complete" ? SessionEnd::Complete : *end == "crashed" ? SessionEnd::Crashed : SessionEnd::Aborted;
}

Decision decisionNamed(const std::string& decision) {
    return decision == "yes" ? Decision::Yes : decision == "no" ? Decision::No : Decision::Withdrawn;
}

/// `rows`: of one participant, in the order of deciding.
Decision decisionOn(const plan::ConsentClause& clause, const std::vector<const store::ConsentRow*>& rows) {
    Decision latest = Decision::NotAsked;
    for (const store::ConsentRow* row : rows) {
        if (row->clause != clause.clause) continue;
        const bool same_words = std::any_of(clause.texts.begin(), clause.texts.end(), [&](const auto& text) {
            return sha256Hex(text.second) == row->text_sha256;
        });
        if (same_words)
            latest = decisionNamed(row->decision);
        else if (latest == Decision::NotAsked)
            latest = Decision::OtherWords;
    }
    return latest;
}

/// At least as many as are planned, and on to the last one that is taken.
void fillPlaces(const plan::StudyPlan& plan, Participants& participants) {
    std::vector<const ParticipantEntry*> owners;
    for (const ParticipantEntry& person : participants.people)
        if (person.kind == ParticipantKind::Real && person.place) owners.push_back(&person);
    std::size_t count = static_cast<std::size_t>(std::max(plan.participants, 1));
    std::size_t found = 0;
    do {
        found = 0;
        participants.places.clear();
        for (const session::DesignPlace& at : session::firstPlaces(plan, count)) {
            PlaceEntry place{at, {}, false};
            for (const ParticipantEntry* owner : owners)
                if (owner->place->slot == at.slot && owner->place->group == at.group) {
                    place.owner = owner->code;
                    place.done = owner->complete() > 0;
                    ++found;
                }
            participants.places.push_back(std::move(place));
        }
        count *= 2;
    } while (found < owners.size() && count < 100'000);  // another version's places may never be met
    while (participants.places.size() > static_cast<std::size_t>(std::max(plan.participants, 1)) &&
           participants.places.back().owner.empty())
        participants.places.pop_back();
    std::vector<session::DesignPlace> taken;
    for (const ParticipantEntry* owner : owners) taken.push_back(*owner->place);
    participants.balance = designBalance(plan, taken);
}

ParticipantEntry personOf(const store::ParticipantRow& row, const Participants& participants, const std::string& sha256,
                          std::size_t sequences) {
    ParticipantEntry person;
    person.code = row.participant_id;
    person.enrolled_utc = row.created_utc;
    person.kind = plan::participantKindNamed(row.kind).value_or(ParticipantKind::Simulated);
    person.standing = standingOf(row);
    person.reason = row.status_reason.value_or("");
    const auto group = std::find(participants.groups.begin(), participants.groups.end(), row.group.value_or(""));
    if (row.sequence_index && row.place_sha256 == sha256 && group != participants.groups.end())
        person.place = session::DesignPlace{
            static_cast<std::size_t>(*row.replicate) * sequences + static_cast<std::size_t>(*row.sequence_index),
            static_cast<std::size_t>(group - participants.groups.begin())};
    return person;
}

/// Which of the sessions that can be resumed were cut off in a questionnaire.
Result<Done> findOpenForms(const store::StoreReader& reader, Participants& participants) {
    std::map<std::pair<std::string, std::int64_t>, SessionEntry*> resumable;
    for (ParticipantEntry& person : participants.people)
        if (person.resumable() != nullptr)
            resumable[{person.code, person.sessions.back().ordinal}] = &person.sessions.back();
    if (resumable.empty()) return Done{};
    const auto events = reader.events();
    if (!events) return events.errors();
    for (const store::EventRow& event : *events) {
        const auto found = resumable.find({event.participant_id, event.session_ordinal});
        if (found == resumable.end()) continue;
        if (event.event == "questionnaire_shown") found->second->in_form = true;
        if (event.event == "questionnaire_answered" || event.attempt_no) found->second->in_form = false;
    }
    return Done{};
}

}  // namespace

std::int64_t ParticipantEntry::attempts() const {
    std::int64_t count = 0;
    for (const SessionEntry& session : sessions) count += session.attempts;
    return count;
}

int ParticipantEntry::complete() const {
    return static_cast<int>(
        std::count_if(sessions.begin(), sessions.end(), [](const auto& s) { return s.state == SessionEnd::Complete; }));
}

int ParticipantEntry::interrupted() const { return static_cast<int>(sessions.size()) - complete(); }

const SessionEntry* ParticipantEntry::resumable() const {
    return sessions.empty() || sessions.back().state == SessionEnd::Complete ? nullptr : &sessions.back();
}

const ParticipantEntry* Participants::find(const std::string& code) const {
    const auto found =
        std::find_if(people.begin(), people.end(), [&](const auto& person) { return person.code == code; });
    return found == people.end() ? nullptr : &*found;
}

Participants noParticipants(const plan::StudyPlan& plan) {
    Participants participants;
    participants.clauses = plan.consent;
    participants.groups = plan::groupNames(plan);
    participants.sessions = plan::sessionsOf(plan);
    participants.for_people = plan::isForPeople(plan);
    fillPlaces(plan, participants);
    return participants;
}

Result<Participants> readParticipants(const plan::StudyPlan& plan, const store::StoreReader& reader) {
    const auto protocols = reader.protocols();
    if (!protocols) return protocols.errors();
    const auto people = reader.participants();
    if (!people) return people.errors();
    const auto consents = reader.consents();
    if (!consents) return consents.errors();
    const auto sessions = reader.sessions();
    if (!sessions) return sessions.errors();
    const auto forms = reader.questionnaireRuns();
    if (!forms) return forms.errors();

    Participants participants = noParticipants(plan);
    const std::string sha256 = sha256Hex(plan.source_text);
    participants.other_version =
        std::none_of(protocols->begin(), protocols->end(), [&](const auto& row) { return row.sha256 == sha256; });
    for (const ParticipantKind kind : kKinds) {
        const auto erased = reader.erasedCodesTo(kind);
        if (!erased) return erased.errors();
        participants.erased_to[static_cast<std::size_t>(kind)] = *erased;
    }
    std::map<std::string, std::vector<const store::ConsentRow*>> decided;
    for (const auto& row : *consents) decided[row.participant_id].push_back(&row);
    const std::size_t sequences = design::sequencesOf(plan::designOf(plan));
    for (const auto& row : *people) {
        ParticipantEntry person = personOf(row, participants, sha256, sequences);
        for (const auto& clause : plan.consent) person.consent.push_back(decisionOn(clause, decided[person.code]));
        for (const auto& session : *sessions)
            if (session.participant_id == person.code)
                person.sessions.push_back({session.session_id, session.started_utc, static_cast<int>(session.ordinal),
                                           stateNamed(session.end_state), session.planned_trials, session.attempts,
                                           session.valid_attempts, false});
        std::sort(person.sessions.begin(), person.sessions.end(),
                  [](const auto& a, const auto& b) { return a.ordinal < b.ordinal; });
        person.forms = std::count_if(forms->begin(), forms->end(), [&](const auto& form) {
            return form.participant_id == person.code && form.completed_utc;
        });
        participants.people.push_back(std::move(person));
    }
    if (const auto found = findOpenForms(reader, participants); !found) return found.errors();
    fillPlaces(plan, participants);
    return participants;
}

PersonWhy whyNotStart(const Participants& participants, const ParticipantEntry& person, bool session_runs) {
    if (session_runs) return PersonWhy::SessionRuns;
    if (person.standing != Standing::TakesPart) return PersonWhy::TakesNoPart;
    if (person.kind == ParticipantKind::Simulated) return PersonWhy::Simulated;
    if (!participants.for_people) return PersonWhy::CueWithoutOutput;
    return person.complete() >= participants.sessions ? PersonWhy::AllDone : PersonWhy::Possible;
}

PersonWhy whyNotResume(const Participants& participants, const ParticipantEntry& person, bool session_runs) {
    if (session_runs) return PersonWhy::SessionRuns;
    if (person.standing != Standing::TakesPart) return PersonWhy::TakesNoPart;
    if (person.kind == ParticipantKind::Simulated) return PersonWhy::Simulated;
    if (!participants.for_people) return PersonWhy::CueWithoutOutput;
    return person.resumable() == nullptr ? PersonWhy::NothingInterrupted : PersonWhy::Possible;
}

PersonWhy whyNotReadmit(const ParticipantEntry& person, const std::string& reason, bool session_runs) {
    if (session_runs) return PersonWhy::SessionRuns;
    if (person.standing != Standing::Excluded)
        return person.standing == Standing::TakesPart ? PersonWhy::NotOut : PersonWhy::OwnWish;
    return reason.empty() ? PersonWhy::NeedsReason : PersonWhy::Possible;
}

CodeWhy whyNotEnrol(const Participants& participants, const std::string& code, ParticipantKind kind) {
    if (!plan::isParticipantCode(code)) return CodeWhy::NotACode;
    if (plan::kindOfCode(code) != kind) return CodeWhy::WrongLetter;
    if (participants.find(code) != nullptr) return CodeWhy::Taken;
    return plan::participantNumber(code) <= participants.erased_to[static_cast<std::size_t>(kind)]
               ? CodeWhy::MayBeErased
               : CodeWhy::Possible;
}

std::string proposedCode(const Participants& participants, ParticipantKind kind) {
    std::int64_t number = participants.erased_to[static_cast<std::size_t>(kind)] + 1;
    while (participants.find(plan::participantCode(kind, number)) != nullptr) ++number;
    return plan::participantCode(kind, number);
}

}  // namespace passung::presenter
