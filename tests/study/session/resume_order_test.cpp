#include <gtest/gtest.h>

#include <string>

#include "core/base/random.h"
#include "study/session/resume.h"
#include "tests/study/session/scripted_session.h"

// A session under commands, cut off anywhere and resumed, against the same session without interruption.

namespace passung::session {
namespace {

using plan::Repeat;

/// What the experimenter does when so many attempts have ended, and how the next one goes.
struct Turn {
    std::optional<Command> before, during;  // the next attempt
    Records records;
};

/// Where the session is cut off: before or in the attempt after so many ended ones.
struct Cut {
    std::size_t turn = 0;
    bool in_trial = false;
    bool killed = true;  // else somebody ends it
};

/// Two trials of practice, four of the main block, and a staircase of two tracks that one reversal ends.
class ResumeOrderTest : public SessionTest {
protected:
    ResumeOrderTest() {
        plan_.blocks = {{.name = "practice", .phase = plan::Phase::Practice}, {.name = "main"}, {.name = "stairs"}};
        plan_.blocks[2].adaptive = true;
        for (auto& condition : plan_.conditions) condition.task.timeout = 1.2;
        plan_.first_variant = 2;
        addStaircase();
        const auto add = [&](std::size_t block, int count) {
            for (int i = 0; i < count; ++i) {
                const char* phase = block == 0 ? "practice" : block == 1 ? "main" : plan::kAdaptivePhase;
                const std::string& name = plan_.blocks[block].name;
                trials_.push_back({static_cast<std::int64_t>(trials_.size()), static_cast<std::int64_t>(block), name, i,
                                   phase, static_cast<std::size_t>(i % 2), i / 2 + 1});
            }
        };
        add(0, 2), add(1, 4), add(2, 8);
    }

    void addStaircase() {
        plan::Staircase staircase;
        staircase.name = "time";
        staircase.block = 2;
        staircase.levels = {1.0, 2.0, 3.0};
        staircase.measure = "trial_time_s";
        staircase.threshold = 0.9;
        design::AdaptiveParams params;
        params.down_after = 1;
        params.start = 2.0;
        params.low = 1.0;
        params.high = 3.0;
        params.step_down = params.step_up = 1.0;
        params.levels = staircase.levels;
        params.max_trials = 2;
        params.max_reversals = 1;
        params.skip_reversals = 0;
        staircase.tracks = {{"one", params}, {"two", params}};
        for (std::size_t base = 0; base < 2; ++base) {
            staircase.first_variant.push_back(plan_.conditions.size());
            for (int level = 0; level < 3; ++level) {
                plan_.conditions.push_back(plan_.conditions[base]);
                plan_.conditions.back().name += std::to_string(level);
            }
        }
        plan_.staircases.push_back(staircase);
    }

    static std::optional<Command> anyCommand(Random& random) {
        static constexpr CommandKind kKinds[] = {CommandKind::Repeat, CommandKind::Skip,       CommandKind::Back,
                                                 CommandKind::Stop,   CommandKind::Invalidate, CommandKind::Pause};
        if (random.below(3) != 0) return std::nullopt;
        Command command{.kind = kKinds[random.below(std::size(kKinds))], .text = "told to"};
        command.now = random.below(2) == 0;
        if (random.below(2) == 0) command.attempt = AttemptId{static_cast<std::int64_t>(1 + random.below(12))};
        return command;
    }

    /// Ends soon, late, by its time-out, or lost ticks.
    static Records anyRecords(Random& random) {
        const std::uint64_t kind = random.below(5);
        Records records = script(1600, 10, kind < 2 ? 50 : kind == 2 ? 500 : kind == 3 ? kNever : 50);
        if (kind == 4) records.erase(records.begin() + 100);
        return records;
    }

    void drawPolicies(Random& random) {
        for (plan::Block& block : plan_.blocks) {
            block.on_timeout = static_cast<Repeat>(random.below(3));
            block.on_invalid = static_cast<Repeat>(random.below(3));
            block.max_attempts = static_cast<int>(1 + random.below(3));
        }
    }

    /// Numbers of attempts are those of ended ones in the uninterrupted session: what was cut off shifts them.
    Command translated(Command command) const {
        if (command.attempt) {
            const auto wanted = static_cast<std::size_t>(*command.attempt);
            command.attempt = AttemptId{wanted <= ended_.size() ? static_cast<std::int64_t>(ended_[wanted - 1]) : 1000};
        }
        return command;
    }

