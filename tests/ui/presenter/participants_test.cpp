#include "ui/presenter/participants.h"

#include <gtest/gtest.h>

#include "study/store/people/participant_records.h"
#include "tests/study/store/fake_study.h"
#include "ui/presenter/leaving.h"

namespace passung {
namespace {

using namespace presenter;
using fake::require;
using plan::ParticipantKind;

const store::Actor kActor{"experimenter", "2001-02-03T04:05:06.000Z"};

plan::StudyPlan planWithConsent() {
    plan::StudyPlan plan = fake::makePlan();
    plan.consent = {{"data_use", true, {{"de", "Auswertung?"}, {"en", "Analysis?"}}},
                    {"photos", false, {{"de", "Fotos?"}, {"en", "Photos?"}}}};
    return plan;
}

/// A study with people in every state.
class ParticipantsOf : public testing::Test {
protected:
    ParticipantsOf() {
        store_ = fake::openStore(folder_ / "s.db");
        sha256_ = require(store_->importProtocol(plan_));
    }

    void enrol(const std::string& code, ParticipantKind kind = ParticipantKind::Real) {
        store::ParticipantRecords desk(*store_, kActor);
        require(desk.enrol(code, kind, "2001-02-03T04:05:06.000Z"));
    }

    void consent(const std::string& code) {
        store::ParticipantRecords desk(*store_, kActor);
        require(desk.decide(code, {}, "en", store::Consent::Yes));
    }

