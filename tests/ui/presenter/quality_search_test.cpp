#include "ui/presenter/quality_search.h"

#include <gtest/gtest.h>

#include <functional>

namespace passung::presenter {
namespace {

/// Draws until it is done on a machine where a picture takes so long.
QualitySearch searched(bool shadows, const std::function<double(const PictureQuality&)>& seconds,
                       int* pictures = nullptr) {
    QualitySearch search(shadows);
    int drawn = 0;
    for (; !search.done() && drawn < 1000; ++drawn) search.take(seconds(search.candidate()));
    EXPECT_TRUE(search.done());
    if (pictures != nullptr) *pictures = drawn;
    return search;
}

/// So many seconds for the corners, so many for the pixels; shadows draw the corners twice, samples the pixels.
double cost(const PictureQuality& q, double corners, double pixels) {
    return corners * (q.shadows ? 2.0 : 1.0) + pixels * q.scale * q.scale * (q.samples > 1 ? 2.0 : 1.0);
}

TEST(QualitySearch, TakesTheBestThatIsFastEnough) {
    // Truth: closed form of a machine whose times are known.
    const auto on = [](double corners, double pixels) {
        return searched(true, [=](const PictureQuality& q) { return cost(q, corners, pixels); }).candidate();
    };
    EXPECT_EQ(on(0.001, 0.004), (PictureQuality{true, 4, 1.0})) << "a graphics card";
    EXPECT_EQ(on(0.008, 0.010), (PictureQuality{true, 1, 1.0}));
    EXPECT_EQ(on(0.014, 0.010), (PictureQuality{false, 4, 1.0}));
    EXPECT_EQ(on(0.020, 0.012), (PictureQuality{false, 1, 1.0}));
    EXPECT_EQ(on(0.020, 0.025), (PictureQuality{false, 1, 0.7}));
    EXPECT_EQ(on(0.020, 0.500), (PictureQuality{false, 1, 0.5})) << "half the window's resolution is the least";
}

TEST(QualitySearch, SaysWhatWasReachedAndLosesNoTimeWithWhatIsTooSlow) {
    // Truth: closed form. Three slow pictures of five decide, two more are not counted.
    int pictures = 0;
    const auto slow = searched(
        true, [](const PictureQuality&) { return 0.2; }, &pictures);
    EXPECT_NEAR(slow.picturesPerSecond(), 5.0, 1e-9);
    EXPECT_EQ(pictures, 7 * 5 + 7) << "seven that fail at once, and the last one";
    const auto fast = searched(
        true, [](const PictureQuality&) { return 1.0 / 60.0; }, &pictures);
    EXPECT_NEAR(fast.picturesPerSecond(), 60.0, 1e-9);
    EXPECT_EQ(pictures, 7);
}

TEST(QualitySearch, FirstPicturesAndSingleSlowOnesDecideNothing) {
    // Truth: invariant.
    int drawn = 0;
    const auto found = searched(true, [&](const PictureQuality&) {
        ++drawn;
        return drawn <= 2 || drawn == 5 ? 3.0 : 0.01;
    });
    EXPECT_EQ(found.candidate(), (PictureQuality{true, 4, 1.0}));
}

TEST(QualitySearch, DrawsNoShadowThatTheProtocolDoesNotAskFor) {
    // Truth: invariant.
    EXPECT_EQ(searched(false, [](const PictureQuality&) { return 0.001; }).candidate(),
              (PictureQuality{false, 4, 1.0}));
}

}  // namespace
}  // namespace passung::presenter
