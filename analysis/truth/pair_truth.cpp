#include "analysis/truth/pair_truth.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace passung::truth {

namespace {

constexpr double kTolerance = 5e-6;  // of the tessellations [m]: their chord error is a twentieth of that
constexpr double kRoughTolerance = 20.0 * kTolerance;
constexpr double kResolution = 1e-6;  // of the depth [m]
constexpr std::size_t kQuickPieces = 20'000;
constexpr double kDenseShare = 1.0 / 250;  // of SHELL's longest side: pieces of the dense sum
constexpr double kCoarser = 2.0;           // a second sum, for the uncertainty of the first; a quick sum

Result<scene::Part> surfaceOf(const scene::PartSpec& spec, double tolerance, scene::BuildStore* store) {
    auto part = scene::buildPart(spec, {.tolerance = tolerance}, store);
    if (part && part->mesh.triangles.empty()) return Error{.message = "has no triangles", .file = spec.name};
    return part;
}

}  // namespace

Result<PairTruth> PairTruth::build(const scene::PartSpec& field, const scene::PartSpec& shell,
                                   scene::BuildStore* store) {
    auto truth = build(field, shell, kTolerance, store);
    if (!truth || !(truth->field_.shape || truth->shell_.shape)) return truth;
    auto rough = build(field, shell, kRoughTolerance, store);
    if (!rough) return rough.errors();
    truth->rough_ = std::make_unique<PairTruth>(std::move(*rough));
    return truth;
}

Result<PairTruth> PairTruth::build(const scene::PartSpec& field, const scene::PartSpec& shell, double tolerance,
                                   scene::BuildStore* store) {
    auto a = surfaceOf(field, tolerance, store);
    if (!a) return a.errors();
    auto b = surfaceOf(shell, tolerance, store);
    if (!b) return b.errors();
    if (!a->report.watertight)
        return Error{.message = "must be watertight to be FIELD: without an inside there is no true depth or force",
                     .file = field.name};
    return PairTruth(std::move(*a), std::move(*b));
}

PairTruth::PairTruth(scene::Part field, scene::Part shell)
    : field_(std::move(field)),
      shell_(std::move(shell)),
      oracle_(std::make_unique<MeshOracle>(field_.mesh, shell_.mesh)),
      surface_(std::make_unique<SurfaceTree>(oracle_->b())) {
    for (const Vec3& v : shell_.mesh.vertices) lever_ = std::max(lever_, v.norm());
}

PoseTruth PairTruth::relationAt(const Pose& X_FS) const {
    PoseTruth truth;
    truth.separation = *oracle_->separation(X_FS);
    truth.distance = std::numeric_limits<double>::quiet_NaN();
    truth.uncertainty = field_.chord_error + shell_.chord_error;
    if (*oracle_->surfacesIntersect(X_FS)) {
        truth.relation = Relation::SurfacesIntersect;
    } else if (oracle_->a().contains(X_FS * oracle_->b().triangles().front()[0])) {
        truth.relation = Relation::BInsideA;
    } else {
        const bool around =
            shell_.report.watertight && oracle_->b().contains(X_FS.inverse() * oracle_->a().triangles().front()[0]);
        truth.relation = around ? Relation::AInsideB : Relation::Apart;
        // A separation of 0 contradicts that nothing meets: then the distance is left to exact geometry.
        if (truth.separation > 0.0) truth.distance = truth.separation;
    }
    return truth;
}

PoseTruth PairTruth::distanceAt(const Pose& X_FS, double resolution, std::size_t max_pieces) const {
    PoseTruth truth = relationAt(X_FS);
    if (!std::isnan(truth.distance)) return truth;
    const SmallestDistance found = surface_->smallestDistance(solid(), X_FS, resolution, max_pieces);
    truth.distance = found.value;
    truth.uncertainty += found.uncertainty;
    return truth;
}

void PairTruth::addWrench(const Pose& X_FS, double edge, PoseTruth& truth) const {
    if (!truth.inContact()) return;
    truth.wrench = surface_->penaltyWrench(solid(), X_FS, kAreaStiffness, edge);
    const Wrench coarse = surface_->penaltyWrench(solid(), X_FS, kAreaStiffness, kCoarser * edge);
    const double size = truth.wrench.force.norm();
    if (!(size > 0.0)) return;
    // The midpoint rule errs as edge²: the finer sum by a third of the difference. The chords take depth away besides.
    const double change =
        std::max((truth.wrench.force - coarse.force).norm(), (truth.wrench.torque - coarse.torque).norm() / lever_);
    truth.wrench_uncertainty = change / size / (kCoarser * kCoarser - 1.0);
}

PoseTruth PairTruth::quicklyAt(const Pose& X_FS) const {
    PoseTruth truth = distanceAt(X_FS, kResolution, kQuickPieces);
    addWrench(X_FS, kCoarser * kDenseShare * length(), truth);
    return truth;
}

PoseTruth PairTruth::at(const Pose& X_FS) const {
    PoseTruth truth = distanceAt(X_FS, kResolution);
    addWrench(X_FS, kDenseShare * length(), truth);
    return truth;
}

PoseTruth bothWays(const PoseTruth& there, const PoseTruth& back, const Pose& X_FS) {
    PoseTruth both = there;
    both.distance = std::min(there.distance, back.distance);
    both.uncertainty = std::max(there.uncertainty, back.uncertainty);
    both.wrench_uncertainty = std::max(there.wrench_uncertainty, back.wrench_uncertainty);
    // `back` is on FIELD about FIELD's origin, in SHELL's axes: turned, moved to SHELL's origin, and its reaction.
    const Vec3 force = -(X_FS.q * back.wrench.force);
    const Vec3 torque = -(X_FS.q * back.wrench.torque) - X_FS.p.cross(force);
    both.wrench = {0.5 * (there.wrench.force + force), 0.5 * (there.wrench.torque + torque)};
    return both;
}

}  // namespace passung::truth
