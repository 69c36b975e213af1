#include <gtest/gtest.h>

#include <QtGui/QColor>
#include <QtTest/QSignalSpy>
#include <array>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <variant>

#include "core/import/mesh_import.h"
#include "core/shape/shape.h"
#include "study/protocol/protocol_reader.h"
#include "study/run/files/known_names.h"
#include "study/run/run_study.h"
#include "study/store/read/store_reader.h"
#include "tests/support/length.h"
#include "tests/ui/cli/small_study.h"
#include "tests/ui/window/four_trials.h"
#include "tests/ui/window/ray_caster.h"
#include "tests/ui/window/windows.h"
#include "ui/presenter/drawn_scene.h"

// What a participant saw, beside what the protocol and the recorded ticks say: sessions in virtual time are shown in
// order in the real windows, and a ray caster of our own says which part each pixel has to show.

namespace passung::test {
namespace {

namespace state = presenter::state;

constexpr double kFine = 5e-6;    // chord error of shapes as the oracle has them [m]
constexpr int kManyPixels = 400;  // a part with more is compared by its area
constexpr double kLeastOverlap = 0.97;
constexpr double kHueError = 0.02;

// The colours that protocols/KEYS.md promises: amber, and vermilion with the cue at 1.
const QColor kHeldDark("#f0b34a"), kHeldLight("#e8a02c"), kHit("#d52e00");

/// As Scene3D colours parts where it is to tell them apart.
QColor identity(int part) { return QColor::fromHsvF(static_cast<float>(std::fmod(0.11 + 0.381966 * part, 1.0)), 1, 1); }

double hueDistance(double a, double b) {
    const double d = std::abs(a - b);
    return std::min(d, 1.0 - d);
}

/// What was to be seen at one moment.
struct Moment {
    const plan::Condition* condition = nullptr;
    std::optional<TickRecord> tick;  // none: the attempt has not begun
    bool in_trial = false;           // the start pose was reached, and the trial is not over
    std::array<loop::HeldPart, scene::kMostHands - 1> others = {};  // of that tick
    std::vector<std::optional<Pose>> X_W = {};                      // of each part that a hand has picked up, as shown
};

geometry::TriangleMesh meshOf(const scene::PartSpec& part) {
    if (const auto* file = std::get_if<scene::MeshFile>(&part.geometry)) {
        auto read = importer::importMesh(file->path, file->metres_per_unit);
        if (!read) throw std::runtime_error(toString(read.errors().front()));
        return read->mesh;
    }
    return shape::tessellate(std::get<shape::Shape>(part.geometry), kFine);
}

Pose poseOf(const std::array<float, 3>& p, const std::array<float, 4>& q) {
    return {Eigen::Quaternionf(q[0], q[1], q[2], q[3]).cast<double>().normalized(), Vec3(p[0], p[1], p[2])};
}

/// Where everything stands: obstacles where they are drawn, the held part where the condition shows it in that tick,
/// what was picked up where it is or was left.
std::vector<Standing> standing(const Moment& moment) {
    std::vector<Standing> parts;
    const auto& specs = moment.condition->scene.parts;
    const bool proxy = moment.condition->shown == plan::ShownPose::Proxy;
    for (std::size_t i = 0; i < specs.size(); ++i) {
        const scene::PartSpec& part = specs[i];
        Pose X_W = part.X_WP;
        if (i < moment.X_W.size() && moment.X_W[i]) {
            X_W = *moment.X_W[i];
        } else if (part.held && part.hand > 0 && moment.tick) {
            const loop::HeldPart& other = moment.others[part.hand - 1];
            X_W = proxy ? other.X_WG : other.X_WH;
        } else if (part.held && moment.tick) {
            X_W = proxy ? poseOf(moment.tick->proxy_position_m, moment.tick->proxy_quaternion)
                        : poseOf(moment.tick->hand_position_m, moment.tick->hand_quaternion);
        }
        X_W.p += part.shown_offset;
        parts.push_back({meshOf(part), X_W});
    }
    return parts;
}

/// The camera that [view] describes in full; else the scene's.
Eye eyeOf(const plan::View& view, const presenter::Camera& camera) {
    if (!view.camera_target || !view.camera_distance) return {camera.X_WC, camera.opening};
    const Vec3 back = view.camera_from.normalized(), right = Vec3::UnitZ().cross(back).normalized();
    Mat3 axes;
    axes << right, back.cross(right), back;
    return {{Quat(axes), *view.camera_target + *view.camera_distance * back}, view.camera_opening};
}

double expectedHue(const Moment& moment, const plan::View& view) {
    const plan::Cues& cues = moment.condition->cues;
    double cue = 0.0;
    if (cues.visual && moment.in_trial && moment.tick)
        cue = std::min(1.0, static_cast<double>(moment.tick->hand_depth_m) / cues.full_depth);
    const QColor plain = view.theme == plan::Theme::Dark ? kHeldDark : kHeldLight;
    const auto mixed = [cue](float from, float to) { return from + static_cast<float>(cue) * (to - from); };
    return QColor::fromRgbF(mixed(plain.redF(), kHit.redF()), mixed(plain.greenF(), kHit.greenF()),
                            mixed(plain.blueF(), kHit.blueF()))
        .hsvHueF();
}

class Oracle;

/// Shows a session that runs in virtual time in the windows, step by step, in the thread of the windows.
class Showman final : public run::Performer {
public:
    Showman(window::Desk& desk, std::function<void(const Moment&)> look) : desk_(desk), look_(std::move(look)) {}