    /// Goes on until the session is over (true) or cut off; `done`: the commands before this turn have been given.
    bool play(Session& session, const std::vector<Turn>& turns, const std::optional<Cut>& cut, bool done) {
        bool during_done = false;
        for (;;) {
            const std::size_t turn = ended_.size();
            if (session.isOver() || turn >= turns.size()) return true;
            if (session.state() == SessionState::Paused) static_cast<void>(session.command({CommandKind::Continue}));
            if (session.state() == SessionState::BetweenTrials && !session.agenda().empty()) {
                if (const auto& command = turns[turn].before; command && !std::exchange(done, true)) {
                    static_cast<void>(session.command(translated(*command)));
                    continue;
                }
                if (cut && cut->turn == turn && !cut->in_trial) return false;
                apparatus_.scripts = {turns[turn].records};
                during_done = false;
            }
            const std::size_t ends = sink_.ends.size();
            session.advance();
            if (session.state() == SessionState::InTrial) {
                if (cut && cut->turn == turn && cut->in_trial) return false;
                if (const auto& command = turns[turn].during; command && !std::exchange(during_done, true))
                    static_cast<void>(session.command(translated(*command)));
            }
            if (sink_.ends.size() > ends) ended_.push_back(sink_.starts.size()), done = false;
        }
    }

    SessionSetup setup() const { return {plan::FrozenPlan(plan_), trials_, "P001", 7, false}; }

    std::vector<StoredAttempt> stored() const {
        std::vector<StoredAttempt> attempts;
        for (std::size_t i = 0; i < sink_.starts.size(); ++i) {
            const AttemptStart& start = sink_.starts[i];
            const AttemptId id{static_cast<std::int64_t>(i + 1)};
            StoredAttempt attempt{id, static_cast<std::size_t>(start.trial_index), start.attempt_no, {}, false};
            for (std::size_t e = 0; e < sink_.ends.size(); ++e) {
                if (sink_.ended[e] != id) continue;
                const AttemptEnd& end = sink_.ends[e];
                attempt.outcome = end.outcome;
                attempt.valid = end.valid && std::none_of(sink_.invalidated.begin(), sink_.invalidated.end(),
                                                          [&](const auto& entry) { return entry.first == id; });
                if (end.staircase && end.staircase->positive && !start.staircase->track.empty())
                    attempt.step =
                        StoredStep{"time", start.staircase->track, start.staircase->level, *end.staircase->positive};
            }
            attempts.push_back(attempt);
        }
        return attempts;
    }

    /// Trial, outcome and whether it counts, of every attempt that was not cut off.
    std::string history() const {
        std::string text;
        for (const StoredAttempt& attempt : stored()) {
            if (std::find(ended_.begin(), ended_.end(), static_cast<std::size_t>(attempt.id)) == ended_.end()) continue;
            text +=
                std::to_string(attempt.place) + measures::outcomeName(*attempt.outcome) + (attempt.valid ? " " : "! ");
        }
        return text;
    }

    void forgetAll() {
        sink_ = RememberingSink(log_);
        ended_.clear();
    }

    std::vector<std::size_t> ended_;  // numbers of the attempts that ended and were not cut off
};

TEST_F(ResumeOrderTest, IsTheUninterruptedOneUnderAnyCommands) {
    // Truth: invariant: whatever was commanded before and comes after, wherever it is cut off and by whom.
    int cuts = 0, more = 0;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        Random random(seed);
        drawPolicies(random);
        std::vector<Turn> turns;
        for (int i = 0; i < 24; ++i) turns.push_back({anyCommand(random), anyCommand(random), anyRecords(random)});
        forgetAll();
        std::string whole;
        {
            Session session(setup(), apparatus_, sink_, {});
            ASSERT_TRUE(play(session, turns, {}, false));
            whole = history();
            more += ended_.size() > trials_.size() ? 1 : 0;
        }
        for (std::size_t first = 0; first < 24; first += 1 + random.below(3)) {
            forgetAll();
            SCOPED_TRACE("seed " + std::to_string(seed) + ", first cut after " + std::to_string(first) + " attempts");
            std::optional<Cut> cut = Cut{first};
            std::optional<Resumption> resumed;
            for (bool over = false; !over;) {
                cut->in_trial = random.below(2) == 0;
                cut->killed = random.below(3) != 0;
                const bool goes_on = resumed.has_value();
                SessionSetup part = setup();
                part.resumed = std::exchange(resumed, std::nullopt);
                Session session(std::move(part), apparatus_, sink_, {});
                over = play(session, turns, cut, goes_on);
                if (over) break;
                ++cuts;
                if (!cut->killed) session.interrupt("by somebody");
                resumed = resumption(plan_, trials_, stored(), cut->killed, {}, sink_.steps);
                ASSERT_TRUE(sink_.reorder(resumed->change));
                cut->turn += random.below(3);  // maybe the same once more
            }
            EXPECT_EQ(history(), whole);
        }
        if (HasFailure()) return;
    }
    EXPECT_GT(cuts, 400);
    EXPECT_GT(more, 2) << "sessions that repeat trials";
}

}  // namespace
}  // namespace passung::session
