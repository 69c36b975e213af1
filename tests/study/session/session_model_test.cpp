#include <array>
#include <map>
#include <set>

#include "core/base/random.h"
#include "study/session/resume.h"
#include "tests/study/session/scripted_session.h"

// Random commands, answers and kills against sessions whose data is all that a kill leaves.

namespace passung::session {
namespace {

using Kind = CommandKind;

constexpr std::int64_t kCommands = 100'000;
constexpr std::size_t kKinds = std::size(kCommandNames);

/// What the program dies of.
struct Killed {};

/// Kills at one of the next moments at which data is written, once it is lit.
class Fuse {
public:
    void light(std::uint64_t moments) { left_ = moments; }
    void burn() {
        if (left_ > 0 && --left_ == 0) throw Killed();
    }

private:
    std::uint64_t left_ = 0;
};

/// Trials of a few looks: every tick is engaged, some are lost.
class FastApparatus : public Apparatus {
public:
    FastApparatus(Random& random, Fuse& fuse) : random_(random), fuse_(fuse) {}

    bool runs = false, halted = false;

    const DeviceDescription& device() const override { return device_; }
    Result<std::vector<StageNote>> prepare(const plan::Condition&, std::uint64_t, std::int64_t) override {
        fuse_.burn();
        return std::vector<StageNote>{};
    }
    void wait(std::int64_t) override {}
    void start() override {
        EXPECT_FALSE(halted) << "nothing moves before the continuation";
        runs = true;
        tick_ = taken_ = 0;
        lost_ = random_.below(8) == 0 ? 30 : -1;
    }
    void advance(std::int64_t ticks) override { tick_ += halted ? 0 : ticks; }
    std::size_t takeRecords(std::span<TickRecord> into) override {
        std::size_t count = 0;
        for (; count < into.size() && taken_ < tick_; ++taken_) {
            if (taken_ == lost_) continue;
            TickRecord& record = into[count++];
            record = {};
            record.tick = taken_;
            record.hand_quaternion = {1.0f, 0.0f, 0.0f, 0.0f};
            record.hand_position_m = record.proxy_position_m = {0.0f, 0.0f, 0.1f};
            record.status = taken_ > 2 ? kEngaged : 0u;
        }
        return count;
    }
    LoopHealth stop() override {
        runs = false;
        LoopHealth health;
        health.ticks = std::max<std::int64_t>(tick_, 1);  // the one that has begun
        return health;
    }
    void halt() override { halted = true; }
    void rearm() override { halted = false; }

private:
    Random& random_;
    Fuse& fuse_;
    DeviceDescription device_;
    std::int64_t tick_ = 0, taken_ = 0, lost_ = -1;
};

/// What is durable of a session, and what must never happen to it.
class DurableSink : public TrialSink {
public:
    DurableSink(Fuse& fuse, std::size_t places) : attempts_of(places), skipped(places), fuse_(fuse) {}

    struct Kept {
        AttemptStart start;
        std::optional<AttemptEnd> end;
        bool discounted = false;
        bool counts() const { return end && end->valid && !discounted; }
    };
    std::vector<Kept> attempts;  // by number - 1
    std::vector<std::vector<std::size_t>> attempts_of;
    std::vector<bool> skipped;  // by place: left out between two trials
    std::vector<OrderStep> steps;
    std::map<std::string, std::pair<std::int64_t, std::int64_t>> forms;  // session time, changes until then
    std::vector<Event> commands;
    std::int64_t notes = 0, latest_ns = 0;
    std::int64_t changes = 0;  // attempts begun, and changes of the order
    std::optional<bool> complete;

    const Kept* counting(std::size_t place) const {
        const Kept* found = nullptr;
        for (const std::size_t i : attempts_of[place]) {
            if (!attempts[i].counts()) continue;
            EXPECT_EQ(found, nullptr) << "two attempts of a trial count";
            found = &attempts[i];
        }
        return found;
    }

