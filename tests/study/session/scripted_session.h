#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "study/session/session.h"

/// A session between an apparatus that plays scripts and a sink that remembers.
namespace passung::session {

using measures::Outcome;
using Records = std::vector<TickRecord>;

inline constexpr std::int64_t kMs = 1'000'000;  // [ns]

/// What the fakes saw, in one list, so that order across them can be claimed.
using Log = std::vector<std::string>;

/// Plays one script of records per trial; a tick without a record in the script is one that was lost.
class ScriptedApparatus : public Apparatus {
public:
    explicit ScriptedApparatus(Log& log) : log_(log) {}

    std::deque<Records> scripts;             // one per trial
    std::int64_t ticks_after_stop = 0;       // the loop's last ticks, still in the ring when stop() returns
    std::size_t fail_prepare_at = SIZE_MAX;  // index of the trial
    std::vector<std::uint64_t> seeds;
    std::vector<std::int64_t> trials_before;
    std::int64_t most_ticks_at_once = 0;
    std::int64_t waited_ticks = 0;
    std::optional<Presentation> given;        // by a window; none: there is none
    std::vector<std::int64_t> overlaps_from;  // first tick of the records that overlaps were to be measured by

    const DeviceDescription& device() const override { return device_; }

    Result<std::vector<StageNote>> prepare(const plan::Condition& condition, std::uint64_t seed,
                                           std::int64_t before) override {
        log_.push_back("prepare " + condition.name);
        if (seeds.size() == fail_prepare_at) return Error{"the mesh is gone", {}, 0, 0, {}, {}};
        seeds.push_back(seed);
        trials_before.push_back(before);
        return std::vector<StageNote>{{"query", "parts can touch"}};
    }
    void start() override {
        log_.push_back("start");
        script_ = scripts.front();
        scripts.pop_front();
        taken_ = 0;
        tick_ = 0;
    }
    void wait(std::int64_t ticks) override {
        waited_ticks += ticks;
        most_ticks_at_once = std::max(most_ticks_at_once, ticks);
    }
    void halt() override { log_.push_back("halt"); }
    void rearm() override { log_.push_back("rearm"); }
    void advance(std::int64_t ticks) override {
        most_ticks_at_once = std::max(most_ticks_at_once, ticks);
        tick_ += ticks;
    }
    std::size_t takeRecords(std::span<TickRecord> into) override {
        std::size_t count = 0;
        while (count < into.size() && taken_ < script_.size() && script_[taken_].tick < tick_)
            into[count++] = script_[taken_++];
        return count;
    }
    bool measureOverlaps(std::span<const TickRecord> trial, std::span<const std::vector<TickRecord>>,
                         std::span<measures::TickOverlap>) override {
        overlaps_from.push_back(trial.front().tick);
        return false;
    }
    LoopHealth stop() override {
        log_.push_back("stop");
        tick_ += ticks_after_stop;
        LoopHealth health;
        health.loop = "virtual";
        health.ticks = tick_;
        health.presentation = given;
        return health;
    }

private:
    Log& log_;
    DeviceDescription device_;
    Records script_;
    std::size_t taken_ = 0;
    std::int64_t tick_ = 0;
};

class RememberingSink : public TrialSink {
public:
    explicit RememberingSink(Log& log) : log_(&log) {}

    std::size_t fail_start_at = SIZE_MAX, fail_finish_at = SIZE_MAX;  // index of the attempt
    std::vector<AttemptStart> starts;
    std::vector<AttemptEnd> ends;
    std::vector<AttemptId> ended;  // one for each of them
    std::vector<Event> events;
    std::vector<std::pair<AttemptId, std::string>> invalidated;
    std::vector<OrderStep> steps;
    std::vector<std::string> notes;
    std::map<AttemptId, std::vector<std::int64_t>> ticks;
    std::optional<bool> complete;
    std::int64_t session_end_ns = 0;

