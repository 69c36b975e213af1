#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "core/closed_form/pose_solver.h"
#include "core/closed_form/solid.h"
#include "tests/core/closed_form/thread_reference.h"
#include "tests/support/length.h"

// A bolt that is pressed or pulled along the axis of a nut that rubs: does it turn, and how far?

namespace passung::closed_form {
namespace {

constexpr double kRho = 1e-3;  // [m]: soft against turning
constexpr double kTurn = 2.0 * std::numbers::pi;

struct Size {
    double diameter, pitch;  // [m]
};
constexpr std::array kSizes{Size{.008, .00125}, Size{.02, .0045}, Size{.002, .0004}, Size{.012, .001}};
constexpr double kPlay = 40e-6;  // [m]
constexpr int kTicks = 500;
constexpr double kLean = 0.01;  // of the lead: a bolt leans to a side of its play

/// A bolt halfway in its nut, which is at rest.
struct RubbingThread {
    shape::ThreadBolt bolt;
    shape::ThreadNut nut;
    SmoothSolid of_bolt, of_nut;
    SolidPair pair;
    motion::Friction friction;
    PoseSolver solver;
    PoseMemory memory;
    Pose X;

    RubbingThread(const Size& size, double at_rest, double sliding, double flank_angle = shape::kIsoFlankAngle,
                  double flank_height = 0.0)
        : bolt{size.diameter, size.pitch, 2.0 * size.diameter, 0.0, kPlay, flank_angle, flank_height},
          nut{size.diameter, size.pitch, 1.6 * size.diameter, 0.8 * size.diameter, 0.0, 0.0, flank_angle, flank_height},
          of_bolt(*solidOf(bolt)),
          of_nut(*solidOf(nut)),
          pair{&of_bolt, &of_nut, {}, motion::Metric{kRho}},
          friction{at_rest, sliding},
          solver({&pair, 1}, {}, {&friction, 1}) {
        const double z = -1.2 * size.diameter;
        X = {rotationFromVector(Vec3(0, 0, std::remainder(z / lead(), kTurn))), {0, 0, z}};
    }

