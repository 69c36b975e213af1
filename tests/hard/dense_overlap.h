#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "core/base/types.h"
#include "core/shape/shape.h"

namespace passung::hard {

/// A body as independent geometry: points all over its surface, and its exact signed distance [m]; part frame. The
/// points are none of the solver's: edges are sampled every hundredth of the body's size or finer, faces at `spacing`.
struct DenseBody {
    std::vector<Vec3> points;
    std::function<double(const Vec3&)> distance;  // of a sheet ≥ 0: it has no inside
};

DenseBody denseBody(const shape::Shape& shape, double spacing);

/// The least signed distance between a moving body and fixed ones, both ways: its points from them and theirs from it.
///
/// Every point is looked at only as often as it could be nearer than what is asked: a signed distance changes by no
/// more than the moving body's points do.
class DenseDistance {
public:
    DenseDistance(DenseBody moving, std::vector<std::pair<DenseBody, Pose>> fixed);
    DenseDistance(const DenseDistance&) = delete;  // its sides point into it

    /// At this pose [m], < 0 for overlap; `enough` if it is not less.
    double least(const Pose& X_WM, double enough);

private:
    struct Side {
        const std::vector<Vec3>* points;
        const std::function<double(const Vec3&)>* distance;
        std::size_t fixed;          // its place in fixed_
        bool moving;                // these are the moving body's points
        std::vector<double> bound;  // of a block: its least distance and the path when it was found
    };

    DenseBody moving_;
    std::vector<std::pair<DenseBody, Pose>> fixed_;
    std::vector<Side> sides_;
    double reach_ = 0.0, path_ = 0.0;
    bool placed_ = false;
    Pose last_;
};

}  // namespace passung::hard