    Result<AttemptId> startAttempt(const AttemptStart& start) override {
        fuse_.burn();
        const auto place = static_cast<std::size_t>(start.trial_index);
        EXPECT_EQ(start.attempt_no, static_cast<int>(attempts_of[place].size()) + 1);
        EXPECT_EQ(counting(place), nullptr) << "a trial that is done is done again";
        for (std::size_t earlier = 0; earlier < place && start.attempt_no == 1; ++earlier)
            EXPECT_TRUE(!attempts_of[earlier].empty() || skipped[earlier]) << "the order of trials";
        attempts_of[place].push_back(attempts.size());
        attempts.push_back({start, {}});
        // An attempt takes at least a period. Of a form and an attempt of the same session time nobody could tell which
        // came first.
        seen(start.start_ns + kTickNanoseconds);
        ++changes;
        fuse_.burn();
        return AttemptId{static_cast<std::int64_t>(attempts.size())};
    }
    void appendRecords(AttemptId, std::size_t, std::span<const TickRecord>) override {}
    void appendEvent(const Event& event) override {
        fuse_.burn();
        if (event.event.starts_with("command_")) commands.push_back(event);
        seen(event.t_ns);
    }
    Result<Done> finishAttempt(AttemptId attempt, const AttemptEnd& end) override {
        fuse_.burn();
        Kept& kept = attempts.at(static_cast<std::size_t>(attempt) - 1);
        EXPECT_FALSE(kept.end) << "an attempt ends once";
        kept.end = end;
        steps.push_back({kept.start.trial_index, end.then, end.decided_by, attempt});
        seen(end.end_ns);
        fuse_.burn();
        return Done{};
    }
    Result<Done> storeQuestionnaire(const QuestionnaireRun& run) override {
        fuse_.burn();
        forms[run.form.id()] = {run.completed_ns, changes};
        seen(run.completed_ns);
        fuse_.burn();
        return Done{};
    }
    Result<Done> reorder(const Reordering& change) override {
        fuse_.burn();
        for (const AttemptId id : change.discounted) {
            Kept& kept = attempts.at(static_cast<std::size_t>(id) - 1);
            EXPECT_TRUE(kept.counts()) << "an attempt is discounted once";
            kept.discounted = true;
        }
        for (const OrderStep& step : change.steps)
            if (!step.attempt && step.then == Then::Done) skipped[static_cast<std::size_t>(step.trial_index)] = true;
        steps.insert(steps.end(), change.steps.begin(), change.steps.end());
        if (!change.steps.empty() || !change.discounted.empty()) ++changes;
        fuse_.burn();
        return Done{};
    }
    Result<Done> addNote(const std::string&, const std::string&, std::int64_t) override {
        fuse_.burn();
        ++notes;
        return Done{};
    }
    Result<Done> finishSession(bool whole, std::int64_t) override {
        fuse_.burn();
        complete = whole;
        fuse_.burn();
        return Done{};
    }

private:
    void seen(std::int64_t t_ns) { latest_ns = std::max(latest_ns, t_ns); }

    Fuse& fuse_;
};

/// Answers, reads on and rests enough at one of two looks.
class Person : public QuestionnaireSource, public InstructionReader {
public:
    Person(Random& random, const DurableSink& sink) : random_(random), sink_(sink) {}

    std::int64_t answers = 0;