    double lead() const { return nut.pitch / kTurn; }
    ConstrainedPose follow(const Pose& hand) {
        const ConstrainedPose found = solver.solve(X, hand, memory, kThreadLooks);
        X = found.X_WG;
        return found;
    }
};

/// What a thread whose flanks touch at `radius` makes of a force F along its axis: the torque over F that it takes to
/// hold it from turning [m]. Below 0: it locks itself, and takes that much to be turned.
double torquePerForce(const RubbingThread& thread, double radius, double coefficient) {
    const double lambda = std::atan(thread.lead() / radius);
    const double normal = std::atan(std::tan(0.5 * thread.nut.flank_angle) * std::cos(lambda));
    return radius * std::tan(lambda - std::atan(coefficient / std::cos(normal)));
}
/// Above, such a thread locks itself: tan λ cos α_n.
double locksAbove(const RubbingThread& thread, double radius) {
    const double lambda = std::atan(thread.lead() / radius);
    return std::tan(lambda) * std::cos(std::atan(std::tan(0.5 * thread.nut.flank_angle) * std::cos(lambda)));
}
double crestOfNut(const RubbingThread& thread) {
    const double iso = 0.3125 * std::numbers::sqrt3 * thread.nut.pitch;
    return 0.5 * thread.nut.nominal_diameter - (thread.nut.flank_height > 0.0 ? thread.nut.flank_height : iso);
}
double crestOfBolt(const RubbingThread& thread) { return 0.5 * thread.bolt.nominal_diameter - thread.bolt.clearance; }

struct Pressed {
    double turn = 0.0;                 // since the flanks met [rad]
    double torque = 0.0, force = 0.0;  // of the spring in the end, over its stiffness [m²], [m]
    double most = 0.0;                 // of their ratio on the way, from a tenth of it on [m]
    double overlap = 0.0;              // [m]
    int unsettled = 0;                 // ticks
};

/// The hand goes by `way` along the axis, and stays there.
Pressed press(RubbingThread& thread, double way) {
    const Pose start = thread.X;
    Pose hand = start, met;
    Pressed result;
    bool meets = false;
    for (int tick = 0; tick < kTicks; ++tick) {
        hand.p.z() = start.p.z() + way * std::min(1.0, tick / 400.0);
        const ConstrainedPose found = thread.follow(hand);
        if (!meets && thread.memory.count > 0) met = thread.X;
        meets = meets || thread.memory.count > 0;
        if (!found.converged) ++result.unsettled;
        result.overlap = std::max(result.overlap, found.overlap);
        result.torque = kRho * kRho * rotationVector(thread.X.q * start.q.conjugate()).z();
        result.force = hand.p.z() - thread.X.p.z();
        if (tick >= 40) result.most = std::max(result.most, result.torque / result.force);
    }
    EXPECT_TRUE(meets);
    result.turn = rotationVector(thread.X.q * met.q.conjugate()).z();
    return result;
}

TEST(ThreadFriction, LocksAboveTheLeadAngleAndSlipsBelow) {
    // Truth: closed form (self-locking of a screw, µ = tan λ cos α_n; while it slips T = F r tan(λ - atan(µ / cos
    // α_n)), at a radius where flanks can touch).
    for (const Size& size : kSizes) {
        for (const double way : {-2e-3, 2e-3}) {
            for (const double share : {0.5, 0.9, 0.98}) {
                if (share == 0.9 && !test::atFullLength()) continue;
                const RubbingThread smooth(size, 0.0, 0.0);
                const double inner = crestOfNut(smooth), outer = crestOfBolt(smooth);
                const double slips = share * locksAbove(smooth, outer), locks = locksAbove(smooth, inner) / share;
                SCOPED_TRACE("M" + std::to_string(1e3 * size.diameter) + ", " + std::to_string(share));
                RubbingThread slippery(size, slips, slips), rough(size, locks, locks);
                const Pressed slid = press(slippery, way), held = press(rough, way);
                EXPECT_LT(std::abs(held.turn), 1e-5);
                const double told = slid.torque / slid.force;
                EXPECT_GE(told, torquePerForce(smooth, outer, slips) - kLean * smooth.lead());
                EXPECT_LE(told, torquePerForce(smooth, inner, slips) + kLean * smooth.lead());
                EXPECT_GT(torquePerForce(smooth, outer, slips), 0.0);
                for (const Pressed& pressed : {slid, held}) {
                    EXPECT_LE(pressed.overlap, kKeptOverlap);
                    EXPECT_LE(pressed.unsettled, kTicks / 3);  // kMostRubs ends them
                }
                std::printf("M%.0f x %.2f, %+.0f mm: µ %.4f: T/F %.4f of %.4f to %.4f mm; µ %.4f turns by %.0e\n",
                            1e3 * size.diameter, 1e3 * size.pitch, 1e3 * way, slips, 1e3 * told,
                            1e3 * torquePerForce(smooth, outer, slips), 1e3 * torquePerForce(smooth, inner, slips),
                            locks, held.turn);
            }
        }
    }
}

TEST(ThreadFriction, OfASquareThreadLocksAtItsLeadAngle) {
    // Truth: closed form (µ = tan λ, λ at the middle of flanks of 0.1 mm), within 2 %; dense points of both surfaces
    // against the profile (thread_reference.h)
    for (const Size& size : {Size{.008, .00125}, Size{.012, .001}, Size{.02, .0045}}) {
        const double lead = size.pitch / kTurn, lambda = lead / (0.5 * size.diameter - 50e-6);
        for (const double way : {-2e-3, 2e-3}) {
            constexpr double kFlanks = 2.0 * std::numbers::pi / 180.0;
            RubbingThread slippery(size, 0.98 * lambda, 0.98 * lambda, kFlanks, 1e-4);
            RubbingThread rough(size, 1.02 * lambda, 1.02 * lambda, kFlanks, 1e-4);
            const Pressed slid = press(slippery, way), held = press(rough, way);
            EXPECT_LT(std::abs(held.turn), 1e-5);
            EXPECT_GT(slid.torque / slid.force, 0.0);
            EXPECT_LT(slid.torque / slid.force, 0.06 * lead);
            const ThreadReference truth(rough.bolt, rough.nut, 6000, 1);
            for (const Pose& X : {slippery.X, rough.X}) EXPECT_LE(truth.overlap(X), 1e-7);
            std::printf(
                "M%.0f x %.2f square, %+.0f mm: T/F %.4f lead at 0.98 tan λ, turns by %.0e at 1.02; %d, %d unsettled\n",
                1e3 * size.diameter, 1e3 * size.pitch, 1e3 * way, slid.torque / slid.force / lead, held.turn,
                slid.unsettled, held.unsettled);
        }
    }
}

TEST(ThreadFriction, StartsAgainstTheFrictionAtRestAndGoesOnAgainstThatOfSliding) {
    // Truth: closed form (as above)
    for (const Size& size : kSizes) {
        const RubbingThread smooth(size, 0.0, 0.0);
        const double inner = crestOfNut(smooth), outer = crestOfBolt(smooth);
        const double at_rest = 0.95 * locksAbove(smooth, outer), sliding = 0.6 * at_rest;
        RubbingThread thread(size, at_rest, sliding);
        const Pressed slid = press(thread, -2e-3);
        const double told = slid.torque / slid.force;
        EXPECT_GE(told, torquePerForce(smooth, outer, at_rest) - kLean * smooth.lead());
        EXPECT_LE(told, torquePerForce(smooth, inner, sliding) + kLean * smooth.lead());
        EXPECT_GE(slid.most, torquePerForce(smooth, outer, sliding) - kLean * smooth.lead());
        EXPECT_LE(slid.most, torquePerForce(smooth, inner, sliding) + kLean * smooth.lead());
        std::printf("M%.0f: T/F up to %.4f, in the end %.4f of %.4f (sliding) or %.4f mm\n", 1e3 * size.diameter,
                    1e3 * slid.most, 1e3 * told, 1e3 * torquePerForce(smooth, inner, sliding),
                    1e3 * torquePerForce(smooth, outer, at_rest));
    }
}

}  // namespace
}  // namespace passung::closed_form