    bool looks_early = false;  // also before the start pose is reached

    plan::ParticipantKind kind() const override { return plan::ParticipantKind::Simulated; }
    std::span<loop::ScreenRing* const> screens() override { return screens_; }
    std::optional<session::Presentation> presented(std::int64_t, std::int64_t, std::int64_t) override {
        session::Presentation given;
        given.drawn_pose = "proxy";
        return given;
    }
    void begins(session::Apparatus&, const session::SessionSetup& setup) override {
        plan_ = &*setup.plan;
        desk_.bring({presenter::SessionBegun{setup.participant, setup.trials, {}, setup.plan->view}}, {});
    }
    void prepares(const plan::Condition& condition, std::int64_t trial_index, std::uint64_t) override {
        bring();
        ++scenes;
        seen_ = {};
        moment_ = {&condition, std::nullopt, false, {}, {}};
        moment_.X_W.resize(condition.scene.parts.size());
        holding_ = {};
        seen_early_ = false;
        auto scene = artist_.draw(condition, plan_->view);
        if (!scene) throw std::runtime_error(toString(scene.errors().front()));
        presenter::TrialBrief brief;
        brief.kind = static_cast<presenter::TrialBrief::Kind>(condition.task.form.index());
        brief.timed_by = condition.timed_by;
        desk_.bring({presenter::AttemptPrepared{trial_index, condition.name, *scene, brief}}, {});
        if (condition.timed_by == plan::TimedBy::Program) look_(moment_);
    }
    void betweenSteps(session::Session& session) override {
        moment_.in_trial = false;
        bring();
        // As a live session tells it: only what is new.
        if (auto view = session.view(); view != told_) {
            desk_.bring({view}, {});
            told_ = std::move(view);
        }
        if (session.state() != session::SessionState::InTrial || !moment_.tick) return;
        if (moment_.condition->timed_by != plan::TimedBy::Program) return;
        moment_.in_trial = desk_.run().view().is<state::Running>() && isTask();
        if (!moment_.in_trial && looks_early && !std::exchange(seen_early_, true)) look_(moment_);
        if (!moment_.in_trial) return;
        // The first picture of the trial, one once the part has gone in, and one as deep as half of the cue's scale.
        const double depth = static_cast<double>(moment_.tick->hand_depth_m) / moment_.condition->cues.full_depth;
        const std::array<bool, 3> due{true, depth > 0.05, depth > 0.5};
        for (std::size_t i = 0; i < due.size(); ++i) {
            if (!due[i] || seen_[i]) continue;
            seen_[i] = true;
            look_(moment_);
            return;
        }
    }
    void over() override { bring(); }