    std::optional<FilledForm> fill(const ShownQuestionnaire& form) override {
        const auto stored = sink_.forms.find(form.id());
        if (stored != sink_.forms.end()) {
            EXPECT_LT(stored->second.second, sink_.changes) << "is asked again: " << form.id();
        }
        if (random_.below(2) == 0) return std::nullopt;
        ++answers;
        return FilledForm{{ItemAnswer{{1.0, ""}, {}, 0}}, "participant"};
    }
    std::optional<PageRead> read(const Page&) override {
        if (random_.below(2) == 0) return std::nullopt;
        ++answers;
        return PageRead{"participant", {}};
    }
    bool goesOn() override { return random_.below(2) == 0; }

private:
    Random& random_;
    const DurableSink& sink_;
};

class SessionModel : public SessionTest {
protected:
    SessionModel() {
        plan_.conditions.push_back(plan_.conditions[0]);
        for (auto& condition : plan_.conditions) condition.task.timeout = 0.06;
        plan_.conditions[0].timed_by = plan::TimedBy::Clock;         // succeeds
        plan_.conditions[2].timed_by = plan::TimedBy::Experimenter;  // as they say, else it times out like 1
        plan_.conditions[0].device = plan_.conditions[1].device = "arm";
        plan_.conditions[2].device = "stick";
        plan_.blocks = {
            {.name = "practice", .phase = plan::Phase::Practice}, {.name = "first"}, {.name = "second", .rest = 0.25}};
        for (std::size_t block = 0; block < 3; ++block)
            for (int i = 0; i < (block == 0 ? 2 : 4); ++i) {
                design::PlannedTrial trial;
                trial.trial_index = static_cast<std::int64_t>(trials_.size());
                trial.block_index = static_cast<std::int64_t>(block);
                trial.block = plan_.blocks[block].name;
                trial.trial_in_block = i;
                trial.phase = block == 0 ? "practice" : "main";
                trial.condition = (block + static_cast<std::size_t>(i)) % 3;
                trials_.push_back(trial);
            }
        for (const auto moment : {plan::Moment::AfterTrial, plan::Moment::AfterBlock, plan::Moment::SessionEnd}) {
            plan::PlannedQuestionnaire planned;
            planned.moment = moment;
            planned.definition.key = plan::momentName(moment);
            planned.definition.items.resize(1);
            planned.definition.items[0].response.high = 10.0;
            plan_.questionnaires.push_back(planned);
        }
        plan_.instructions = {{plan::ShowAt::SessionStart, "", "welcome", ""},
                              {plan::ShowAt::BeforeBlock, "second", "noise", ""},
                              {plan::ShowAt::SessionEnd, "", "thanks", ""}};
    }

    /// Another participant, in a study of other policies.
    void beginParticipant() {
        for (plan::Block& block : plan_.blocks) {
            block.on_timeout = static_cast<plan::Repeat>(random_.below(3));
            block.on_invalid = static_cast<plan::Repeat>(random_.below(3));
            block.on_failure = static_cast<plan::Repeat>(random_.below(3));
            block.max_attempts = static_cast<int>(1 + random_.below(3));
            block.rest_ends = static_cast<plan::RestEnds>(random_.below(3));
        }
        session_.reset();
        durable_.emplace(fuse_, trials_.size());
        person_.emplace(random_, *durable_);
        waits_ = random_.below(2) == 0;
        beginSession({});
        ++participants_;
    }

    void beginSession(std::optional<Resumption> resumed) {
        SessionSetup setup{plan::FrozenPlan(plan_), trials_, "P001", 7, false};
        setup.waits = waits_;
        setup.answers = &*person_;
        setup.reader = &*person_;
        setup.resumed = std::move(resumed);
        apparatus_.rearm();  // a new one
        const auto listener = [this](const SessionEvent& event) {
            if (const auto* view = std::get_if<SessionView>(&event)) prepared_ = *view;
            const auto* ended = std::get_if<AttemptEnded>(&event);
            if (ended == nullptr) return;
            const auto& kept = durable_->attempts.at(static_cast<std::size_t>(ended->id) - 1);
            ASSERT_TRUE(kept.end) << "is told of before it is durable";
            EXPECT_EQ(kept.end->outcome, ended->outcome);
        };
        session_.emplace(std::move(setup), apparatus_, *durable_, listener);
    }

