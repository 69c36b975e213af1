#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "analysis/truth/force_reference.h"
#include "core/surface/surface_proxy.h"
#include "core/tick/hand_model.h"
#include "core/tick/hand_state.h"
#include "tests/hard/dense_overlap.h"
#include "tests/hard/found.h"
#include "tests/support/mesh_crossing.h"

namespace passung::hard {

/// What geometry says about a run, tick by tick; sums and worst values over runs.
struct Seen {
    std::size_t ticks = 0, poses = 0, pressed = 0;  // pressed: ticks in contact
    std::size_t crossings = 0, between = 0;         // poses at which triangles cross: shown ones, on the way to them
    double overlap = 0.0, overlap_between = 0.0;    // of shapes [m]
    std::size_t gaps_too_high = 0, gaps = 0, gaps_loose = 0;  // told: above the exact one; under a row; far below it
    std::size_t suspended = 0, suspended_in_a_row = 0, hanging = 0, not_finite = 0;
    double lag = 0.0;  // [m]
    // Of the force from tick to tick [N]: of the spring once a peg is in its bore, beyond the hand's, as sent.
    double step = 0.0, beyond = 0.0, sent = 0.0;
    double axial = 0.0, speed = 0.0;  // [N], of the hand [m/s]
    std::size_t catches = 0;          // of a tilted peg
    double off = 0.0;                 // from the reference's force [N]
    std::size_t referenced = 0;

    void take(const Seen& more);
};

/// Judges each tick of a run by exact geometry: triangles against triangles as they were made, shapes by dense points
/// and exact distances.
class FoundOnlooker {
public:
    /// `full`: the way between accepted poses is judged in every tick.
    FoundOnlooker(const Found& found, const FoundScene& scene, bool full);
    FoundOnlooker(const FoundOnlooker&) = delete;  // distances point into it

    void look(const tick::HandModel& model, const tick::HandState& state, const tick::TickOutput& output);
    const Seen& seen() const { return seen_; }

private:
    void lookAtWay(const tick::HandModel& model, const tick::HandState& state);
    void judgePose(const Pose& X, bool between);
    void lookAtGap(const tick::TickOutput& output);
    void lookAtForce(const tick::HandModel& model, const tick::TickOutput& output);
    void lookAtLag(const tick::HandModel& model, const tick::TickOutput& output);

    const Found& found_;
    const FoundScene& scene_;
    bool full_;
    truth::ForceReference reference_;
    std::optional<test::MeshPairTruth> triangles_;
    std::unique_ptr<DenseDistance> shown_, way_;
    std::optional<surface::SurfaceProxy> unlimited_;  // of the program without a cap: how far the capped one lags
    std::size_t lags_ = 0;                            // ticks that it was asked in
    Seen seen_;
    std::size_t tick_ = 0, suspended_ = 0, since_suspended_ = 1000;
    bool hung_ = false, caught_ = false;
    Pose X_WH_, X_WG_;  // of the tick before
    Vec3 spring_ = Vec3::Zero(), sent_ = Vec3::Zero();
};

}  // namespace passung::hard