    /// A session of two trials, one attempt each as far as it gets, and what happens after them.
    void session(const std::string& code, bool whole, const std::vector<std::string>& events = {}) {
        require(store_->assignSlot(sha256_, code));
        store::SessionStart start;
        start.protocol_sha256 = sha256_;
        start.participant = code;
        start.ordinal = require(store_->nextOrdinal(code));
        start.seed = plan_.seed;
        start.session_id = store::sessionId("fake", code, start.ordinal, start.seed);
        start.device.name = "sigma7";
        const auto writer = require(store_->createSession(start, fake::makeTrials(plan_, 2)));
        for (int trial = 0; trial < (whole ? 2 : 1); ++trial) require(fake::writeAttempt(*writer, trial, 100));
        for (const std::string& event : events) writer->appendEvent({{}, 900'000'000, "session", event, "{}"});
        require(writer->finishSession(whole, 1'000'000'000));
    }

    Participants participants() const {
        return require(readParticipants(plan_, require(store::StoreReader::open(folder_ / "s.db"))));
    }

    fake::TempFolder folder_;
    plan::StudyPlan plan_ = planWithConsent();
    std::unique_ptr<store::Store> store_;
    std::string sha256_;
};

TEST_F(ParticipantsOf, SaysOfEverybodyWhatTheyDidAndAgreedTo) {
    // Truth: invariant, the study as it was made here.
    for (const char* code : {"P001", "P002", "P003"}) enrol(code);
    enrol("T001", ParticipantKind::Pilot);
    consent("P001");
    session("P001", true);
    consent("P002");
    session("P002", false);
    store::ParticipantRecords desk(*store_, kActor);
    require(desk.decide("P003", {"photos"}, "de", store::Consent::No));

    const Participants all = participants();
    ASSERT_EQ(all.people.size(), 4u);
    const ParticipantEntry& first = *all.find("P001");
    EXPECT_EQ(first.complete(), 1);
    EXPECT_EQ(first.interrupted(), 0);
    EXPECT_EQ(first.attempts(), 2);
    EXPECT_EQ(first.consent, (std::vector{Decision::Yes, Decision::Yes}));
    EXPECT_EQ(whyNotStart(all, first, false), PersonWhy::AllDone);
    EXPECT_EQ(whyNotResume(all, first, false), PersonWhy::NothingInterrupted);
    const ParticipantEntry& second = *all.find("P002");
    EXPECT_EQ(second.interrupted(), 1);
    ASSERT_NE(second.resumable(), nullptr);
    EXPECT_EQ(second.resumable()->state, presenter::SessionEnd::Aborted);
    EXPECT_EQ(whyNotResume(all, second, false), PersonWhy::Possible);
    EXPECT_EQ(whyNotResume(all, second, true), PersonWhy::SessionRuns);
    const ParticipantEntry& third = *all.find("P003");
    EXPECT_EQ(third.consent, (std::vector{Decision::NotAsked, Decision::No}));
    EXPECT_EQ(whyNotStart(all, third, false), PersonWhy::Possible);
    EXPECT_EQ(all.find("T001")->kind, ParticipantKind::Pilot);

    // A cue that nothing here can give keeps people and pilots from beginning and from going on.
    Participants shaking = all;
    shaking.for_people = false;
    EXPECT_EQ(whyNotStart(shaking, third, false), PersonWhy::CueWithoutOutput);
    EXPECT_EQ(whyNotStart(shaking, *all.find("T001"), false), PersonWhy::CueWithoutOutput);
    EXPECT_EQ(whyNotResume(shaking, second, false), PersonWhy::CueWithoutOutput);
    EXPECT_TRUE(all.for_people);
    plan_.conditions.front().cues.vibrotactile = true;
    EXPECT_FALSE(participants().for_people);
    plan_.conditions.front().cues.vibrotactile = false;

    // With another wording nobody has agreed to it.
    plan_.consent[0].texts = {{"en", "All of it?"}};
    EXPECT_EQ(participants().find("P001")->consent[0], Decision::OtherWords);
}

TEST_F(ParticipantsOf, SaysWhoseSessionWasCutOffInAQuestionnaire) {
    // Truth: closed form: a form that was shown last and not handed in.
    const std::vector<std::vector<std::string>> ways = {
        {},
        {"questionnaire_shown"},
        {"questionnaire_shown", "questionnaire_answered"},
        {"questionnaire_shown", "questionnaire_answered", "questionnaire_shown"}};
    for (std::size_t i = 0; i < ways.size(); ++i) {
        const std::string code = "P00" + std::to_string(i + 1);
        enrol(code);
        consent(code);
        session(code, false, ways[i]);
    }
    const Participants all = participants();
    for (std::size_t i = 0; i < ways.size(); ++i)
        EXPECT_EQ(all.people[i].resumable()->in_form, i % 2 == 1) << all.people[i].code;
}

TEST_F(ParticipantsOf, ProposesCodesByTheStoresRulesAndRefusesOthersWithAReason) {
    // Truth: independent program, the store's own rules.
    EXPECT_EQ(proposedCode(noParticipants(plan_), ParticipantKind::Real), "P001");
    for (const char* code : {"P001", "P002", "P003"}) enrol(code);
    for (const auto kind : {ParticipantKind::Real, ParticipantKind::Pilot})
        EXPECT_EQ(proposedCode(participants(), kind), require(store_->nextCode(kind)));
    store::ParticipantRecords desk(*store_, kActor);
    require(desk.erase("P003"));
    EXPECT_EQ(proposedCode(participants(), ParticipantKind::Real), "P004");
    EXPECT_EQ(require(store_->nextCode(ParticipantKind::Real)), "P004");

    const Participants all = participants();
    const struct {
        const char* code;
        CodeWhy why;
    } cases[] = {{"P004", CodeWhy::Possible},    {"PB17", CodeWhy::Possible},    {"P001", CodeWhy::Taken},
                 {"T001", CodeWhy::WrongLetter}, {"P003", CodeWhy::MayBeErased}, {"", CodeWhy::NotACode},
                 {"p004", CodeWhy::NotACode},    {"P", CodeWhy::NotACode}};
    for (const auto& each : cases) {
        EXPECT_EQ(whyNotEnrol(all, each.code, ParticipantKind::Real), each.why) << each.code;
        EXPECT_EQ(static_cast<bool>(desk.enrol(each.code, ParticipantKind::Real, "")), each.why == CodeWhy::Possible)
            << each.code;
    }
}

TEST_F(ParticipantsOf, ShowsThePlacesOfTheDesignAndHowEvenTheyAre) {
    // Truth: closed form. A Williams square of 4 has 4 rows; with all of them every position counts once.
    for (int i = 1; i <= 4; ++i) {
        const std::string code = "P00" + std::to_string(i);
        enrol(code);
        consent(code);
        session(code, true);
        const Participants all = participants();
        ASSERT_EQ(all.places.size(), 4u);
        EXPECT_EQ(std::count_if(all.places.begin(), all.places.end(), [](const auto& p) { return !p.owner.empty(); }),
                  i);
        EXPECT_EQ(all.balance.even_number, 4u);
        ASSERT_EQ(all.balance.groups.size(), 1u);
        ASSERT_EQ(all.balance.groups[0].balancings.size(), 1u);
        EXPECT_EQ(all.balance.groups[0].balancings[0].even, i == 4);
        EXPECT_EQ(all.balance.groups[0].balancings[0].counts.positions.high, 1);
        EXPECT_EQ(all.balance.groups[0].balancings[0].counts.positions.low, i == 4 ? 1 : 0);
    }
}

TEST_F(ParticipantsOf, WhoLeavesIsAskedAboutTwiceAndToldWhatItDoes) {
    // Truth: invariant, the store's own rules.
    enrol("P001");
    consent("P001");
    session("P001", false);
    LeavingDialog dialog;
    dialog.open(*participants().find("P001"));
    EXPECT_FALSE(dialog.confirm("P001", false)) << "without the second question";
    EXPECT_EQ(dialog.whyNotChoose(Scope::Dismiss, "", false), PersonWhy::NeedsReason);
    EXPECT_EQ(dialog.whyNotChoose(Scope::Erase, "", true), PersonWhy::SessionRuns);
    dialog.choose(Scope::Erase, "");
    EXPECT_EQ(dialog.leaving().sessions, 1);
    EXPECT_EQ(dialog.leaving().attempts, 1);
    EXPECT_FALSE(dialog.confirm("P002", false)) << "the wrong code";
    EXPECT_EQ(dialog.whyNotConfirm("P002", false), PersonWhy::NeedsCode);
    dialog.back();
    dialog.choose(Scope::Dismiss, "fell asleep");
    const auto leaving = dialog.confirm("", false);
    ASSERT_TRUE(leaving);
    EXPECT_EQ(dialog.step(), LeavingDialog::Step::Closed);

    store::ParticipantRecords desk(*store_, kActor);
    require(desk.exclude("P001", leaving->reason));
    Participants all = participants();
    EXPECT_EQ(all.find("P001")->standing, Standing::Excluded);
    EXPECT_EQ(all.find("P001")->reason, "fell asleep");
    EXPECT_EQ(whyNotStart(all, *all.find("P001"), false), PersonWhy::TakesNoPart);
    EXPECT_EQ(whyNotReadmit(*all.find("P001"), "", false), PersonWhy::NeedsReason);
    EXPECT_EQ(whyNotReadmit(*all.find("P001"), "was awake", false), PersonWhy::Possible);
    dialog.open(*all.find("P001"));
    EXPECT_EQ(dialog.whyNotChoose(Scope::Stop, "", false), PersonWhy::OutAlready);
    require(desk.readmit("P001", "was awake"));
    require(desk.exclude("P001", "", "withdraw"));
    all = participants();
    EXPECT_EQ(all.find("P001")->standing, Standing::WithdrawnWithData);
    EXPECT_EQ(whyNotReadmit(*all.find("P001"), "was awake", false), PersonWhy::OwnWish);
    EXPECT_FALSE(desk.readmit("P001", "was awake"));
}

TEST_F(ParticipantsOf, APlaceIsFreedExceptByWhoCompletedAndOnlyStops) {
    // Truth: independent program: whether the store has the place free afterwards.
    for (const bool whole : {false, true}) {
        for (const Scope scope : {Scope::Stop, Scope::Exclude}) {
            const std::string code = proposedCode(participants(), ParticipantKind::Real);
            enrol(code);
            consent(code);
            session(code, whole);
            if (!whole) require(store_->assignSlot(sha256_, code));  // the session's end gave it back
            LeavingDialog dialog;
            dialog.open(*participants().find(code));
            dialog.choose(scope, "");
            store::ParticipantRecords desk(*store_, kActor);
            require(scope == Scope::Stop ? desk.withdraw(code, "") : desk.exclude(code, "", "withdraw"));
            EXPECT_EQ(dialog.leaving().frees_place, !participants().find(code)->place) << code;
        }
    }
}

}  // namespace
}  // namespace passung
