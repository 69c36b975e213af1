#include "study/store/read/unfinished.h"

#include <gtest/gtest.h>

#include "tests/study/store/fake_study.h"

namespace passung::store {
namespace {

using fake::require;

const session::QualityFound kFound{{false, 1, 0.7}, 1280, 720, 61504, 30.125};

/// What is known of a session that was left with these events of the windows.
std::optional<session::QualityFound> qualityAfter(const std::vector<session::Event>& events) {
    const fake::TempFolder folder;
    {
        const auto store = fake::openStore(folder / "s.db");
        const auto writer = fake::beginSession(*store, "S001", 1);
        for (const session::Event& event : events) writer->appendEvent(event);
        require(writer->finishSession(false, 10));
    }
    return require(fake::openStore(folder / "s.db")->unfinished("")).quality;
}

session::Event drawn(const std::string& payload) {
    return {.attempt = {}, .t_ns = 1, .source = "window", .event = session::kQualityEvent, .payload_json = payload};
}

session::Event noted(const std::string& text) {
    return {.attempt = {},
            .t_ns = 1,
            .source = "window",
            .event = "command_note",
            .payload_json = R"({"accepted":true,"text":")" + text + "\"}"};
}

TEST(Unfinished, KnowsHowItsPicturesWereDrawn) {
    // Truth: invariant: what an event says is what comes back, and of several the newest.
    EXPECT_FALSE(qualityAfter({}));
    EXPECT_EQ(qualityAfter({drawn(session::qualityJson(kFound))}), kFound);
    session::QualityFound before = kFound;
    before.quality = {true, 4, 1.0};
    EXPECT_EQ(qualityAfter({drawn(session::qualityJson(before)), drawn(session::qualityJson(kFound))}), kFound);
    EXPECT_FALSE(qualityAfter({drawn("{}")})) << "nothing could be drawn so";
}

TEST(Unfinished, ReadsTheNoteOfProgramsThatHadNoSuchEvent) {
    // Truth: regression: the text that databases hold from before the event was; others of the windows' notes are not
    // about pictures.
    const std::string old =
        "picture quality: window 1280 x 720 pixels, drawn at 0.70 of its sides, 1 samples a pixel, shadows off; 30.1 "
        "pictures a second with 61504 triangles";
    session::QualityFound found = kFound;
    found.pictures_per_s = 30.1;
    EXPECT_EQ(qualityAfter({noted(old), noted("the phone rang")}), found);
    EXPECT_EQ(qualityAfter({noted(old), drawn(session::qualityJson(kFound))}), kFound);
    EXPECT_FALSE(qualityAfter({noted("the phone rang")}));
}

}  // namespace
}  // namespace passung::store
