#include "core/query/overlap_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/query/triangle_pieces.h"

namespace passung::query {

using geometry::TriangleCorners;

namespace {

constexpr std::size_t kMostPerPiece = 5;  // steps
constexpr double kClearCut = 1e-3;        // of the piece's length

/// The ways out that are tried for one piece differ by more than this cosine.
constexpr double kSameWay = 0.999;

}  // namespace

bool MeshSolid::isInside(const Vec3& p) const {
    if (field.sheetOffset() != 0.0) return false;
    const double phi = field.sample(p, field::FieldMode::Trilinear).phi;
    const double error = field.errorBound(p, field::FieldMode::Trilinear) + slack;
    return phi + error < 0.0 || (phi - error <= 0.0 && triangles.inside(p));
}

geometry::ClosestPoint MeshSolid::look(const Vec3& p, SearchProgress& progress) const {
    const geometry::ClosestPoint near = triangles.closest(p);
    ++progress.found.steps;
    // Only what would be deeper, or nearer, than what is known needs a sign.
    if (-near.distance < progress.found.upper)
        progress.offer(isInside(p) ? -near.distance : near.distance, p, near.point);
    return near;
}

/// True if the whole piece, moved by `step`, is outside.
bool OverlapSearch::isOutsideAfter(const TriangleCorners& piece, const Vec3& step) const {
    const TriangleCorners moved{Vec3(piece[0] + step), Vec3(piece[1] + step), Vec3(piece[2] + step)};
    const double touch = 4.0 * solid_.rounding;
    // What is inside at its middle needs no search for triangles.
    if (solid_.isInside(geometry::centroid(moved))) return false;
    return !(solid_.triangles.closestTo(moved, touch).distance < touch);
}

bool OverlapSearch::findsWayOut(const Piece& piece, const Vec3& middle, const geometry::ClosestPoint& near) {
    const double length = -progress_.goal() - solid_.rounding;
    if (!(length > 0.0)) return false;
    std::array<Vec3, 3> ways{near.point - middle, at_middle_.normal, progress_.found.normal};
    if (ways[0].dot(at_middle_.normal) < 0.0) ways[0] = -ways[0];
    for (std::size_t i = 0; i < ways.size(); ++i) {
        ways[i] = ways[i].stableNormalized();
        if (!(ways[i].squaredNorm() > 0.5)) continue;
        bool tried = false;
        for (std::size_t k = 0; k < i; ++k) tried = tried || ways[k].dot(ways[i]) > kSameWay;
        if (tried) continue;
        ++progress_.found.steps;
        if (isOutsideAfter(piece.corners, length * ways[i])) return true;
    }
    return false;
}

/// No less than this is φ_A on the piece [m].
double OverlapSearch::lowerBound(const Piece& piece) {
    const Vec3 middle = geometry::centroid(piece.corners);
    const geometry::ClosestPoint near = solid_.look(middle, progress_);
    const double reach = geometry::farthestCorner(middle, piece.corners);
    double lower = std::max(piece.lower, -near.distance - reach - solid_.rounding);
    const FarthestCorner deepest = farthestFrom(solid_.triangles.cornersOf(near), piece.corners);
    lower = std::max(lower, -deepest.distance - solid_.rounding);
    if (lower >= progress_.goal()) return lower;
    const geometry::ClosestPoint beside = solid_.look(piece.corners[deepest.corner], progress_);
    lower =
        std::max(lower, -farthestFrom(solid_.triangles.cornersOf(beside), piece.corners).distance - solid_.rounding);
    if (lower >= progress_.goal()) return lower;
    at_middle_ = faceAt(near);
    at_corner_ = faceAt(beside);
    if (findsWayOut(piece, middle, near)) return std::max(lower, progress_.goal());
    // Outside, and farther from the surface than it reaches.
    if (near.distance > reach + solid_.rounding && !solid_.isInside(middle)) return 0.0;
    return lower;
}

OverlapSearch::Face OverlapSearch::faceAt(const geometry::ClosestPoint& near) const {
    const TriangleCorners t = solid_.triangles.cornersOf(near);
    return {near.point, (t[1] - t[0]).cross(t[2] - t[0]).stableNormalized()};
}

void OverlapSearch::split(const Piece& piece) {
    std::array<double, 3> farther;  // how much deeper below the face at the middle than below that at the corner
    for (std::size_t i = 0; i < 3; ++i)
        farther[i] = at_middle_.normal.dot(at_middle_.point - piece.corners[i]) -
                     at_corner_.normal.dot(at_corner_.point - piece.corners[i]);
    const auto [least, most] = std::minmax_element(farther.begin(), farther.end());
    // Where it is all but zero at a corner the part there would be a sliver.
    const double clear = kClearCut * geometry::farthestCorner(piece.corners[0], piece.corners);
    if (*least<-clear&& * most> clear) {
        for (const TriangleCorners& part : partsAtZero(piece.corners, farther)) pieces_.push({piece.lower, part});
        return;
    }
    for (const TriangleCorners& half : halves(piece.corners)) pieces_.push({piece.lower, half});
}

void OverlapSearch::run() {
    while (!pieces_.empty() && !progress_.leave(pieces_.top().lower) && progress_.maySpend(kMostPerPiece)) {
        Piece piece = pieces_.top();
        pieces_.pop();
        piece.lower = lowerBound(piece);
        if (progress_.leave(piece.lower)) continue;
        split(piece);
    }
    if (!pieces_.empty()) progress_.left = std::min(progress_.left, pieces_.top().lower);
}

}  // namespace passung::query