    std::vector<StoredAttempt> stored() const {
        std::vector<StoredAttempt> attempts;
        for (std::size_t i = 0; i < durable_->attempts.size(); ++i) {
            const DurableSink::Kept& kept = durable_->attempts[i];
            StoredAttempt attempt{AttemptId{static_cast<std::int64_t>(i + 1)},
                                  static_cast<std::size_t>(kept.start.trial_index),
                                  kept.start.attempt_no,
                                  {},
                                  kept.counts()};
            attempt.start_ns = kept.start.start_ns;
            if (kept.end) attempt.outcome = kept.end->outcome, attempt.measures = kept.end->measures;
            attempts.push_back(attempt);
        }
        return attempts;
    }

    /// From the data alone, as often as it takes: the program may be killed in this as well.
    void resume(bool crashed) {
        session_.reset();
        EXPECT_FALSE(apparatus_.runs) << "motors stay on behind a session that is gone";
        std::vector<StoredForm> forms;
        for (const auto& [id, stored] : durable_->forms) forms.push_back({id, stored.first});
        for (;;) try {
                Resumption resumed = resumption(plan_, trials_, stored(), crashed, forms, durable_->steps);
                resumed.start_ns = durable_->latest_ns;
                ASSERT_TRUE(durable_->reorder(resumed.change));
                return beginSession(std::move(resumed));
            } catch (const Killed&) {
                crashed = true;
            }
    }

    /// Kills the session between two of its steps: it goes on with the same trials in the same order.
    void kill() {
        ++kills_;
        const Agenda before = session_->agenda();
        resume(true);
        expectSame(before);
    }

    void expectSame(const Agenda& before) const {
        const Agenda& now = session_->agenda();
        if (before.empty()) {  // what a whole session lacks is offered again
            for (const design::PlannedTrial& trial : now.remaining())
                EXPECT_EQ(durable_->counting(static_cast<std::size_t>(trial.trial_index)), nullptr);
            return;
        }
        EXPECT_EQ(now.remaining(), before.remaining());
        EXPECT_EQ(now.over(), before.over());
    }

    Command anyCommand() {
        // Back and Abort undo and end much, Continue and Start go on.
        static constexpr std::array kDrawn = {Kind::Start, Kind::Start,  Kind::Start,      Kind::Pause, Kind::Continue,
                                              Kind::Done,  Kind::Done,   Kind::Failed,     Kind::Note,  Kind::Continue,
                                              Kind::Stop,  Kind::Repeat, Kind::Invalidate, Kind::Skip,  Kind::Continue};
        Command command{.kind = kDrawn[random_.below(kDrawn.size())], .text = "so"};
        if (random_.below(30) == 0) command.kind = Kind::Back;
        if (random_.below(300) == 0) command.kind = Kind::Abort;
        if (random_.below(8) == 0) command.text.clear();
        command.now = random_.below(4) == 0;
        if (command.kind == Kind::Invalidate && random_.below(2) == 0)
            command.attempt = AttemptId{static_cast<std::int64_t>(1 + random_.below(durable_->attempts.size() + 2))};
        return command;
    }

    void tell() {
        const Command command = anyCommand();
        const SessionView before = session_->view();
        const Agenda agenda = session_->agenda();
        const Permission may = session_->permission(command);
        if (!command.attempt && !command.now && !command.text.empty()) {
            EXPECT_EQ(may, before.permission(command.kind));
        }
        trace(std::string(commandName(command.kind)) + (may.given() ? "" : " (refused: " + may.text + ")"));
        const std::size_t logged = durable_->commands.size();
        const std::int64_t changes = durable_->changes, notes = durable_->notes;
        const Reply answer = session_->command(command);
        ++told_[static_cast<std::size_t>(command.kind)][answer.accepted ? 1 : 0];
        EXPECT_EQ(answer.accepted, may.given()) << answer.text;
        EXPECT_EQ(answer.why, may.why);
        ASSERT_EQ(durable_->commands.size(), logged + 1);
        EXPECT_EQ(durable_->commands.back().payload_json.find(R"("accepted":true)") != std::string::npos,
                  answer.accepted);
        if (!answer.accepted) {
            EXPECT_EQ(answer.text, may.text);
            EXPECT_EQ(session_->view(), before) << "a refused command changes nothing";
            EXPECT_EQ(durable_->changes, changes);
            EXPECT_EQ(durable_->notes, notes);
            return;
        }
        expectDeed(command, may, before, agenda);
        if (command.kind == Kind::Abort) return resumeAborted(agenda);
    }

