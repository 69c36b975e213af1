#include "study/protocol/task_json.h"

#include "core/base/json.h"
#include "study/protocol/trial_types.h"

namespace passung::protocol {

std::string poseJson(const Pose& pose) {
    return JsonObject()
        .json("position_m", jsonVector(pose.p))
        .json("quaternion_wxyz", jsonNumbers({pose.q.w(), pose.q.x(), pose.q.y(), pose.q.z()}))
        .str();
}

namespace {

/// The keys between `target` and `timeout_s` of each type.
struct FormJson {
    JsonObject& json;

    void operator()(const plan::PegInHoleTask& task) const {
        json.number("clearance_m", task.clearance)
            .number("insertion_depth_m", task.insertion_depth)
            .number("success_fraction", task.success_fraction)
            .number("max_speed_m_per_s", task.max_speed)
            .number("hold_s", task.hold);
        const bool moved = !task.X_TMouth.p.isZero(0.0) || !task.X_TMouth.q.vec().isZero(0.0);
        if (moved) json.json("mouth", poseJson(task.X_TMouth));
    }
    void operator()(const plan::NarrowPassageTask& task) const {
        json.number("passage_length_m", task.length).number("passage_width_m", task.width);
    }
    void operator()(const plan::ContourFollowingTask& task) const {
        std::vector<std::string> points;
        for (const Vec3& point : task.points) points.push_back(jsonVector(point));
        json.json("points_m", jsonList(points))
            .number("reach_m", task.reach)
            .number("coverage", task.coverage)
            .number("force_N", task.force);
    }
    void operator()(const plan::FreePlacementTask& task) const {
        const Quat& q = task.X_WGoal.q;
        json.json("position_m", jsonVector(task.X_WGoal.p))
            .json("quaternion_wxyz", jsonNumbers({q.w(), q.x(), q.y(), q.z()}))
            .boolean("symmetric_about_z", task.round)
            .number("position_tolerance_m", task.position_tolerance)
            .number("angle_tolerance_rad", task.angle_tolerance);
    }
    void operator()(const plan::DiscriminationPairTask& task) const {
        json.number("interval_s", task.interval)
            .number("answer_s", task.answer)
            .text("question", task.question)
            .text("judged", plan::kJudgedNames[static_cast<std::size_t>(task.judged)]);
    }
    void operator()(const plan::AssemblyTask& task) const {
        std::vector<std::string> steps;
        for (const plan::AskedStep& step : task.steps) {
            JsonObject one;
            one.text("name", step.name)
                .number("insertion_m", step.insertion)
                .integer("hand", static_cast<std::int64_t>(step.hand));
            if (step.free_path) one.number("free_path_m", *step.free_path);
            steps.push_back(one.str());
        }
        json.json("steps", jsonList(steps)).boolean("hints", task.hints);
        if (task.hint_after > 0.0) json.number("hint_after_s", task.hint_after);
    }
};

}  // namespace

std::string taskJson(const plan::Task& task) {
    JsonObject json;
    json.text("type", typeOf(task).name);
    if (!task.target.empty()) json.text("target", task.target);
    std::visit(FormJson{json}, task.form);
    json.number("timeout_s", task.timeout).number("leave_radius_m", task.leave_radius);
    if (task.motion_bandwidth != plan::Task{}.motion_bandwidth)  // conditions of earlier versions stay what they are
        json.number("motion_bandwidth_hz", task.motion_bandwidth);
    if (const auto* peg = std::get_if<plan::PegInHoleTask>(&task.form))
        json.number("engagement_depth_m", peg->engagement_depth);
    return json.str();
}

}  // namespace passung::protocol