    int scenes = 0;

private:
    bool isTask() const {
        const auto view = presenter::participantView(desk_.run(), true);
        return view.screen == presenter::ParticipantScreen::Task;
    }
    void bring() {
        std::vector<loop::ScreenTick> ticks(256);
        while (const std::size_t count = screen_.take(ticks)) {
            desk_.bring({}, std::span(ticks).first(count));
            for (const loop::ScreenTick& tick : std::span(ticks).first(count)) follow(tick);
            moment_.tick = ticks[count - 1].record;
            moment_.others = ticks[count - 1].others;
        }
    }

    /// What hands carry is where they are; what they let go stays where its proxy was in the tick before.
    void follow(const loop::ScreenTick& tick) {
        const TickRecord& first = tick.record;
        const auto holds = [&](std::size_t hand) -> loop::HeldPart {
            if (hand > 0) return tick.others[hand - 1];
            return {.X_WH = poseOf(first.hand_position_m, first.hand_quaternion),
                    .X_WG = poseOf(first.proxy_position_m, first.proxy_quaternion),
                    .part = first.held};
        };
        const bool proxy = moment_.condition->shown == plan::ShownPose::Proxy;
        std::array<loop::HeldPart, scene::kMostHands> now;
        for (std::size_t hand = 0; hand < now.size(); ++hand) {
            now[hand] = holds(hand);
            const loop::HeldPart& before = holding_[hand];
            if (before.part >= 0 && before.part != now[hand].part)
                moment_.X_W[static_cast<std::size_t>(before.part)] = before.X_WG;
        }
        for (std::size_t hand = now.size();
             hand-- > 0;)  // where two hands have one part the first hand's pose is shown
            if (now[hand].part >= 0)
                moment_.X_W[static_cast<std::size_t>(now[hand].part)] = proxy ? now[hand].X_WG : now[hand].X_WH;
        holding_ = now;
    }

    window::Desk& desk_;
    std::function<void(const Moment&)> look_;
    const plan::StudyPlan* plan_ = nullptr;
    presenter::SceneArtist artist_;
    loop::ScreenRing screen_{4096};
    std::vector<loop::ScreenRing*> screens_{&screen_};
    Moment moment_;
    std::array<loop::HeldPart, scene::kMostHands> holding_ = {};  // of the tick before
    std::optional<session::SessionView> told_;
    std::array<bool, 3> seen_{};
    bool seen_early_ = false;
};

class Oracle : public Windows {
protected:
    void resize(int width, int height) {
        size_ = {width, height};
        QQuickWindow* window = app_->participant();
        window->resize(width, height);
        if (window->isExposed()) waitFor([&] { return window->grabWindow().size() == size_; });  // the surface as well
    }

    static plan::StudyPlan planOf(const std::string& text, const std::string& path) {
        auto plan = protocol::readProtocolText(text, path, run::knownDevices(), run::knownMeasures());
        if (!plan) throw std::runtime_error(toString(plan.errors().front()));
        return *std::move(plan);
    }

    /// A session of the plan, or what is left of the newest one, until so many scenes were shown.
    int show(const plan::StudyPlan& plan, const std::string& database, bool resumes = false, int scenes = 1 << 20,
             bool early = false) {
        plan_ = &plan;
        app_->desk().open(plan, "en");
        waitFor([&] { return app_->participant()->isExposed(); });
        if (size_.isValid()) resize(size_.width(), size_.height());
        Showman showman(app_->desk(), [this](const Moment& moment) { compare(moment); });
        showman.looks_early = early;
        run::RunOptions options;
        options.database = database;
        options.backup = false;
        options.performer = &showman;
        options.interrupted = [&] { return showman.scenes >= scenes; };
        const auto end = resumes ? run::resumeStudy({}, options, {}) : run::runStudy(plan, options, {});
        EXPECT_TRUE(end) << toString(end.errors().front());
        scenes_ += showman.scenes;
        return showman.scenes;
    }

