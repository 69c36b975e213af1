#include "core/closed_form/thread_samples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <vector>

#include "core/base/random.h"
#include "core/closed_form/touch_search.h"

namespace passung::closed_form {
namespace {

constexpr field::Instructions kInstructions[] = {field::Instructions::Baseline, field::Instructions::V3,
                                                 field::Instructions::V4};
const shape::ThreadBolt kBolt{.00794, .00125, .02, .0009};
const shape::ThreadNut kNut{.008, .00125, .013, .0065, .0008};

/// A line of one part as the other one has it: its frame is nearly that one's, or any.
Curve moved(const Curve& line, Random& random, double tilt, double way) {
    const auto some = [&] { return Vec3(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5); };
    const Quat q = rotationFromVector(tilt * some()) * rotationFromVector(Vec3(0, 0, 6.0 * random.uniform()));
    Curve there = line;
    there.centre = q * line.centre + way * some();
    there.e1 = q * line.e1;
    there.e2 = q * line.e2;
    there.e3 = q * line.e3;
    return there;
}

std::vector<double> rowsOf(const ThreadSamples& samples) {
    std::vector<double> all;
    for (const auto* row : {&samples.t, &samples.x, &samples.y, &samples.z, &samples.by_x, &samples.by_y, &samples.by_z,
                            &samples.r, &samples.phi, &samples.r_by_t, &samples.phi_by_t})
        all.insert(all.end(), row->begin(), row->begin() + static_cast<std::ptrdiff_t>(samples.pieces() + 1));
    return all;
}

/// Calls `each` with every piece of every edge of bolt and nut at random poses, and with the other part's lumps.
template <class Each>
void forEachPiece(Each each) {
    const auto bolt = solidOf(kBolt), nut = solidOf(kNut);
    Random random(5);
    for (int round = 0; round < 40; ++round) {
        const double tilt = round % 4 == 0 ? 2.0 : 0.1, way = round % 3 == 0 ? 5e-3 : 2e-4;
        for (const auto& [lines, lumps] : {std::pair(&*bolt, &*nut), std::pair(&*nut, &*bolt)})
            for (const Curve& edge : lines->edges) {
                const Curve line = moved(edge, random, tilt, way);
                for (std::size_t i = 0; i < piecesOf(line); ++i) each(line, pieceOf(line, i), lumps->lumps);
            }
    }
}

TEST(ThreadSamples, AreThePointsOfTheLineWithTheSameBitsForAllInstructions) {
    // Truth: the points one at a time; instructions that this machine lacks are left out.
    double off = 0.0;
    int points = 0;
    forEachPiece([&](const Curve& line, const LinePiece& piece, const std::vector<Lump>&) {
        std::vector<double> first;
        for (const auto instructions : kInstructions) {
            if (instructions > field::bestInstructions()) continue;
            ThreadSamples samples;
            samples.take(line, piece, instructions);
            const std::vector<double> rows = rowsOf(samples);
            if (first.empty()) first = rows;
            ASSERT_TRUE(std::equal(rows.begin(), rows.end(), first.begin(), [](double a, double b) {
                return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
            }));
            for (std::size_t i = 0; i <= samples.pieces(); ++i) {
                const ThreadPoint at = samples[i], alone = threadPoint(line, at.t);
                const double turned = std::remainder(at.phi - alone.phi, 2.0 * std::acos(-1.0));
                off = std::max({off, (at.p - alone.p).norm(), (at.by_t - alone.by_t).norm(), std::abs(at.r - alone.r),
                                std::abs(turned) * alone.r, std::abs(at.r_by_t - alone.r_by_t),
                                std::abs(at.phi_by_t - alone.phi_by_t) * alone.r * alone.r});
                ++points;
            }
        }
    });
    EXPECT_GT(points, 10'000);
    EXPECT_LT(off, 1e-15);
}

TEST(ThreadHeights, AreThoseOfTheHighestFaceAndBoundWhatLiesAround) {
    // Truth: the lump's own function, at the points and around them.
    Random random(6);
    int told = 0, deep = 0;
    forEachPiece([&](const Curve& line, const LinePiece& piece, const std::vector<Lump>& lumps) {
        ThreadSamples samples;
        samples.take(line, piece);
        for (const Lump& lump : lumps) {
            std::vector<const Face*> others;
            const Face* flank = nullptr;
            for (const Face& face : lump.faces)
                face.kind == Face::Kind::Helicoid ? flank = &face : (others.push_back(&face), nullptr);
            const double reach = random.uniform() < 0.3 ? 0.0 : -2e-3 * random.uniform();
            ThreadHeights heights;
            heights.take(samples, others, flank, reach);
            for (const auto instructions : kInstructions) {
                if (instructions > field::bestInstructions()) continue;
                ThreadHeights again;
                again.take(samples, others, flank, reach, instructions);
                for (std::size_t i = 0; i <= samples.pieces(); ++i)
                    ASSERT_TRUE(again.value[i] == heights.value[i] && again.slope[i] == heights.slope[i] &&
                                again.bound[i] == heights.bound[i] && again.face[i] == heights.face[i]);
            }
            for (std::size_t i = 0; i <= samples.pieces(); ++i) {
                const ThreadPoint at = samples[i];
                const double value = valueOf(lump, at.p);
                // Where the function jumps the angle's last bit decides.
                if (std::abs(value - heights.value[i]) > 1e-12) continue;
                const Face& face = heights.face[i] == ThreadHeights::kFlank
                                       ? *flank
                                       : *others[static_cast<std::size_t>(heights.face[i])];
                ASSERT_NEAR(heights.slope[i], gradientOf(face, at.p).dot(at.by_t), 1e-12);
                ++told;
                if (!(heights.bound[i] > reach)) continue;
                const double room = heights.bound[i] - reach;
                for (int k = 0; k < 4; ++k) {
                    const Vec3 way(random.normal(), random.normal(), random.normal());
                    ASSERT_GT(valueOf(lump, at.p + 0.999 * room * random.uniform() * way.normalized()), reach - 1e-12);
                }
                deep += heights.value[i] < 0.0 ? 1 : 0;
            }
        }
    });
    EXPECT_GT(told, 10'000);
    EXPECT_GT(deep, 500);
}

}  // namespace
}  // namespace passung::closed_form
