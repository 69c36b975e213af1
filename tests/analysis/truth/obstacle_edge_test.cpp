#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "analysis/truth/exact_mesh.h"
#include "core/base/random.h"
#include "core/field/distance_field.h"
#include "core/shape/shape.h"
#include "tests/support/scenes.h"

// The tick tests the held part's sample points against the obstacles' fields and not the reverse, so that an obstacle's
// edge may stand between two points. How much of the true overlap that can hide, and how much it does hide:
//
// An obstacle's edge or corner x is δ deep behind a flat face of the held part. The obstacle holds the cone of
// half-angle α about the way straight out from x through that face. Some sample lies on the face within the cover
// radius c of the foot of x, thus δ up that axis and at most c beside it; its depth in the cone, and so in the
// obstacle, is
//     d ≥ δ sin α - c cos α    so that    δ ≤ d / sin α + c / tan α.
// A box's corner standing upright has α = asin(1/√3) = 35.3°, its edge 45°. A needle (α → 0) is never seen: no spacing
// bounds the overlap of an arbitrarily sharp obstacle.

namespace passung {
namespace {

constexpr double kCell = 0.5e-3, kSpacing = 1e-3;
constexpr double kResolution = 5e-6;  // of the true depths
constexpr double kChord = 2e-6;       // of the meshes that the truth is computed on

struct Overlap {
    double recorded = 0.0;  // what the tick says
    double sampled = 0.0;   // closed form at the shell's points
    double dense = 0.0;     // both surfaces, all of them; at least this, at most kResolution + chords more
};

/// Overlap of a held shape and a fixed one by three means.
class OverlapMeter {
public:
    OverlapMeter(const shape::Shape& held, const shape::Shape& fixed, const test::Bench& bench, const Pose& X_WFixed)
        : fixed_(fixed),
          held_mesh_(shape::tessellate(held, kChord)),
          fixed_mesh_(shape::tessellate(fixed, kChord)),
          bench_(bench),
          X_FixedW_(X_WFixed.inverse()) {}

