#include "ui/window/live_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <exception>
#include <filesystem>
#include <utility>

#include "devices/mouse/mouse_device.h"
#include "study/plan/scene_parts.h"
#include "study/run/units/station_devices.h"
#include "study/session/secondary.h"

namespace passung::window {

namespace {

constexpr const char* kWindow = "window";  // that gives a command by itself

sound::SoundPlan soundOf(const plan::Condition& condition, std::uint64_t seed) {
    const plan::Cues& cues = condition.cues;
    sound::SoundPlan plan;
    plan.cues = {.sound = cues.audio,
                 .full_speed = cues.full_speed,
                 .sound_decay = cues.sound_decay,
                 .masking = cues.masking_noise};
    if (condition.secondary.stimulus == plan::Stimulus::Audio)
        plan.stimulus = session::detectionSettings(condition.secondary);
    plan.seed = seed;
    return plan;
}

presenter::TrialBrief briefOf(const plan::Condition& condition) {
    presenter::TrialBrief brief;
    brief.kind = static_cast<presenter::TrialBrief::Kind>(condition.task.form.index());
    if (const auto* pair = std::get_if<plan::DiscriminationPairTask>(&condition.task.form))
        brief.question = pair->question;
    brief.timed_by = condition.timed_by;
    brief.result = condition.result;
    if (condition.scene.effects.picks()) {
        const scene::Pick& pick = condition.scene.effects.pick;
        brief.pick_button = pick.button;
        brief.undo_button = pick.undo_button;
        brief.pick_on_press = pick.on_press;
    }
    return brief;
}

}  // namespace

LiveSession::LiveSession(plan::StudyPlan plan, LiveOptions options)
    : plan_(std::move(plan)), options_(std::move(options)) {
    if (options_.sound != nullptr) screens_.push_back(&options_.sound->ring());
    thread_ = std::thread([this] { main(); });
}

LiveSession::~LiveSession() { end(); }

void LiveSession::end() {
    ends_.store(true);
    if (thread_.joinable()) thread_.join();
}

void LiveSession::main() {
    bool whole = false;
    const auto listener = [&](const session::SessionEvent& event) {
        if (const auto* view = std::get_if<session::SessionView>(&event)) return show(*view);
        if (const auto* over = std::get_if<session::SessionOver>(&event)) whole = over->whole;
        tell(event);
    };
    Errors errors;
    try {
        std::error_code problem;  // shows when the database is opened
        const auto folder = std::filesystem::path(options_.database).parent_path();
        if (!folder.empty()) std::filesystem::create_directories(folder, problem);
        const auto end = perform(listener);
        if (!end && !aborted_) errors = end.errors();
    } catch (const std::exception& thrown) {
        errors.push_back({.message = thrown.what()});
    }
    if (cancelled_) errors.clear();  // that is what was asked for
    over();                          // also of a session that an exception ended
    tell(presenter::RunOver{whole, errors});
}

Result<run::RunEnd> LiveSession::perform(const session::SessionListener& listener) {
    run::RunOptions run;
    run.database = options_.database;
    run.participant = options_.participant;
    run.station = options_.station;
    run.clock = run::Clock::RealTime;
    run.backup = !options_.try_out;
    run.choice.trials_only = options_.try_out;
    run.wait = options_.waits;
    run.performer = this;
    if (!options_.try_out) run.language = options_.language;
    run.experimenter = options_.experimenter;
    run.warns = true;
    run::StudyLog log(run.database, "passung-window",
                      [this](const std::string& problem) { tell(session::Warned{problem}); });
    run.log = &log;
    run.interrupted = [this] { return ends_.load(); };
    if (!options_.try_out && kind() != plan::ParticipantKind::Simulated)
        run.ask_consent = [this](const auto& clause, const std::string& text) { return askConsent(clause, text); };
    if (options_.hand == LiveHand::Mouse && !options_.try_out) {  // in whose place a real device is held
        auto real = run::stationDevices({});
        if (!real) return real.errors();
        run.real = *std::move(real);
    }
    if (options_.resume.empty()) return run::runStudy(plan_, run, listener);
    const auto folder = std::filesystem::path(plan_.source_path).parent_path();
    return run::resumeStudy({options_.resume, folder.string()}, run, listener);
}

std::optional<bool> LiveSession::askConsent(const plan::ConsentClause& clause, const std::string& text) {
    show(session::viewBeforeSession());
    return interview_.consent(clause, text, [this] { return ends_.load() || takesAbort(); });
}

/// Before the session begins it cannot take commands itself: only that it shall not.
bool LiveSession::takesAbort() {
    std::deque<session::Command> commands;
    {
        const std::lock_guard lock(mutex_);
        commands.swap(commands_);
    }
    for (const session::Command& command : commands) {
        const session::Permission permission = session::viewBeforeSession().permission(command.kind);
        aborted_ = aborted_ || permission.given();
        session::Reply answer{permission.given(), "the session does not begin"};
        if (!permission.given()) answer = {false, permission.text, permission.why};
        tell(presenter::CommandAnswered{command, std::move(answer)});
    }
    return aborted_;
}

void LiveSession::command(session::Command command) {
    const std::lock_guard lock(mutex_);
    if (command.kind == session::CommandKind::Stop && apparatus_ != nullptr) apparatus_->halt();
    commands_.push_back(std::move(command));
}

std::vector<presenter::News> LiveSession::takeNews() {
    const std::lock_guard lock(mutex_);
    return std::exchange(news_, {});
}

void LiveSession::tell(presenter::News news) {
    const std::lock_guard lock(mutex_);
    news_.push_back(std::move(news));
}

plan::ParticipantKind LiveSession::kind() const {
    if (options_.hand == LiveHand::Simulated) return plan::ParticipantKind::Simulated;
    return plan::kindOfCode(options_.participant).value_or(options_.kind);
}

DeviceDescription LiveSession::describe(const simulated::DeviceParams& preset) const {
    return options_.hand == LiveHand::Mouse ? mouse::mouseDescription(preset) : simulated::describe(preset);
}

std::unique_ptr<loop::HapticDevice> LiveSession::device(const simulated::DeviceParams& preset,
                                                        const plan::Condition& condition) {
    if (options_.hand != LiveHand::Mouse) return nullptr;
    const scene::Registration& r = condition.scene.registration;
    const simulated::HandRegistration registration{r.X_WB, r.scale, r.X_DH};
    const Pose start = plan::startPose(condition.scene, 0);
    auto device = std::make_unique<mouse::MouseDevice>(preset, registration, start, pointer_);
    reach_.store(device->reach() * r.scale);
    swing_.store(device->swing());
    return device;
}

void LiveSession::begins(session::Apparatus& apparatus, const session::SessionSetup& setup) {
    interview_.forget();
    appearance_ = setup.plan->view;
    presenter::SessionBegun begun{.participant = setup.participant, .trials = setup.trials, .appearance = appearance_};
    if (setup.resumed) {
        begun.earlier = setup.resumed->earlier;
        begun.quality = setup.resumed->quality;
    }
    tell(std::move(begun));
    const std::lock_guard lock(mutex_);
    apparatus_ = &apparatus;
}

void LiveSession::prepares(const plan::Condition& condition, std::int64_t trial_index, std::uint64_t seed) {
    const sound::SoundPlan heard = soundOf(condition, seed);
    if (options_.sound != nullptr) options_.sound->plan(heard);
    shown_ = {};
    shown_.cue_frames = 0;
    shown_.drawn_pose = condition.shown == plan::ShownPose::Proxy ? "proxy" : "device";
    if (heard.any()) shown_.sound = "silent";
    interview_.forget();
    takePictures();  // what is left of the attempt before
    pictures_.clear();
    if (options_.frames != nullptr) attempt_ = options_.frames->expect();
    presenter::AttemptPrepared prepared{trial_index, condition.name, nullptr, briefOf(condition), attempt_};
    prepared.brief.sound = heard.any();
    if (auto scene = artist_.draw(condition, appearance_))
        prepared.scene = *scene;  // else the session fails at the same mesh
    tell(std::move(prepared));
}

bool LiveSession::builds(double share) {
    tell(presenter::BuildProgress{share});
    const std::lock_guard lock(mutex_);
    cancelled_ = ends_.load() || std::any_of(commands_.begin(), commands_.end(), [](const session::Command& command) {
                     return command.kind == session::CommandKind::Abort;
                 });
    return !cancelled_;
}

/// What has changed of it reaches the windows.
void LiveSession::show(session::SessionView view) {
    if (told_ == view) return;
    told_ = view;
    tell(std::move(view));
}

void LiveSession::betweenSteps(session::Session& session) {
    // Here and not with the pictures: how far a held key goes must not depend on how fast they come.
    const std::int64_t now = run::steadyNanoseconds();
    if (looked_ns_ > 0) pointer_.pass(1e-9 * static_cast<double>(now - looked_ns_));
    looked_ns_ = now;
    std::deque<session::Command> commands;
    std::optional<presenter::QualityFound> found;
    {
        const std::lock_guard lock(mutex_);
        commands.swap(commands_);
        found.swap(found_);
    }
    if (found) session.drawsWith(*found);
    for (const session::Command& command : commands) {
        // The same press comes twice: from the X server at once, and from the window as soon as it is alive.
        if (command.kind == session::CommandKind::Stop && session.view().stopped) continue;
        session::Reply answer = session.command(command);
        if (command.source != kWindow) tell(presenter::CommandAnswered{command, std::move(answer)});
    }
    takePictures();
    show(session.view());
}

void LiveSession::drawsWith(const presenter::QualityFound& found) {
    const std::lock_guard lock(mutex_);
    found_ = found;
}

/// Does a command ask for what cannot wait for a picture? Such a trial is begun and ended at once.
bool LiveSession::isWanted() {
    const std::lock_guard lock(mutex_);
    return std::any_of(commands_.begin(), commands_.end(), [](const session::Command& command) {
        using session::CommandKind;
        const bool later = command.kind == CommandKind::Note || command.kind == CommandKind::Start ||
                           command.kind == CommandKind::Done || command.kind == CommandKind::Failed ||
                           (command.kind == CommandKind::Pause && !command.now);
        return !later;
    });
}

void LiveSession::awaitPicture() {
    if (options_.frames == nullptr) return;
    while (!options_.frames->hasShown(attempt_) && !ends_.load() && !isWanted())
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    looked_ns_ = 0;  // a key that is held moves nothing while nobody looks
}

void LiveSession::takePictures() {
    if (options_.frames == nullptr) return;
    std::array<run::Picture, 64> pictures;
    while (const std::size_t count = options_.frames->takePictures(pictures))
        pictures_.insert(pictures_.end(), pictures.begin(), pictures.begin() + static_cast<std::ptrdiff_t>(count));
}

std::optional<session::Presentation> LiveSession::presented(std::int64_t zero_ns, std::int64_t from_ns,
                                                            std::int64_t to_ns) {
    session::Presentation shown = shown_;
    takePictures();
    const run::PictureTimes times = run::timesBetween(pictures_, zero_ns, from_ns, to_ns);
    const auto& ages = times.ages_ns;
    const auto quantile = [&](double q) {  // the smallest age that so many do not exceed
        const double rank = std::max(1.0, std::ceil(q * static_cast<double>(ages.size())));
        return 1e-3 * static_cast<double>(ages[static_cast<std::size_t>(rank) - 1]);
    };
    if (!ages.empty()) {
        shown.frames = static_cast<std::int64_t>(ages.size());
        shown.cue_frames = times.cued;
        shown.frame_age_median_us = quantile(0.5);
        shown.frame_age_p99_us = quantile(0.99);
    }
    if (options_.frames != nullptr) shown.frame_age_max_us = 1e-3 * static_cast<double>(times.oldest_ns);
    const auto output = options_.sound == nullptr ? std::nullopt : options_.sound->output();
    if (shown.sound == "silent" && output) {
        shown.sound = "played";
        shown.sound_output = output->name;
        shown.sound_delay_us = output->delay_us;
    }
    return shown;
}

void LiveSession::over() {
    if (options_.sound != nullptr) options_.sound->plan({});
    const std::lock_guard lock(mutex_);
    apparatus_ = nullptr;
}

}  // namespace passung::window
