#include <sys/resource.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <thread>

#include "core/shape/shape.h"
#include "study/protocol/protocol_reader.h"
#include "study/run/files/known_names.h"
#include "study/store/read/store_reader.h"
#include "tests/support/length.h"
#include "tests/ui/window/four_trials.h"
#include "tests/ui/window/windows.h"
#include "ui/window/live_session.h"

// What drawing costs: a part of 59 000 triangles, both windows open, and the same trials without a window. Prints
// pictures a second, processor time and the ticks' computing time; times are not judged here, they depend on what else
// the machine does. PASSUNG_LONG=1: trials of 6 s, else of 2.

namespace passung::test {
namespace {

namespace state = presenter::state;
using Steady = std::chrono::steady_clock;

constexpr std::size_t kTriangles = 59'000;

/// A ring of at least that many triangles, as a file.
std::size_t writeRing(const std::string& path) {
    geometry::TriangleMesh mesh;
    for (double error = 20e-6; mesh.triangles.size() < kTriangles; error *= 0.9)
        mesh = shape::tessellate(shape::Torus{0.12, 0.04}, error);
    std::ofstream file(path);
    file << "OFF\n" << mesh.vertices.size() << " " << mesh.triangles.size() << " 0\n";
    for (const Vec3& v : mesh.vertices) file << 1e3 * v.x() << " " << 1e3 * v.y() << " " << 1e3 * v.z() << "\n";
    for (const auto& [a, b, c] : mesh.triangles) file << "3 " << a << " " << b << " " << c << "\n";
    return mesh.triangles.size();
}

/// A finger that follows the ring's ridge, with either method.
constexpr const char* kStudy = R"(passung = 1
study = { name = "ring", version = "1", seed = 3, participants = 2 }
[scene]
unit = "mm"
device = { preset = "sigma7" }
part = [
  { name = "ring", mesh = "ring.off" },
  { name = "finger", held = true, shape = { kind = "sphere", diameter = 10 }, pose = { position = [30, -52, 32] } },
]
contact = { cell_mm = 2.0, spacing_mm = 1.0 }
[[factor]]
name = "method"
key = "contact.method"
levels = ["penalty", "god_object_heuristic"]
[task]
type = "contour_following"
target = "ring"
points = [[30, -52, 25], [52, -30, 25], [60, 0, 25], [52, 30, 25], [30, 52, 25]]
timeout_s = TIMEOUT
[[block]]
name = "main"
phase = "main"
order = "williams"
repetitions = 1
)";

double processorSeconds() {
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    const auto seconds = [](const timeval& t) {
        return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    return seconds(used.ru_utime) + seconds(used.ru_stime);
}

/// Time and processor time of a run.
struct Spent {
    Steady::time_point begin = Steady::now();
    double processor_begin = processorSeconds();
    double seconds() const { return std::chrono::duration<double>(Steady::now() - begin).count(); }
    double processor() const { return processorSeconds() - processor_begin; }
};

class Rates : public Windows {
protected:
    void SetUp() override {
        protocols_ = folder_ / "studies";
        std::filesystem::create_directories(protocols_ + "/ring");
        triangles_ = writeRing(protocols_ + "/ring/ring.off");
        std::string study = kStudy;
        study.replace(study.find("TIMEOUT"), 7, test::atFullLength() ? "6" : "2");
        std::ofstream(protocols_ + "/ring/study.toml") << study << kOnAnyMachine;
        warnings.clear();
    }

    plan::StudyPlan plan() {
        auto read = protocol::readProtocol(protocols_ + "/ring/study.toml", run::knownDevices(), run::knownMeasures());
        if (!read) throw std::runtime_error(toString(read.errors().front()));
        return *read;
    }

    /// p99.9 of the ticks of all attempts in this database, the largest [µs]; and prints the age of its pictures.
    double slowTicks(const std::string& database) {
        const auto attempts = store::StoreReader::open(database)->attempts();
        double worst = 0.0;
        for (const auto& attempt : *attempts) {
            worst = std::max(worst, attempt.timing->p999_us.value_or(0.0));
            if (attempt.presentation && attempt.presentation->frames > 0)
                std::printf("    %-22s %lld pictures, %.0f ms old, 99 %% up to %.0f ms\n", attempt.condition.c_str(),
                            static_cast<long long>(attempt.presentation->frames),
                            1e-3 * attempt.presentation->frame_age_median_us,
                            1e-3 * attempt.presentation->frame_age_p99_us);
        }
        return worst;
    }

    std::size_t triangles_ = 0;
};

TEST_F(Rates, OfAHeavyPartInBothWindows) {
    // Truth: none for times, which are printed. Invariants: the part is heavy, and both windows draw it.
    if (!test::atFullLength()) GTEST_SKIP() << "but for PASSUNG_LONG=1";
    ASSERT_GE(triangles_, kTriangles);
    const auto withoutWindows = [&](const std::string& database) {
        const Spent spent;
        window::LiveSession session(plan(),
                                    {.database = database, .hand = window::LiveHand::Simulated, .try_out = true});
        std::array<loop::ScreenTick, 256> ticks;
        for (bool over = false; !over;) {
            while (session.takeTicks(ticks) > 0) {
            }
            for (const presenter::News& news : session.takeNews())
                if (const auto* end = std::get_if<presenter::RunOver>(&news)) {
                    over = true;
                    EXPECT_TRUE(end->errors.empty()) << toString(end->errors.front());
                }
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        return spent.processor() / spent.seconds();
    };
    withoutWindows(folder_ / "first.db");  // builds the ring's field
    const double share_without = withoutWindows(folder_ / "alone.db");
    const double ticks_without = slowTicks(folder_ / "alone.db");
    std::printf("%zu triangles, participant's window 1280 x 720, console 1440 x 900\n", triangles_);
    std::printf("  without windows: %.2f processors, ticks' p99.9 %.0f us\n", share_without, ticks_without);
    for (const bool shadows : {false, true}) {
        open("en", true);
        int pictures = 0, mirrored = 0;
        app_->desk().tryOut(plan(), window::LiveHand::Simulated, "en");
        waitFor([&] { return item(app_->participant(), "scene") != nullptr; });
        item(app_->participant(), "scene")->setProperty("shadows", shadows);
        click("page-session");
        waitFor<state::Running>();
        const QObject context;
        QObject::connect(app_->participant(), &QQuickWindow::frameSwapped, &context, [&] { ++pictures; });
        QObject::connect(app_->experimenter(), &QQuickWindow::frameSwapped, &context, [&] { ++mirrored; });
        ASSERT_NE(item(app_->experimenter(), "mirror"), nullptr);
        const Spent spent;
        waitFor([&] { return !run().view().is<state::Running>(); });
        const double seconds = spent.seconds(), processor = spent.processor() - share_without * seconds;
        picture(app_->participant(), shadows ? "heavy_shadows" : "heavy");
        waitFor<state::Complete>();
        std::printf("  %s shadows: %.1f pictures a second, console %.1f; processor time %.1f ms a picture\n",
                    shadows ? "with" : "without", pictures / seconds, mirrored / seconds, 1e3 * processor / pictures);
        EXPECT_GT(pictures, 0);
        EXPECT_GT(mirrored, 0);
        app_->desk().close();
        const double ticks = slowTicks(folder_ / "data/ring.db");
        std::printf("    ticks' p99.9 %.0f us, %.2f times that without windows\n", ticks, ticks / ticks_without);
        app_.reset();
        std::filesystem::remove(folder_ / "data/ring.db");
    }
}

TEST_F(Rates, QualityFallsUntilPicturesAreFastEnoughOrHalfAsLarge) {
    // Truth: none for times, which are printed. Invariants: nothing is given up without need, and what was found while
    // nothing else moved is enough unless the picture's sides are half the window's.
    quality_.reset();
    for (const QSize& size : {QSize(1280, 720), QSize(2560, 1440)}) {
        open("en", true);
        app_->desk().tryOut(plan(), window::LiveHand::Simulated, "en");
        app_->participant()->setGeometry(QRect({0, 0}, size));
        int pictures = 0;
        const QObject context;
        waitFor<state::Running>();
        QObject::connect(app_->participant(), &QQuickWindow::frameSwapped, &context, [&] { ++pictures; });
        const Spent spent;
        waitFor([&] { return !run().view().is<state::Running>(); });
        const double seconds = spent.seconds();
        const auto found = run().view().quality;
        ASSERT_TRUE(found);
        EXPECT_EQ(QSize(found->width_px, found->height_px), size);
        EXPECT_GE(found->triangles, static_cast<std::int64_t>(kTriangles));
        const auto& [shadows, samples, scale] = found->quality;
        std::printf(
            "%d x %d, %lld triangles: %s shadows, %d samples a pixel, scale %.2f: %.1f pictures a second when "
            "it was found, %.1f in the trial\n",
            size.width(), size.height(), static_cast<long long>(found->triangles), shadows ? "with" : "without",
            samples, scale, found->pictures_per_s, pictures / seconds);
        EXPECT_TRUE(found->pictures_per_s >= presenter::QualitySearch::kWanted || scale == 0.5);
        app_.reset();
        std::filesystem::remove(folder_ / "data/ring.db");
    }
}

}  // namespace
}  // namespace passung::test

int main(int argc, char** argv) {
    testing::InitGoogleTest(&argc, argv);
    return RUN_ALL_TESTS();
}
