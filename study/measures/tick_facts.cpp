#include "study/measures/tick_facts.h"

#include <cmath>

namespace passung::measures {
namespace {

constexpr double kNoForce = 1e-6;   // [N]
constexpr double kNoTorque = 1e-9;  // [N·m]

Vec3 toVec3(const std::array<float, 3>& values) { return {values[0], values[1], values[2]}; }

Pose toPose(const std::array<float, 3>& p, const std::array<float, 4>& q) {
    return {Quat(q[0], q[1], q[2], q[3]).normalized(), toVec3(p)};
}

}  // namespace

bool isContact(const TickRecord& record) {
    const bool wrench = toVec3(record.force_N).norm() > kNoForce || toVec3(record.torque_Nm).norm() > kNoTorque;
    return record.contacts > 0 || (wrench && (record.status & (kWeighed | kAidedInAir)) == 0) ||
           ((record.status & kWrenchWithheld) != 0 && record.hand_depth_m > 0.0f);
}

std::optional<double> tipDepthInBore(const TickRecord& record, const Pose& X_TW, double clearance) {
    const Vec3 p_TG = X_TW * proxyPosition(record);
    if (!(p_TG.z() <= 0.0 && std::hypot(p_TG.x(), p_TG.y()) <= clearance + kWallGive)) return std::nullopt;
    return -p_TG.z();
}

bool isClearOfWalls(const TickRecord& record) { return record.proxy_depth_m <= kWallGive; }

Pose handPose(const TickRecord& record) { return toPose(record.hand_position_m, record.hand_quaternion); }

Pose proxyPose(const TickRecord& record) { return toPose(record.proxy_position_m, record.proxy_quaternion); }

Vec3 handPosition(const TickRecord& record) { return toVec3(record.hand_position_m); }

Vec3 proxyPosition(const TickRecord& record) { return toVec3(record.proxy_position_m); }

}  // namespace passung::measures
