#include "devices/host/library_pose.h"

namespace passung::host {
namespace {

constexpr double kOrthonormal = 1e-3;

}  // namespace

unit::Exchange saidPose(const Mat3& R, const Vec3& p, const unit::Axes& axes) {
    using Kind = unit::Exchange::Kind;
    if (!p.allFinite() || !R.allFinite()) return {Kind::Wrong, {}, "a value is no finite number"};
    if (p.norm() > kFarthest)
        return {Kind::Wrong, {}, "its position is beyond any device's reach: does the library count in mm?"};
    const double flaw = (R * R.transpose() - Mat3::Identity()).cwiseAbs().maxCoeff();
    if (flaw > kOrthonormal || R.determinant() < 0.0) return {Kind::Wrong, {}, "its orientation is no rotation"};
    unit::Exchange exchange{Kind::News, {}, {}};
    exchange.said.X_BD = axes.toBase(Pose{Quat(R).normalized(), p});
    return exchange;
}

}  // namespace passung::host