    /// What an accepted command has done at once.
    void expectDeed(const Command& command, const Permission& may, const SessionView& before, const Agenda& agenda) {
        const SessionView now = session_->view();
        const bool in_trial = before.state == SessionState::InTrial;
        const bool later = in_trial && command.kind == Kind::Invalidate;  // of the running attempt: at its end
        if (may.attempt && !later) {
            EXPECT_FALSE(durable_->attempts.at(static_cast<std::size_t>(*may.attempt) - 1).counts());
        }
        switch (command.kind) {
            case Kind::Repeat:
                EXPECT_EQ(now.next, in_trial ? before.next : agenda.last());
                break;
            case Kind::Back:
                EXPECT_EQ(now.next, agenda.last());
                break;
            case Kind::Skip:
                EXPECT_TRUE(now.over[*before.next]);
                break;
            case Kind::Pause:
                EXPECT_TRUE(in_trial && !command.now ? now.pauses_after : now.state == SessionState::Paused);
                break;
            case Kind::Stop:
                EXPECT_EQ(now.state, SessionState::Paused);
                EXPECT_TRUE(apparatus_.halted && !apparatus_.runs);
                break;
            case Kind::Continue:
                EXPECT_EQ(now.state, SessionState::BetweenTrials);
                EXPECT_FALSE(apparatus_.halted);
                break;
            case Kind::Abort:
                EXPECT_TRUE(session_->isOver());
                break;
            case Kind::Start:
            case Kind::Done:
            case Kind::Failed:
                EXPECT_FALSE(now.permission(command.kind).given()) << "once";
                break;
            case Kind::Invalidate:
            case Kind::Note:
                break;
        }
    }

    /// Somebody has ended the session; half of them come again.
    void resumeAborted(const Agenda& agenda) {
        if (session_->state() == SessionState::Complete || random_.below(2) == 0) return;
        durable_->complete.reset();
        resume(false);
        expectSame(agenda);
    }

    void advance() {
        const SessionState before = session_->state();
        session_->advance();
        if (before == SessionState::BetweenTrials && session_->state() == SessionState::InTrial) {
            const SessionView now = session_->view();
            EXPECT_EQ(prepared_.next, now.next);
            for (std::size_t kind = 0; kind < kKinds; ++kind) {
                const Kind each = static_cast<Kind>(kind);
                const bool of_clock = each == Kind::Start || each == Kind::Done || each == Kind::Failed;
                if (of_clock) continue;  // runs not before the trial
                EXPECT_EQ(prepared_.commands[kind].why, now.commands[kind].why) << kCommandNames[kind];
            }
        }
    }

    /// What holds between any two steps.
    void expectSound() const {
        const SessionView view = session_->view();
        for (std::size_t place = 0; place < trials_.size(); ++place)
            if (durable_->counting(place) != nullptr) {
                EXPECT_TRUE(view.over[place]) << "what is finished is lost: trial " << place + 1;
            }
        EXPECT_EQ(apparatus_.runs, view.state == SessionState::InTrial);
        EXPECT_EQ(view.permission(Kind::Continue).given(), view.state == SessionState::Paused);
        EXPECT_EQ(view.permission(Kind::Stop).given(), !session_->isOver());
        EXPECT_EQ(view.permission(Kind::Skip).given(), !session_->isOver() && view.next.has_value());
        const bool any_over = std::find(view.over.begin(), view.over.end(), true) != view.over.end();
        EXPECT_EQ(view.permission(Kind::Back).given(), !session_->isOver() && any_over);
        EXPECT_EQ(view.pauses_after, view.permission(Kind::Pause).why == WhyNot::PausesAlready);
        EXPECT_EQ(view.stopped, apparatus_.halted && !session_->isOver());
        const bool between = view.state == SessionState::BetweenTrials || view.state == SessionState::Paused;
        EXPECT_TRUE(between || !view.rest);
    }

