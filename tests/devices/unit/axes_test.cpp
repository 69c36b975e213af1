#include "devices/unit/axes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

namespace passung::unit {
namespace {

/// All 48 of them, as a station file writes them.
std::vector<std::string> allAxes() {
    std::vector<std::string> all;
    std::array<char, 3> order{'x', 'y', 'z'};
    do {
        for (int signs = 0; signs < 8; ++signs) {
            std::string text;
            for (std::size_t i = 0; i < 3; ++i) {
                if (i > 0) text += ' ';
                if ((signs >> i & 1) != 0) text += '-';
                text += order[i];
            }
            all.push_back(text);
        }
    } while (std::next_permutation(order.begin(), order.end()));
    return all;
}

TEST(Axes, SayWhichOfTheDevicesAxesPointsAlongEachOfTheBases) {
    // Truth: closed form: the sentence of the header.
    const auto axes = Axes::parse("x -z y");
    ASSERT_TRUE(axes);
    EXPECT_EQ(axes->toBase(Vec3(1, 2, 3)), Vec3(1, -3, 2));
    EXPECT_EQ(Axes().toBase(Vec3(1, 2, 3)), Vec3(1, 2, 3));
}

TEST(Axes, EachOfThe48IsReadWrittenAndTurnedBackAndTheOther47AreTold) {
    // Truth: invariant: a vector comes back to the last bit by the same axes, and by no others.
    const auto all = allAxes();
    ASSERT_EQ(all.size(), 48u);
    const Vec3 v(0.1, -0.25, 0.7);
    for (const std::string& text : all) {
        const auto axes = Axes::parse(text);
        ASSERT_TRUE(axes) << text;
        EXPECT_EQ(axes->text(), text);
        int wrong = 0;
        for (const std::string& other : all)
            if (Axes::parse(other)->toDevice(axes->toBase(v)) != v) ++wrong;
        EXPECT_EQ(wrong, 47) << text;
    }
}

TEST(Axes, APoseAtRestIsAtRestAndTurnsAsItsAxesDo) {
    // Truth: closed form: R' = A R A^T, A's columns where the device's axes point, mirrors among them.
    const Pose device{rotationFromVector(Vec3(0.3, -1.1, 0.7)), Vec3(0.1, -0.25, 0.7)};
    for (const std::string& text : allAxes()) {
        const auto axes = Axes::parse(text);
        EXPECT_EQ(axes->toBase(Pose{}).q.coeffs(), Quat::Identity().coeffs());
        Mat3 A;
        for (int i = 0; i < 3; ++i) A.col(i) = axes->toBase(Vec3(Vec3::Unit(i)));
        const Pose base = axes->toBase(device);
        EXPECT_EQ(base.p, axes->toBase(device.p));
        EXPECT_LT((base.q.toRotationMatrix() - A * device.q.toRotationMatrix() * A.transpose()).cwiseAbs().maxCoeff(),
                  1e-15)
            << text;
    }
}

TEST(Axes, RefusesWhatNamesNoThreeAxes) {
    // Truth: invariant.
    for (const char* text :
         {"", "x", "x y", "x y y", "x y z ", "x,y,z", "x  y z", "--x y z", "X y z", "x y w", "x y zz"}) {
        const auto axes = Axes::parse(text);
        ASSERT_FALSE(axes) << text;
        EXPECT_EQ(axes.errors().front().value, text);
    }
}

}  // namespace
}  // namespace passung::unit