    Result<AttemptId> startAttempt(const AttemptStart& start) override {
        log_->push_back("startAttempt");
        if (starts.size() == fail_start_at) return Error{"the database is locked", {}, 0, 0, {}, {}};
        starts.push_back(start);
        return AttemptId{static_cast<std::int64_t>(starts.size())};
    }
    void appendRecords(AttemptId attempt, std::size_t, std::span<const TickRecord> records) override {
        if (log_->back() != "appendRecords") log_->push_back("appendRecords");
        for (const TickRecord& record : records) ticks[attempt].push_back(record.tick);
    }
    void appendEvent(const Event& event) override { events.push_back(event); }
    Result<Done> finishAttempt(AttemptId attempt, const AttemptEnd& end) override {
        log_->push_back("finishAttempt");
        if (ends.size() == fail_finish_at) return Error{"the disk is full", {}, 0, 0, {}, {}};
        ends.push_back(end);
        ended.push_back(attempt);
        steps.push_back({starts.back().trial_index, end.then, end.decided_by, attempt});
        return Done{};
    }
    Result<Done> reorder(const Reordering& change) override {
        for (const AttemptId attempt : change.discounted) invalidated.emplace_back(attempt, change.reason);
        steps.insert(steps.end(), change.steps.begin(), change.steps.end());
        return Done{};
    }
    Result<Done> addNote(const std::string& author, const std::string& text, std::int64_t) override {
        notes.push_back(author + ": " + text);
        return Done{};
    }
    Result<Done> storeQuestionnaire(const QuestionnaireRun& run) override {
        log_->push_back("storeQuestionnaire " + run.form.planned.definition.key);
        return Done{};
    }
    Result<Done> finishSession(bool all, std::int64_t end_ns) override {
        log_->push_back("finishSession");
        complete = all;
        session_end_ns = end_ns;
        return Done{};
    }

private:
    Log* log_;
};

/// `count` ticks; the hand reaches the start pose at `start`, the tip rests on the bore's ground from `inserted` on.
inline Records script(std::int64_t count, std::int64_t start, std::int64_t inserted) {
    Records records(static_cast<std::size_t>(count));
    for (std::int64_t tick = 0; tick < count; ++tick) {
        TickRecord& record = records[static_cast<std::size_t>(tick)];
        record.tick = tick;
        record.hand_quaternion = {1.0f, 0.0f, 0.0f, 0.0f};
        record.hand_position_m = record.proxy_position_m = {0.0f, 0.0f, tick < inserted ? 0.1f : -0.0195f};
        if (tick >= start) record.status |= kEngaged;
        if (tick >= inserted) record.contacts = 5;
    }
    return records;
}

inline constexpr std::int64_t kNever = 1'000'000;
// Start at tick 100, inserted at 1000: the speed over 50 ticks is low from 1050 on, held for 500 ticks at 1550.
inline constexpr std::int64_t kSuccessTick = 1550;
inline Records successScript() { return script(4000, 100, 1000); }

class SessionTest : public testing::Test {
protected:
    SessionTest() {
        for (const char* name : {"soft", "hard"}) {
            plan::Condition condition;
            condition.name = name;
            condition.params_json = std::string(R"({"name":")") + name + "\"}";
            condition.task.target = "plate";
            condition.scene.parts = {
                {.name = "peg", .geometry = shape::Peg{0.02, 0.05, 0.0}, .X_WP = {}, .held = true},
                {.name = "plate", .geometry = shape::BorePlate{0.1, 0.1, 0.03, 0.0201, 0.02, 0.0}, .X_WP = {}}};
            plan_.conditions.push_back(condition);
        }
        plan_.name = "study";
        plan_.blocks.push_back({.name = "main"});
    }

    void planTrials(std::vector<Records> scripts) {
        for (std::size_t i = 0; i < scripts.size(); ++i) {
            design::PlannedTrial trial;
            trial.trial_index = static_cast<std::int64_t>(i);
            trial.block = trial.phase = "main";
            trial.condition = i % 2;
            trials_.push_back(trial);
            apparatus_.scripts.push_back(std::move(scripts[i]));
        }
    }

    Result<Done> runSession() {
        const auto listener = [this](const SessionEvent& event) {
            const auto* ended = std::get_if<AttemptEnded>(&event);
            if (ended == nullptr) return;
            log_.push_back("ended " + std::to_string(ended->finished) + "/" + std::to_string(ended->planned));
            acknowledged_.push_back(ended->id);
            EXPECT_EQ(ended->outcome, sink_.ends.back().outcome);
            trial_times_.push_back(ended->trial_time_s);
        };
        Session session({plan::FrozenPlan(plan_), trials_, "P001", 7, false}, apparatus_, sink_, listener);
        return session.run();
    }

    /// "name@ms of session time" of all events.
    std::vector<std::string> eventTimes() const {
        std::vector<std::string> result;
        for (const Event& event : sink_.events) result.push_back(event.event + "@" + std::to_string(event.t_ns / kMs));
        return result;
    }

    static std::optional<double> value(const AttemptEnd& end, const std::string& name) {
        for (const measures::Value& measure : end.measures)
            if (measure.name == name) return measure.value;
        ADD_FAILURE() << name;
        return std::nullopt;
    }

    Log log_;
    plan::StudyPlan plan_;
    std::vector<design::PlannedTrial> trials_;
    ScriptedApparatus apparatus_{log_};
    RememberingSink sink_{log_};
    std::vector<AttemptId> acknowledged_;
    std::vector<std::optional<double>> trial_times_;
};

}  // namespace passung::session