    void expectWhole() const {
        EXPECT_EQ(session_->state(), SessionState::Complete);
        EXPECT_TRUE(session_->agenda().empty());
        bool whole = true;
        for (std::size_t place = 0; place < trials_.size(); ++place)
            whole = whole && (trials_[place].phase != "main" || durable_->counting(place) != nullptr);
        EXPECT_EQ(session_->isWhole(), whole);
        EXPECT_EQ(durable_->complete, whole);
    }

    void step() {
        const std::uint64_t what = random_.below(100);
        if (what < 2) {
            trace("killed");
            kill();
        } else if (what < 4) {
            fuse_.light(1 + random_.below(12));
        } else if (what < 50) {
            tell();
        } else {
            advance();
        }
    }

    void trace(std::string what) {
        trace_.push_back(std::move(what) + ", trial " + std::to_string(session_->view().next.value_or(99) + 1));
        if (trace_.size() > 12) trace_.pop_front();
    }
    std::string traced() const {
        std::string text;
        for (const std::string& line : trace_) text += line + "\n";
        return text;
    }
    std::int64_t told() const {
        std::int64_t sum = 0;
        for (const auto& [refused, accepted] : told_) sum += refused + accepted;
        return sum;
    }

    Random random_{18};
    Fuse fuse_;
    FastApparatus apparatus_{random_, fuse_};
    std::optional<DurableSink> durable_;
    std::optional<Person> person_;
    std::optional<Session> session_;
    SessionView prepared_;
    bool waits_ = false;
    std::array<std::array<std::int64_t, 2>, kKinds> told_{};  // by kind: refused, accepted
    std::int64_t kills_ = 0, participants_ = 0, whole_ = 0, answers_ = 0;
    std::deque<std::string> trace_;
};

TEST_F(SessionModel, ViewAndSessionAgreeAndNothingFinishedIsLostUnderAnyCommandsAndKills) {
    // Truth: invariant. A kill leaves what the sink holds, also in the middle of a step.
    while (told() < kCommands && !HasFailure()) {
        beginParticipant();
        while (!session_->isOver() && told() < kCommands && !HasFailure()) {
            try {
                step();
                expectSound();
            } catch (const Killed&) {
                ++kills_;
                trace("killed inside");
                if (durable_->complete) break;  // of a session that is closed
                resume(true);
                expectSound();
            }
        }
        fuse_.light(0);
        answers_ += person_->answers;
        if (session_->state() != SessionState::Complete) continue;
        ++whole_;
        expectWhole();
    }
    ASSERT_FALSE(HasFailure()) << "participant " << participants_ << ", after\n" << traced();
    EXPECT_GT(kills_, 4000);
    EXPECT_GT(answers_, 4000);
    EXPECT_GT(whole_, 100) << "sessions to their end";
    for (std::size_t kind = 0; kind < kKinds; ++kind) {
        EXPECT_GT(told_[kind][1], 50) << kCommandNames[kind] << " accepted";
        const Kind each = static_cast<Kind>(kind);
        if (each == Kind::Abort || each == Kind::Stop) continue;  // of a session that is not over never
        EXPECT_GT(told_[kind][0], 50) << kCommandNames[kind] << " refused";
    }
}

}  // namespace
}  // namespace passung::session