    /// What lies over a scene, in its own coordinates: elsewhere pixels hold nothing but the scene.
    static std::vector<QRectF> coveredOf(QQuickItem* scene) {
        std::vector<QRectF> rects;
        for (QQuickItem* item : scene->parentItem()->childItems()) {
            if (!item->isVisible() || item == scene || item->inherits("QQuickMouseArea")) continue;
            rects.push_back(item->mapRectToItem(scene, {0, 0, item->width(), item->height()}).adjusted(-1, -1, 1, 1));
        }
        return rects;
    }

    void compare(const Moment& moment) {
        QQuickWindow* window = app_->participant();
        QQuickItem* scene = item(window, "scene");
        ASSERT_NE(scene, nullptr) << "no scene is shown";
        QCoreApplication::processEvents();
        const std::string what = moment.condition->name + ", scene " + std::to_string(samples_);
        const QImage shown = picture(window, ("oracle_" + std::to_string(samples_)).c_str());
        scene->setProperty("flat", true);
        const QImage flat = picture(window, ("oracle_" + std::to_string(samples_) + "_flat").c_str());
        scene->setProperty("flat", false);
        ASSERT_EQ(flat.size(), size_);
        if (samples_ % 8 == 0) compareMirror(moment, what + ", mirror");
        ++samples_;
        compare(shown, flat, coveredOf(scene), moment, what);
    }

    /// The same of the experimenter's mirror, which follows a few times a second.
    void compareMirror(const Moment& moment, const std::string& what) {
        QQuickWindow* window = app_->experimenter();
        app_->setPage("session");
        waitFor([&] { return window->isExposed() && item(window, "mirror") != nullptr; });
        QQuickItem* mirror = item(window, "mirror");
        QSignalSpy follows(mirror->property("scene").value<QObject*>(), SIGNAL(frame()));
        waitFor([&] {
            emit app_->desk().frame();
            return !follows.isEmpty();
        });
        const QRect place = mirror->mapRectToScene({0, 0, mirror->width(), mirror->height()}).toRect();
        const std::string name = "oracle_" + std::to_string(samples_) + "_mirror";
        const QImage shown = picture(window, name.c_str()).copy(place);
        mirror->setProperty("flat", true);
        const QImage flat = picture(window, (name + "_flat").c_str()).copy(place);
        mirror->setProperty("flat", false);
        ++mirrored_;
        compare(shown, flat, coveredOf(mirror), moment, what);
    }

    void compare(const QImage& shown, const QImage& flat, const std::vector<QRectF>& over, const Moment& moment,
                 const std::string& what) {
        const SeenParts seen(standing(moment), eyeOf(plan_->view, run().scene()->camera), flat.width(), flat.height());
        compareMasks(flat, seen, over, what);
        const auto& parts = moment.condition->scene.parts;
        for (std::size_t i = 0; i < parts.size(); ++i)
            if (parts[i].held && parts[i].hand == 0) compareHue(shown, seen, static_cast<int>(i), over, moment, what);
    }

