#include "study/session/questionnaire_course.h"

#include <gtest/gtest.h>

#include <span>

namespace passung::session {
namespace {

/// A questionnaire of six ratings from 0 to 10; the mean of the first three is a scale.
plan::PlannedQuestionnaire sixRatings(const char* key, plan::Moment moment) {
    plan::PlannedQuestionnaire planned;
    planned.moment = moment;
    planned.definition.key = key;
    planned.definition.shuffled = true;
    for (const char* id : {"a", "b", "c", "d", "e", "f"}) {
        questionnaire::Item item;
        item.id = id;
        item.response.high = 10.0;
        planned.definition.items.push_back(item);
    }
    planned.definition.scales.emplace_back();
    planned.definition.scales[0].items = {0, 1, 2};
    return planned;
}

/// Takes `looks` looks for a form, then gives 1, 2, 6, 0, 0, 0.
class SlowPerson : public QuestionnaireSource {
public:
    int looks = 0;
    std::vector<double> values = {1, 2, 6, 0, 0, 0};
    std::vector<std::string> occasions;
    std::vector<std::vector<std::size_t>> orders;
    std::vector<std::size_t> trials;
    int withdrawn = 0;

    void withdraw() override { ++withdrawn; }
    std::optional<FilledForm> fill(const ShownQuestionnaire& form) override {
        if (looked_++ < looks) return std::nullopt;
        looked_ = 0;
        occasions.push_back(form.planned.definition.key + " " + form.occasion_text);
        orders.push_back(form.order);
        trials.push_back(form.trials.size());
        FilledForm filled{{}, "participant"};
        for (const double value : values) filled.answers.push_back({{value, ""}, 800, 1});
        return filled;
    }

private:
    int looked_ = 0;
};

class StoringSink : public TrialSink {
public:
    std::vector<double> scores;
    std::vector<std::int64_t> times;
    std::optional<std::int64_t> response_ms;
    std::vector<std::string> forms, events;
    bool full = false;
    Result<AttemptId> startAttempt(const AttemptStart&) override { return AttemptId{1}; }
    void appendRecords(AttemptId, std::size_t, std::span<const TickRecord>) override {}
    void appendEvent(const Event& event) override { events.push_back(event.event); }
    Result<Done> finishAttempt(AttemptId, const AttemptEnd&) override { return Done{}; }
    Result<Done> storeQuestionnaire(const QuestionnaireRun& run) override {
        if (full) return Error{"the disk is full"};
        scores.push_back(run.scores.at(0).value.value());
        times.push_back(run.completed_ns);
        response_ms = run.filled.answers.at(0).response_ms;
        forms.push_back(run.form.id());
        return Done{};
    }
    Result<Done> reorder(const Reordering&) override { return Done{}; }
    Result<Done> addNote(const std::string&, const std::string&, std::int64_t) override { return Done{}; }
    Result<Done> finishSession(bool, std::int64_t) override { return Done{}; }
};

class QuestionnaireDeskTest : public testing::Test {
protected:
    QuestionnaireDeskTest() {
        plan_.name = "study";
        plan_.conditions.resize(2);
        plan_.questionnaires = {sixRatings("first", plan::Moment::AfterTrial),
                                sixRatings("second", plan::Moment::AfterBlock)};
        for (std::int64_t i = 0; i < 2; ++i)
            trials_.push_back({i, 0, "main", i, "main", static_cast<std::size_t>(i), 1});
    }
    QuestionnaireCourse desk(QuestionnaireSource* source) { return {plan_, {"P001", 7, 1}, source, sink_}; }

    std::span<const design::PlannedTrial> from(std::size_t next) const { return std::span(trials_).subspan(next); }

