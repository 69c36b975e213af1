#include <QtCore/QThread>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "study/store/read/store_reader.h"
#include "study/store/schema/sqlite.h"
#include "tests/ui/cli/small_study.h"
#include "tests/ui/window/windows.h"

// Pictures count like ticks: a trial waits for its first one, does not count if they stop, and says what it drew with.

namespace passung::test {
namespace {

namespace state = presenter::state;

class FirstPicture : public Windows {
protected:
    void SetUp() override {
        protocols_ = folder_ / "studies";
        std::filesystem::create_directories(protocols_ + "/seen");
        std::string text = smallStudy("seen");
        for (const char* timeout : {"\"task.timeout_s\" = 0.4", "\"task.timeout_s\" = 20"})
            text.replace(text.find(timeout), std::strlen(timeout), "\"task.timeout_s\" = 4");
        std::ofstream(protocols_ + "/seen/study.toml") << text;
        warnings.clear();
    }

    store::AttemptRow firstAttempt() {
        auto stored = store::StoreReader::open(folder_ / "data/seen.db");
        if (!stored) throw std::runtime_error("no database");
        return stored->attempts()->at(0);
    }
};

TEST_F(FirstPicture, NoClockRunsBeforeTheScreenShowsTheTrial) {
    // Truth: invariant. The windows' thread hangs for three seconds while the trial is prepared: no tick happens.
    open("en", true);
    click("study-seen");
    QObject::connect(
        &app_->desk(), &window::Desk::opened, app_.get(), [] { QThread::sleep(3); }, Qt::QueuedConnection);
    click("tryOut");
    waitFor([&] { return run().last().has_value(); });
    EXPECT_LT(run().last()->tick, 1500) << "the loop ran while nothing was shown";
    waitFor<state::Running>();
    EXPECT_LT(run().view().trial_s, 1.5);
}

TEST_F(FirstPicture, ATrialWhosePicturesStopDoesNotCountAndSaysHowOldTheyBecame) {
    // Truth: invariant. A person's trial times out after four seconds, of which the windows hang for two and a half.
    open("en", true);
    click("study-seen");
    click("tryOut");
    waitFor([&] { return run().view().is<state::Running>() && run().view().pictures.has_value(); });
    EXPECT_GT(run().view().pictures->per_s, 0.0);
    click("page-session");
    waitFor([&] { return item(app_->experimenter(), "pictures") != nullptr; });
    QThread::msleep(2500);
    waitFor([&] { return run().view().rows[0].attempts == 1; });
    EXPECT_EQ(run().view().rows[0].state, presenter::RowState::Invalid);
    const store::AttemptRow stored = firstAttempt();
    EXPECT_FALSE(stored.valid);
    const std::string why = stored.invalid_reason.value_or("");
    EXPECT_EQ(why.rfind("picture: up to ", 0), 0u) << why;
    ASSERT_TRUE(stored.presentation);
    EXPECT_GT(stored.presentation->frame_age_max_us, 2.4e6);
    EXPECT_GT(stored.presentation->frames, 0);
}

TEST_F(FirstPicture, QualityIsFoundBeforeTheFirstTrialKeptAndStored) {
    // Truth: invariant. What the window draws with is what is stored, said, and the same in the second trial.
    quality_.reset();
    open("en", true);
    click("study-seen");
    click("watch");
    waitFor<state::Running>();
    ASSERT_TRUE(run().view().quality) << "a trial runs and nothing was found";
    const presenter::QualityFound found = *run().view().quality;
    QQuickItem* scene = item(app_->participant(), "scene");
    EXPECT_EQ(scene->property("samples").toInt(), found.quality.samples);
    EXPECT_EQ(scene->property("shadows").toBool(), found.quality.shadows);
    EXPECT_NEAR(scene->width(), app_->participant()->width() * found.quality.scale, 1.0);
    EXPECT_EQ(found.width_px, app_->participant()->width());
    EXPECT_GT(found.pictures_per_s, 0.0);
    EXPECT_TRUE(found.pictures_per_s >= 25.0 || found.quality.scale == 0.5);
    click("page-session");
    waitFor([&] { return item(app_->experimenter(), "quality") != nullptr; });
    EXPECT_FALSE(item(app_->experimenter(), "quality")->property("text").toString().isEmpty());
    picture(app_->experimenter(), "session_quality");
    waitFor([&] { return run().view().rows[1].attempts == 1; });
    EXPECT_EQ(run().view().quality->quality, found.quality);
    const store::Database data(folder_ / "data/seen.db", store::OpenMode::ReadOnly);
    EXPECT_EQ(data.integer("SELECT count(*) FROM event WHERE event='command_note'"), 0) << "nobody wrote a note";
    EXPECT_EQ(data.text("SELECT group_concat(source || payload_json) FROM event WHERE event='picture_quality'"),
              "window" + session::qualityJson(found));
    EXPECT_GT(found.triangles, 10);
    EXPECT_EQ(data.integer("SELECT count(*) FROM event WHERE event='view_shown' AND "
                           "json_extract(payload_json, '$.theme')='dark'"),
              1)
        << "what the participant sees is logged once";
}

}  // namespace
}  // namespace passung::test
