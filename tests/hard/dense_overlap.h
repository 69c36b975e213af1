#pragma once

#include <functional>
#include <vector>

#include "core/base/types.h"
#include "core/model/shape.h"

namespace passung::hard {

/// A body as independent geometry: points all over its surface, and its exact signed distance [m]; part frame. The
/// points are none of the solver's: edges are sampled every hundredth of the body's size or finer, faces at `spacing`.
struct DenseBody {
    std::vector<Vec3> points;
    std::function<double(const Vec3&)> distance;  // of a sheet ≥ 0: it has no inside
};

DenseBody denseBody(const model::Shape& shape, double spacing);

/// Several shapes in one frame as one body; they may overlap, so that its points inside another shape count for less.
DenseBody denseUnion(const std::vector<std::pair<model::Shape, Pose>>& shapes, double spacing);

/// How deep a moving body ever was in fixed ones, both ways: its points in them and theirs in it.
///
/// Every point is looked at as often as it could be deeper than the deepest so far: a signed distance changes by no
/// more than the moving body's points do, so that a point with φ rests until they have moved by φ + deepest.
class DenseOverlap {
public:
    DenseOverlap(DenseBody moving, std::vector<std::pair<DenseBody, Pose>> fixed);
    DenseOverlap(const DenseOverlap&) = delete;  // its sides point into it

    /// At this pose, and at `between` poses since the last one (straight and by slerp).
    void see(const Pose& X_WM, int between = 1);

    double deepest() const { return deepest_; }  // [m], ≥ 0
    std::int64_t poses() const { return poses_; }

private:
    struct Side {
        const std::vector<Vec3>* points;
        const std::function<double(const Vec3&)>* distance;
        std::size_t fixed;  // its place in fixed_
        bool moving;        // these are the moving body's points
        std::vector<double> wake;
    };
    void look(const Pose& X_WM);

    DenseBody moving_;
    std::vector<std::pair<DenseBody, Pose>> fixed_;
    std::vector<Side> sides_;
    double reach_ = 0.0, path_ = 0.0, deepest_ = 0.0;
    Pose last_;
    std::int64_t poses_ = 0;
};

}  // namespace passung::hard