    plan::StudyPlan plan_;
    std::vector<design::PlannedTrial> trials_;
    StoringSink sink_;
    SlowPerson person_;
};

TEST_F(QuestionnaireDeskTest, TheTrialWaitsUntilTheLastFormIsStored) {
    // Truth: closed form: three looks for each form; nothing is due before trial 0; means of 1, 2, 6.
    person_.looks = 2;
    auto asking = desk(&person_);
    EXPECT_FALSE(*asking.ask(from(0), 0));
    asking.remember({trials_[0], {}});
    for (const bool waits : {true, true, false}) EXPECT_EQ(*asking.ask(from(1), 5), waits);
    EXPECT_FALSE(*asking.ask(from(1), 5)) << "asked once";
    asking.remember({trials_[1], {}});
    for (const bool waits : {true, true, true, true, true, false}) EXPECT_EQ(*asking.ask(from(2), 9), waits);
    EXPECT_EQ(sink_.scores, (std::vector<double>{3, 3, 3}));
    EXPECT_EQ(sink_.times, (std::vector<std::int64_t>{5, 9, 9}));
    EXPECT_EQ(person_.occasions, (std::vector<std::string>{"first 1|after_trial|0|0|0", "first 1|after_trial|0|1|1",
                                                           "second 1|after_block|0||"}));
    EXPECT_EQ(person_.trials, (std::vector<std::size_t>{1, 1, 2}));
}

TEST_F(QuestionnaireDeskTest, TheOrderOfItemsFollowsFromTheOccasionAlone) {
    // Truth: invariant: a session that begins later (resumed) shows the same order.
    auto whole = desk(&person_);
    whole.remember({trials_[0], {}});
    static_cast<void>(whole.ask(from(1), 0));
    whole.remember({trials_[1], {}});
    static_cast<void>(whole.ask(from(2), 0));
    static_cast<void>(whole.ask(from(2), 0));
    auto later = desk(&person_);
    later.remember({trials_[1], {}});
    static_cast<void>(later.ask(from(2), 0));
    ASSERT_EQ(person_.orders.size(), 4u);
    EXPECT_EQ(person_.occasions[3], person_.occasions[1]);
    EXPECT_EQ(person_.orders[3], person_.orders[1]);
    EXPECT_NE(person_.orders[0], person_.orders[1]) << "another occasion, another order";
}

TEST_F(QuestionnaireDeskTest, AsksAgainWhatWasNotStoredBeforeAnInterruption) {
    // Truth: closed form: after trial 1 two forms are due; the first of them was stored.
    auto whole = desk(&person_);
    whole.remember({trials_[0], {}});
    EXPECT_FALSE(*whole.ask(from(1), 0));
    whole.remember({trials_[1], {}});
    EXPECT_TRUE(*whole.ask(from(2), 0));
    auto resumed = desk(&person_);
    resumed.resume({{trials_[0], {}}, {trials_[1], {}}}, {}, {{sink_.forms[0], 1}, {sink_.forms[1], 1}});
    EXPECT_TRUE(resumed.isDue(from(2)));
    EXPECT_FALSE(*resumed.ask(from(2), 0));
    EXPECT_FALSE(resumed.isDue(from(2)));
    EXPECT_EQ(sink_.forms.size(), 3u);
    EXPECT_EQ(person_.occasions.back(), "second 1|after_block|0||");
    EXPECT_EQ(person_.trials.back(), 2u) << "about the trials before the interruption too";
    auto not_stored = desk(&person_);
    not_stored.resume({{trials_[0], {}}, {trials_[1], {}}}, {}, {});
    EXPECT_TRUE(*not_stored.ask(from(2), 0)) << "both";
}

TEST_F(QuestionnaireDeskTest, ASessionThatGoesOnAsksAgainAboutTrialsThatWereBegunAgain) {
    // Truth: closed form: an attempt takes 10 ns, its form comes right after it and before the next begins. Trial 0 was
    // begun at 0 and, after its form, again at 10; the form of trial 1 and the block's came at 30.
    auto before = desk(&person_);
    before.remember({trials_[0], {}});
    static_cast<void>(before.ask(from(1), 10));
    before.remember({trials_[1], {}});
    static_cast<void>(before.ask(from(2), 30));
    static_cast<void>(before.ask(from(2), 30));
    ASSERT_EQ(sink_.forms.size(), 3u);
    std::vector<StoredForm> stored = {{sink_.forms[0], 10}, {sink_.forms[1], 30}, {sink_.forms[2], 30}};
    const auto asked = [&](std::vector<FinishedTrial> finished, std::size_t next) {
        person_.occasions.clear();
        auto resumed = desk(&person_);
        resumed.resume(std::move(finished), from(next), stored);
        while (*resumed.ask(from(next), 40)) {
        }
        return person_.occasions.size();
    };
    EXPECT_EQ(asked({{trials_[0], {}, 0}, {trials_[1], {}, 20}}, 2), 0u);
    EXPECT_EQ(asked({{trials_[1], {}, 0}, {trials_[0], {}, 10}}, 2), 1u) << "what was asked about trial 0 is older";
    stored.push_back({sink_.forms[0], 20});
    EXPECT_EQ(asked({{trials_[1], {}, 0}, {trials_[0], {}, 10}}, 2), 0u) << "but not if it was asked again";
    EXPECT_EQ(asked({{trials_[0], {}, 0}}, 1), 0u);
    stored.erase(stored.begin());
    EXPECT_EQ(asked({{trials_[1], {}, 30}, {trials_[0], {}, 0}}, 2), 1u) << "the block's: trial 1 was begun since";
}

TEST_F(QuestionnaireDeskTest, WhoGoesBackIsAskedAgainAboutThatTrialOnly) {
    // Truth: closed form: forms after each of two trials and after their block; then trial 1 is gone back to.
    auto asking = desk(&person_);
    for (std::size_t i = 0; i < 2; ++i) {
        asking.remember({trials_[i], {}});
        while (*asking.ask(from(i + 1), 0)) {
        }
    }
    person_.occasions.clear(), person_.trials.clear();
    asking.forget(trials_[1]);
    EXPECT_FALSE(asking.isDue(from(1))) << "nothing before it is done again";
    asking.remember({trials_[1], {}});
    while (*asking.ask(from(2), 0)) {
    }
    EXPECT_EQ(person_.occasions, (std::vector<std::string>{"first 1|after_trial|0|1|1", "second 1|after_block|0||"}));
    EXPECT_EQ(person_.trials, (std::vector<std::size_t>{1, 2})) << "about its newest attempt only";
    asking.forget(trials_[1]);
    asking.forget(trials_[0]);
    EXPECT_FALSE(asking.isDue(from(0)));
    asking.remember({trials_[0], {}});
    EXPECT_TRUE(asking.isDue(from(1)));
}

TEST_F(QuestionnaireDeskTest, WhoGoesBackWhileAFormIsOpenIsToldToTakeItAway) {
    // Truth: invariant: the form comes anew when the trial is over again, and each time that it does is an event.
    person_.looks = 1;
    auto asking = desk(&person_);
    asking.remember({trials_[0], {}});
    EXPECT_TRUE(*asking.ask(from(1), 0));
    asking.forget(trials_[0]);
    EXPECT_FALSE(*asking.ask(from(0), 0));
    EXPECT_EQ(person_.withdrawn, 1);
    asking.remember({trials_[0], {}});
    asking.forget(trials_[1]);
    EXPECT_EQ(person_.withdrawn, 1) << "no form was open";
    while (*asking.ask(from(1), 0)) {
    }
    EXPECT_EQ(sink_.events, (std::vector<std::string>{"questionnaire_shown", "questionnaire_shown"}));
}

TEST_F(QuestionnaireDeskTest, AFormOfTheNextBlockIsTakenAwayFromWhoGoesBackBeforeIt) {
    // Truth: invariant: it is about no trial, and comes anew before its block.
    plan_.questionnaires = {sixRatings("first", plan::Moment::BeforeBlock)};
    plan_.questionnaires[0].block = "next";
    trials_.push_back({2, 1, "next", 0, "main", 0, 1});
    person_.looks = 1;
    auto asking = desk(&person_);
    asking.remember({trials_[0], {}});
    asking.remember({trials_[1], {}});
    EXPECT_TRUE(*asking.ask(from(2), 0));
    asking.forget(trials_[1]);
    EXPECT_FALSE(*asking.ask(from(1), 0));
    EXPECT_EQ(person_.withdrawn, 1);
    asking.remember({trials_[1], {}});
    while (*asking.ask(from(2), 0)) {
    }
    EXPECT_EQ(sink_.events, (std::vector<std::string>{"questionnaire_shown", "questionnaire_shown"}));
    EXPECT_EQ(sink_.forms.size(), 1u);
}

TEST_F(QuestionnaireDeskTest, NoResponseTimeIsKeptInVirtualTime) {
    // Truth: invariant: no measured duration reaches an export of virtual time.
    auto real = desk(&person_);
    real.remember({trials_[0], {}});
    static_cast<void>(real.ask(from(1), 0));
    EXPECT_EQ(sink_.response_ms, 800);
    QuestionnaireCourse virtual_time(plan_, {"S001", 7, 1, false}, &person_, sink_);
    virtual_time.remember({trials_[0], {}});
    static_cast<void>(virtual_time.ask(from(1), 0));
    EXPECT_FALSE(sink_.response_ms);
}

TEST_F(QuestionnaireDeskTest, RefusesAnswersThatAreNotOnOffer) {
    // Truth: closed form; the words are a regression
    person_.values = {1, 2, 11, 0, 0, 0};
    auto asking = desk(&person_);
    asking.remember({trials_[0], {}});
    const auto result = asking.ask(from(1), 0);
    ASSERT_FALSE(result);
    EXPECT_EQ(toString(result.errors().front()), "error: questionnaire first: item c: must be from 0 to 10");
    person_.values = {1, 2};
    auto short_form = desk(&person_);
    short_form.remember({trials_[0], {}});
    EXPECT_FALSE(short_form.ask(from(1), 0));
    EXPECT_TRUE(sink_.scores.empty());
}

TEST_F(QuestionnaireDeskTest, FailsWhereNobodyAnswersOrNothingCanBeStored) {
    // Truth: invariant
    auto nobody = desk(nullptr);
    nobody.remember({trials_[0], {}});
    EXPECT_FALSE(nobody.ask(from(1), 0));
    sink_.full = true;
    auto asking = desk(&person_);
    asking.remember({trials_[0], {}});
    const auto full = asking.ask(from(1), 0);
    ASSERT_FALSE(full);
    EXPECT_EQ(full.errors().front().message, "the disk is full");
    plan_.questionnaires.clear();
    EXPECT_FALSE(*desk(nullptr).ask(from(1), 0)) << "without questionnaires nobody is needed";
}

}  // namespace
}  // namespace passung::session