    Overlap at(const tick::TickOutput& out) const {
        const Pose X_FS = X_FixedW_ * out.X_WG;
        Overlap overlap;
        overlap.recorded = tick::makeRecord(0, {}, out).proxy_depth_m;
        for (const auto& point : bench_.model().shell->points()) {
            overlap.sampled = std::max(overlap.sampled, -shape::signedDistance(fixed_, X_FS * point.position));
        }
        overlap.dense =
            std::max(truth::deepestPoint(fixed_mesh_, held_mesh_, X_FS, kResolution, 300'000).depth,
                     truth::deepestPoint(held_mesh_, fixed_mesh_, X_FS.inverse(), kResolution, 300'000).depth);
        return overlap;
    }

    /// What the field may hide of the samples' true depth: its error at the deepest one.
    double fieldError(const tick::TickOutput& out) const {
        const Pose X_FS = X_FixedW_ * out.X_WG;
        double deepest = 0.0, error = 0.0;
        for (const auto& point : bench_.model().shell->points()) {
            const Vec3 p = X_FS * point.position;
            const double depth = -shape::signedDistance(fixed_, p);
            if (depth <= deepest) continue;
            deepest = depth;
            error = bench_.model().obstacles.front().field->errorBound(p, bench_.model().contact.mode);
        }
        return error;
    }

private:
    shape::Shape fixed_;
    truth::ExactMesh held_mesh_, fixed_mesh_;
    const test::Bench& bench_;
    Pose X_FixedW_;
};

double tiltOf(const Pose& X_WG) { return std::acos(std::clamp((X_WG.q * Vec3::UnitZ()).z(), -1.0, 1.0)); }

struct Worst {
    Overlap overlap;      // where the gap is largest
    double gap = 0.0;     // dense - recorded [m]
    double share = 0.0;   // of the bound that dense overlap reaches
    int overlapping = 0;  // evaluations with more overlap than the resolution

    void see(const Overlap& o, double bound) {
        overlapping += o.dense > kResolution ? 1 : 0;
        share = std::max(share, o.dense / bound);
        if (o.dense - o.recorded <= gap) return;
        gap = o.dense - o.recorded;
        overlap = o;
    }
    void print(const char* what, double cover) const {
        std::printf(
            "%-34s true overlap %.3f mm, at the samples %.3f mm, recorded %.3f mm; hidden at most %.3f mm; cover "
            "radius %.2f mm (spacing %.1f mm); up to %.0f %% of what the bound allows\n",
            what, overlap.dense * 1e3, overlap.sampled * 1e3, overlap.recorded * 1e3, gap * 1e3, cover * 1e3,
            kSpacing * 1e3, 100 * share);
    }
};

/// A peg's flat tip is lowered by 3 mm onto the upright edge or corner of a box; `upright` turns the box.
void lowerOnto(const char* what, const Quat& upright, const Vec3& sharp, double cone, double least_gap) {
    const shape::Shape peg = shape::Peg{0.02, 0.03, 0.0}, box = shape::Box{0.02, 0.02, 0.02};
    for (const auto method : {scene::ContactMethod::Penalty, scene::ContactMethod::GodObjectHeuristic}) {
        Random random(11);
        Worst worst;
        double cover = 0.0;
        for (int run = 0; run < 12; ++run) {
            const Vec3 apex(random.uniform(-4e-3, 4e-3), random.uniform(-4e-3, 4e-3), 0.0);
            const Quat turn = Eigen::AngleAxisd(random.uniform(0.0, 6.28), Vec3::UnitZ()) * upright;
            const Pose X_WBox{turn, apex - turn * sharp};
            auto spec = test::scene(peg, {Quat::Identity(), Vec3(0, 0, 2e-3)}, box, X_WBox, method);
            spec.contact.cell = kCell;
            spec.contact.spacing = kSpacing;
            test::Bench bench(spec);
            const OverlapMeter meter(peg, box, bench, X_WBox);
            cover = bench.model().shell->coverRadius();
            for (int i = 0; i <= 500; ++i) {
                const auto out = bench.step(Pose{Quat::Identity(), Vec3(0, 0, 2e-3 - 1e-5 * i)});
                if (i < 200 || i % 25 != 0) continue;
                const Overlap overlap = meter.at(out);
                const double alpha = cone - tiltOf(out.X_WG);
                const double bound =
                    overlap.sampled / std::sin(alpha) + cover / std::tan(alpha) + kResolution + 3 * kChord;
                ASSERT_LE(overlap.dense, bound) << what << " run " << run << " tick " << i;
                ASSERT_LE(overlap.sampled, overlap.recorded + meter.fieldError(out) + 1e-9) << what << " run " << run;
                worst.see(overlap, bound);
            }
        }
        const bool god_object = method == scene::ContactMethod::GodObjectHeuristic;
        worst.print((std::string(what) + (god_object ? ", god object" : ", penalty")).c_str(), cover);
        EXPECT_GT(worst.overlapping, 40);
        if (god_object) {
            EXPECT_GT(worst.gap, least_gap) << "less is hidden than the texts warn of";
        }
    }
}

TEST(ObstacleEdge, ABoxCornerUnderAFlatFaceHidesNoMoreThanTheCoverRadiusAllows) {
    // Truth: independent dense geometry (branch and bound over both surfaces) and closed form of the box at the samples
    const Quat upright = rotationBetween(Vec3(1, 1, 1), Vec3::UnitZ());
    lowerOnto("corner of a box", upright, Vec3(0.01, 0.01, 0.01), std::asin(1.0 / std::sqrt(3.0)), 0.1e-3);
}

TEST(ObstacleEdge, ABoxEdgeUnderAFlatFaceHidesNoMoreThanTheCoverRadiusAllows) {
    // Truth: independent dense geometry (branch and bound over both surfaces) and closed form of the box at the samples
    const Quat upright = rotationBetween(Vec3(1, 0, 1), Vec3::UnitZ());
    lowerOnto("edge of a box", upright, Vec3(0.01, 0.0, 0.01), std::numbers::pi / 4, 0.05e-3);
}

TEST(ObstacleEdge, APegTiltedInAChamferedBoreHidesAlmostNothing) {
    // Truth: independent dense geometry (branch and bound over both surfaces). The bore's edge below the chamfer
    // presses into the peg's side, δ deep, the peg tilted by t: the overlap runs along the wall, which leaves the peg's
    // side at the angle t only. A sample lies within c of the point of the side that is c below the edge, so at most 2
    // c below the edge and c around: there the side is still
    //     δ - 2 c tan t - (2 c)²/2 (1/R_peg - 1/R_bore)
    // behind the wall's surface, and the distance to the nearer of wall and chamfer (45°) is at least cos(45° + t) of
    // that. Hence  δ ≤ d / cos(45° + t) + 2 c tan t + 2 c² (1/R_peg - 1/R_bore).  The same holds, without the cosine,
    // for the peg's rim in the wall.
    const shape::Peg peg{0.02, 0.04, 0.001};
    const shape::BorePlate plate{0.04, 0.04, 0.02, 0.0202, 0.02, 0.001};
    const double curvature = 2.0 / peg.diameter - 2.0 / plate.bore_diameter;
    for (const auto method : {scene::ContactMethod::Penalty, scene::ContactMethod::GodObjectHeuristic}) {
        const Pose X_WPlate{rotationFromVector(Vec3(0, 0, 0.3)), Vec3(0.0011, -0.0007, 0.0003)};  // off the grid
        const Pose start{Quat::Identity(), Vec3(0, 0, -0.012)};
        auto spec = test::scene(peg, X_WPlate * start, plate, X_WPlate, method);
        spec.contact.cell = kCell;
        spec.contact.spacing = kSpacing;
        spec.contact.stiffness = 4000;
        spec.contact.rotational_stiffness = 1;
        test::Bench bench(spec);
        const OverlapMeter meter(peg, plate, bench, X_WPlate);
        const double c = bench.model().shell->coverRadius();
        Worst worst;
        for (int i = 0; i < 3000; ++i) {
            const double s = 1e-3 * i, grow = std::min(1.0, s);
            const Vec3 push = grow * 3e-4 * Vec3(std::cos(3 * s), std::sin(3 * s), 0);
            const Vec3 tilt = grow * 0.02 * Vec3(std::sin(5 * s), std::cos(4 * s), 0);
            const auto out = bench.step(X_WPlate * Pose{rotationFromVector(tilt), start.p + push});
            if (i % 100 != 0) continue;
            const Overlap overlap = meter.at(out);
            const double t = tiltOf(X_WPlate.inverse() * out.X_WG);
            const double bound = overlap.sampled / std::cos(std::numbers::pi / 4 + t) + 2 * c * std::tan(t) +
                                 2 * c * c * curvature + kResolution + 3 * kChord;
            ASSERT_LE(overlap.dense, bound) << "tick " << i << " tilt " << t;
            ASSERT_LE(overlap.sampled, overlap.recorded + meter.fieldError(out) + 1e-9) << "tick " << i;
            worst.see(overlap, bound);
        }
        const bool god_object = method == scene::ContactMethod::GodObjectHeuristic;
        worst.print(god_object ? "peg in a bore, god object" : "peg in a bore, penalty", c);
        EXPECT_GT(worst.overlapping, god_object ? 5 : 20);
    }
}

}  // namespace
}  // namespace passung
