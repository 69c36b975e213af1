#include <algorithm>

#include "analysis/truth/separation.h"

namespace passung::truth {

namespace {

bool isWithoutHollows(const shape::Shape& shape) {
    return std::holds_alternative<shape::Sphere>(shape) || std::holds_alternative<shape::Box>(shape) ||
           std::holds_alternative<shape::Cylinder>(shape) || std::holds_alternative<shape::Peg>(shape) ||
           std::holds_alternative<shape::SquarePeg>(shape);
}

/// Of the exact signed distance, by differences: outside a solid without hollows it is smooth.
Vec3 gradientAt(const shape::Shape& shape, const Vec3& p) {
    constexpr double h = 1e-6;  // [m]
    Vec3 gradient;
    for (int axis = 0; axis < 3; ++axis) {
        Vec3 e = Vec3::Zero();
        e[axis] = h;
        gradient[axis] = shape::signedDistance(shape, p + e) - shape::signedDistance(shape, p - e);
    }
    return gradient.normalized();
}

class BallAmongSolids : public Separation {
public:
    BallAmongSolids(double radius, std::span<const PlacedShape> obstacles)
        : radius_(radius), solids_(obstacles.begin(), obstacles.end()) {}

    bool rowsAt(const Pose& X_WG, double, double reach, std::vector<FreedomRow>& rows) const override {
        for (const auto& [shape, X_WS] : solids_) {
            const Vec3 p = X_WS.inverse() * X_WG.p;
            FreedomRow row{Eigen::Matrix<double, 6, 1>::Zero(), shape::signedDistance(shape, p) - radius_};
            if (row.gap > reach) continue;
            row.along.head<3>() = X_WS.q * gradientAt(shape, p);
            rows.push_back(row);
        }
        return true;
    }

private:
    double radius_;
    std::vector<PlacedShape> solids_;
};

}  // namespace

std::unique_ptr<Separation> separationOfBall(const shape::Shape& held, std::span<const PlacedShape> obstacles) {
    const auto* ball = std::get_if<shape::Sphere>(&held);
    if (ball == nullptr || !std::all_of(obstacles.begin(), obstacles.end(),
                                        [](const PlacedShape& solid) { return isWithoutHollows(solid.first); }))
        return nullptr;
    return std::make_unique<BallAmongSolids>(0.5 * ball->diameter, obstacles);
}

std::unique_ptr<Separation> separationOf(const shape::Shape& held, std::span<const PlacedShape> obstacles) {
    for (const auto make : {separationOfBall, separationOfPeg, separationOfPolyhedra})
        if (auto separation = make(held, obstacles)) return separation;
    return nullptr;
}

}  // namespace passung::truth