    void compareMasks(const QImage& flat, const SeenParts& seen, const std::vector<QRectF>& over,
                      const std::string& what) {
        const auto count = moment_parts();
        std::vector<int> drawn(count), expected(count), both(count);
        std::vector<double> hues(count);
        for (std::size_t i = 0; i < count; ++i) hues[i] = identity(static_cast<int>(i)).hsvHueF();
        for (int y = 0; y < flat.height(); ++y)
            for (int x = 0; x < flat.width(); ++x) {
                if (isCovered(over, x, y)) continue;
                const QColor colour = flat.pixelColor(x, y);
                int part = -1;
                if (colour.value() > 100 && colour.hsvSaturation() > 100) {
                    const double hue = colour.hsvHueF();
                    const auto nearer = [hue](double a, double b) { return hueDistance(hue, a) < hueDistance(hue, b); };
                    part = static_cast<int>(std::min_element(hues.begin(), hues.end(), nearer) - hues.begin());
                }
                const int truth = seen.at(x, y);
                if (part >= 0) ++drawn[static_cast<std::size_t>(part)];
                if (truth >= 0) ++expected[static_cast<std::size_t>(truth)];
                if (part >= 0 && part == truth) ++both[static_cast<std::size_t>(part)];
            }
        for (std::size_t i = 0; i < count; ++i) {
            if (expected[i] == 0) {
                EXPECT_EQ(drawn[i], 0) << what << ": part " << i << " is hidden";
                hidden_ += 1;
            }
            if (expected[i] <= kManyPixels) continue;
            const double overlap = both[i] / static_cast<double>(drawn[i] + expected[i] - both[i]);
            least_overlap_ = std::min(least_overlap_, overlap);
            EXPECT_GE(overlap, kLeastOverlap)
                << what << ": part " << i << " has " << drawn[i] << " pixels, not " << expected[i];
            ++compared_;
        }
    }

    /// The held part's pixels that have light on them, without its rim.
    void compareHue(const QImage& shown, const SeenParts& seen, int held, const std::vector<QRectF>& over,
                    const Moment& moment, const std::string& what) {
        if (moment.tick && !moment.in_trial) return;  // its pale image lies over it
        std::vector<std::pair<float, float>> lit;     // value, hue
        for (int y = 2; y < seen.height() - 2; ++y)
            for (int x = 2; x < seen.width() - 2; ++x) {
                if (isCovered(over, x, y)) continue;
                bool inside = true;
                for (int dy = -2; dy <= 2 && inside; ++dy)
                    for (int dx = -2; dx <= 2 && inside; ++dx) inside = seen.at(x + dx, y + dy) == held;
                if (!inside) continue;
                const QColor colour = shown.pixelColor(x, y);
                lit.emplace_back(colour.valueF(), colour.hsvHueF());
            }
        if (lit.size() < kManyPixels) return;
        std::sort(lit.begin(), lit.end());
        lit.erase(lit.begin(), lit.begin() + static_cast<std::ptrdiff_t>(lit.size() / 2));
        std::sort(lit.begin(), lit.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
        const double hue = static_cast<double>(lit[lit.size() / 2].second), expected = expectedHue(moment, plan_->view);
        worst_hue_ = std::max(worst_hue_, hueDistance(hue, expected));
        EXPECT_LE(hueDistance(hue, expected), kHueError) << what << ": hue " << hue << ", not " << expected;
        ++hues_;
        if (hueDistance(expected, kHit.hsvHueF()) < hueDistance(expected, kHeldDark.hsvHueF())) ++red_;
    }

    std::size_t moment_parts() const { return run().scene()->parts.size(); }
    static bool isCovered(const std::vector<QRectF>& over, int x, int y) {
        return std::any_of(over.begin(), over.end(), [=](const QRectF& r) { return r.contains(x + 0.5, y + 0.5); });
    }

    void report(const char* what) const {
        std::printf(
            "%s: %d scenes, %d pictures, %d of the mirror; %d masks, overlap at least %.4f; %d hidden; %d hues, off by "
            "at most "
            "%.4f, %d of them nearer to the cue's red\n",
            what, scenes_, samples_, mirrored_, compared_, least_overlap_, hidden_, hues_, worst_hue_, red_);
    }

    const plan::StudyPlan* plan_ = nullptr;
    QSize size_;
    int scenes_ = 0, samples_ = 0, mirrored_ = 0, compared_ = 0, hidden_ = 0, hues_ = 0, red_ = 0;
    double least_overlap_ = 1.0, worst_hue_ = 0.0;
};

/// smallStudy with two holes and three kinds of feedback, each of which comes back; a line is followed with some force,
/// so that the cue is seen, and who does not manage repeats. Behind the plate a sheet that faces away, and behind that
/// a box that nobody can see.
std::string comingBack(const std::string& view) {
    std::string text = smallStudy("coming_back");
    const auto swap = [&text](const std::string& from, const std::string& to) {
        text.replace(text.find(from), from.size(), to);
    };
    swap("[scene.contact]", R"([[scene.part]]
name = "screen"
shape = { kind = "sheet", width = 60, depth = 40 }
pose = { position = [0, 32, 4], rotation_deg = [-90, 0, 0] }

[[scene.part]]
name = "hidden"
shape = { kind = "box", width = 8, depth = 8, height = 8 }
pose = { position = [0, 42, -4] }

[scene.contact])");
    const std::size_t factor = text.find("[[factor]]"), task = text.find("[task]");
    text.replace(factor, task - factor, R"([[factor]]
name = "hole"
key = "part.plate.shape.bore_diameter"
levels = [22, 26]

[[factor]]
name = "feedback"
levels = [
  { label = "none", set = { "contact.method" = "god_object" } },
  { label = "visual", set = { "feedback.cues" = ["visual"], "feedback.cue_full_depth_mm" = 0.5 } },
  { label = "hand", set = { "feedback.cues" = ["visual"], "feedback.shown_pose" = "device", "contact.method" = "god_object", "feedback.cue_full_depth_mm" = 2 } },
]

)");
    const std::size_t asked = text.find("[task]"), block = text.find("[[block]]");
    text.replace(asked, block - asked, R"([task]
type = "contour_following"
target = "plate"
points = [[6, 0, 0], [14, 0, 0], [14, 12, 0]]
force_N = 3
timeout_s = 6

)");
    swap("repetitions = 3", "repetitions = 5\non_timeout = \"repeat_now\"\nmax_attempts = 2");
    return text + view;
}

TEST(RayCaster, SeesASquareWhereGeometryHasIt) {
    // Truth: closed form. At distance d a picture of h pixels shows 2 d tan(opening / 2) of height.
    const double opening = 0.5, half = std::tan(0.25);
    Standing square{{{{-0.1, -0.1, 0}, {0.1, -0.1, 0}, {0.1, 0.1, 0}, {-0.1, 0.1, 0}}, {{0, 1, 2}, {0, 2, 3}}}, {}};
    Standing behind = square;
    behind.X_W.p = {0.15, 0.0, -1.0};
    const SeenParts seen({behind, square}, {{Quat::Identity(), {0, 0, 0.8}}, opening}, 400, 300);
    const double side = 0.2 / (2.0 * 0.8 * half) * 300.0;
    EXPECT_NEAR(std::sqrt(seen.count(1)), side, 1.0);
    EXPECT_EQ(seen.at(200, 150), 1);
    EXPECT_EQ(seen.at(0, 0), -1);
    // The other's right edge: x = 0.25 at distance 1.8.
    const int edge = static_cast<int>(200 + 0.25 / (2.0 * 1.8 * half) * 300.0);
    EXPECT_EQ(seen.at(edge - 1, 150), 0);
    EXPECT_EQ(seen.at(edge + 1, 150), -1);
    EXPECT_EQ(SeenParts({square}, {{Quat(0, 1, 0, 0), {0, 0, -0.8}}, opening}, 400, 300).count(0), seen.count(1))
        << "from behind";
}

TEST_F(Oracle, ScenesThatComeBackShowWhatTheirConditionSays) {
    // Truth: closed form: rays through the middles of pixels against the parts' triangles, with the recorded poses.
    // PASSUNG_LONG=1: all scenes of both studies, else some after each resumption.
    const bool all = test::atFullLength();
    const int some = all ? 1 << 20 : 3;
    resize(640, 400);
    const auto plan = planOf(comingBack(""), "coming_back.toml");
    show(plan, folder_ / "first.db", false, 14);
    show(plan, folder_ / "first.db", true, some);
    const auto light = planOf(comingBack(R"(
[view]
theme = "light"
camera_from = [-1, -2, 2]
camera_target_mm = [2, 5, 0]
camera_distance_mm = 220
camera_angle_deg = 22
shadow_percent = 20
)"),
                              "coming_back.toml");
    resize(960, 400);
    show(light, folder_ / "second.db", false, all ? 11 : 6);
    resize(1280, 720);
    show(light, folder_ / "second.db", true, some);
    report("scenes that come back");
    EXPECT_GE(scenes_, all ? 60 : 25);
    EXPECT_GE(mirrored_, all ? 15 : 7);
    EXPECT_GT(red_, all ? 10 : 5) << "the cue was hardly seen";
    EXPECT_GT(hidden_, scenes_ / 2) << "nothing was hidden";
}

TEST_F(Oracle, PartsInTwoHandsStandWhereTheHandsHaveThem) {
    // Truth: as above. Before they reach the start pose both hands are millimetres away from it, so that a plate drawn
    // where it starts would miss its place by more than the masks forgive.
    std::string text;
    std::ifstream file(PASSUNG_SOURCE_DIR "/protocols/two_hands/study.toml");
    text.assign(std::istreambuf_iterator<char>(file), {});
    const auto plan = planOf(text, "two_hands.toml");
    resize(640, 400);
    show(plan, folder_ / "hands.db", false, 5, true);
    report("parts in two hands");
    EXPECT_GE(samples_, 15);
    EXPECT_GE(compared_, 20);
}

TEST_F(Oracle, TheConsolesLookAndLanguageChangeNothingOfTheParticipantsPicture) {
    // Truth: invariant: the same tick is drawn by the same pixels, whatever the experimenter chooses for the console.
    const auto plan = planOf(comingBack(""), "coming_back.toml");
    resize(640, 400);
    plan_ = &plan;
    app_->desk().open(plan, "en");
    waitFor([&] { return app_->participant()->isExposed(); });
    int compared = 0;
    Showman showman(app_->desk(), [&](const Moment&) {
        const QImage before = picture(app_->participant(), "look_before");
        if (compared % 2 == 0) app_->look().setDark(!app_->look().dark());
        app_->setLanguage(app_->language() == "en" ? "de" : "en");
        app_->look().setScale(app_->look().scale() > 1.2 ? 1.0 : 1.5);
        QCoreApplication::processEvents();
        EXPECT_EQ(picture(app_->participant(), "look_after"), before) << compared;
        ++compared;
    });
    run::RunOptions options;
    options.database = folder_ / "look.db";
    options.backup = false;
    options.performer = &showman;
    options.interrupted = [&] { return showman.scenes >= 6; };
    const auto end = run::runStudy(plan, options, {});
    ASSERT_TRUE(end) << toString(end.errors().front());
    EXPECT_GE(compared, 8);
}

TEST_F(Oracle, EveryTrialOfEveryShippedStudyShowsWhatItsConditionSays) {
    // Truth: closed form, as above. The first trials of one participant; PASSUNG_LONG=1: all of them.
    const int scenes = test::atFullLength() ? 1 << 20 : 3;
    resize(640, 400);
    for (const auto& folder : std::filesystem::directory_iterator(PASSUNG_SOURCE_DIR "/protocols")) {
        const std::string path = folder.path() / "study.toml";
        if (!std::filesystem::exists(path)) continue;
        auto plan = protocol::readProtocol(path, run::knownDevices(), run::knownMeasures());
        ASSERT_TRUE(plan) << toString(plan.errors().front());
        show(*plan, folder_ / (plan->name + ".db"), false, scenes);
        report(plan->name.c_str());
    }
}

}  // namespace
}  // namespace passung::test

int main(int argc, char** argv) {
    testing::InitGoogleTest(&argc, argv);
    return RUN_ALL_TESTS();
}
