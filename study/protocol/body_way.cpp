#include "study/protocol/body_way.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "study/protocol/scene_node.h"
#include "study/protocol/scene_parts.h"

namespace passung::protocol {
namespace {

constexpr int kLattice = 4;              // steps from the middle of a sphere to its surface
constexpr double kHalfDiagonal = 0.867;  // of a cube with edge 1, rounded up
constexpr int kMostCells = 48;           // along the longest side of the grid
constexpr int kDepths = 32;              // of a passage
constexpr int kPlaces = 200;             // on a line

/// Obstacles as one distance.
class Obstacles {
public:
    Obstacles(const model::SceneSpec& scene, PartGeometries& geometries) : geometries_(geometries) {
        for (const model::PartSpec& part : scene.parts)
            if (!part.held && geometries.of(part) != nullptr) parts_.push_back(&part);
    }

    bool none() const { return parts_.empty(); }

    /// From all of them [m]; negative inside.
    double distance(const Vec3& p) const {
        double least = 1e9;
        for (const model::PartSpec* part : parts_)
            least = std::min(least, geometries_.signedDistance(*part, part->X_WP.inverse() * p));
        return least;
    }

    /// Is there a place within `reach` of `centre` where the distance may be `needed`?
    bool roomWithin(const Vec3& centre, double reach, double needed) const {
        if (distance(centre) >= needed) return true;
        if (distance(centre) + reach < needed) return false;
        const double step = reach / kLattice, enough = needed - kHalfDiagonal * step;
        for (int i = -kLattice; i <= kLattice; ++i)
            for (int j = -kLattice; j <= kLattice; ++j)
                for (int k = -kLattice; k <= kLattice; ++k)
                    if (distance(centre + step * Vec3(i, j, k)) >= enough) return true;
        return false;
    }

    model::Bounds bounds() const {
        model::Bounds all;
        for (const model::PartSpec* part : parts_) {
            const model::Bounds own = geometries_.boundsOf(*part);
            for (int corner = 0; corner < 8; ++corner)
                all.extend(part->X_WP * Vec3(corner & 1 ? own.low.x() : own.high.x(),
                                             corner & 2 ? own.low.y() : own.high.y(),
                                             corner & 4 ? own.low.z() : own.high.z()));
        }
        return all;
    }

private:
    PartGeometries& geometries_;
    std::vector<const model::PartSpec*> parts_;
};

/// The cells that a ball's centre may come to from where it starts.
class Flood {
public:
    Flood(const Obstacles& obstacles, double needed, const Vec3& start, const std::vector<Vec3>& goals) {
        model::Bounds box = obstacles.bounds();
        box.extend(start);
        for (const Vec3& goal : goals) box.extend(goal);
        edge_ = (box.size().maxCoeff() + 2.0 * std::max(needed, 0.0)) / (kMostCells - 4);
        const double margin = std::max(needed, 0.0) + 2.0 * edge_;  // a way around everything
        low_ = box.low - Vec3::Constant(margin);
        for (int axis = 0; axis < 3; ++axis)
            cells_[axis] = 1 + static_cast<int>((box.size()[axis] + 2.0 * margin) / edge_);
        free_.assign(static_cast<std::size_t>(cells_[0]) * static_cast<std::size_t>(cells_[1]) *
                         static_cast<std::size_t>(cells_[2]),
                     kUnseen);
        spread(obstacles, needed - kHalfDiagonal * edge_, start);
    }

    /// Did it come anywhere within `slack` of `goal`? Also if it could not begin.
    bool reaches(const Vec3& goal, double slack) const {
        if (!began_) return true;
        const double near = slack + kHalfDiagonal * edge_;
        const Cell low = cellOf(goal - Vec3::Constant(near)), high = cellOf(goal + Vec3::Constant(near));
        for (int x = low[0]; x <= high[0]; ++x)
            for (int y = low[1]; y <= high[1]; ++y)
                for (int z = low[2]; z <= high[2]; ++z)
                    if (free_[indexOf({x, y, z})] == kFree && (middle({x, y, z}) - goal).norm() <= near) return true;
        return false;
    }

private:
    using Cell = std::array<int, 3>;
    static constexpr char kUnseen = 0, kFree = 1, kBlocked = 2;

    Cell cellOf(const Vec3& p) const {
        Cell cell{};
        for (int axis = 0; axis < 3; ++axis)
            cell[axis] = std::clamp(static_cast<int>(std::floor((p - low_)[axis] / edge_)), 0, cells_[axis] - 1);
        return cell;
    }
    Vec3 middle(const Cell& c) const { return low_ + edge_ * Vec3(c[0] + 0.5, c[1] + 0.5, c[2] + 0.5); }
    std::size_t indexOf(const Cell& c) const {
        return static_cast<std::size_t>((c[2] * cells_[1] + c[1]) * cells_[0] + c[0]);
    }

    void spread(const Obstacles& obstacles, double enough, const Vec3& start) {
        std::vector<Cell> front;
        const auto enter = [&](const Cell& cell) {
            char& state = free_[indexOf(cell)];
            if (state != kUnseen) return;
            state = obstacles.distance(middle(cell)) >= enough ? kFree : kBlocked;
            if (state == kFree) front.push_back(cell);
        };
        enter(cellOf(start));
        began_ = !front.empty();
        while (!front.empty()) {
            const Cell at = front.back();
            front.pop_back();
            for (int x = std::max(0, at[0] - 1); x <= std::min(cells_[0] - 1, at[0] + 1); ++x)
                for (int y = std::max(0, at[1] - 1); y <= std::min(cells_[1] - 1, at[1] + 1); ++y)
                    for (int z = std::max(0, at[2] - 1); z <= std::min(cells_[2] - 1, at[2] + 1); ++z) enter({x, y, z});
        }
    }

    Vec3 low_;
    double edge_ = 0.0;
    Cell cells_{};
    std::vector<char> free_;
    bool began_ = false;
};

/// One trial's geometry.
class BodyCheck {
public:
    BodyCheck(const StudyTables& tables, const Condition& condition, const DeviceDescription& device,
              PartGeometries& geometries, Errors& errors)
        : tables_(tables),
          scene_(condition.scene),
          task_(condition.task),
          turns_(device.sensed_degrees >= 6),
          geometries_(geometries),
          errors_(errors),
          held_(*heldPart(condition.scene)),
          target_(partNamed(condition.scene, condition.task.target)),
          obstacles_(condition.scene, geometries) {
        balls_.push_back(geometries.ballAtOrigin(held_));
        balls_.push_back(geometries.largestBall(held_));
    }

    void run() {
        if (obstacles_.none() || geometries_.of(held_) == nullptr) return;
        const std::size_t before = errors_.size();
        std::visit([this](const auto& form) { checkRoom(form); }, task_.form);
        if (errors_.size() == before) std::visit([this](const auto& form) { checkWay(form); }, task_.form);
    }

private:
    using Ball = PartGeometries::Ball;

    /// Where the ball's centre is when the held part's origin is at `p`, give or take spread().
    Vec3 centreAt(const Vec3& p, const Ball& ball) const { return turns_ ? p : Vec3(p + held_.X_WP.q * ball.centre); }
    double spread(const Ball& ball) const { return turns_ ? ball.centre.norm() : 0.0; }
    double needed(const Ball& ball) const { return ball.radius - scene_.contact.tolerance; }

    /// Has the held part room with its origin within `reach` of `p`?
    bool hasRoom(const Vec3& p, double reach) const {
        return std::all_of(balls_.begin(), balls_.end(), [&](const Ball& ball) {
            return ball.radius < 0.0 || obstacles_.roomWithin(centreAt(p, ball), reach + spread(ball), needed(ball));
        });
    }

    void checkRoom(const PegInHoleTask&) {}
    void checkRoom(const FreePlacementTask&) {}
    void checkRoom(const DiscriminationPairTask&) {}
    void checkRoom(const ContourFollowingTask& contour) {
        if (target_ == nullptr) return;
        int without = 0;
        Vec3 first = Vec3::Zero();
        const auto places = placesOn(contour);
        for (const Vec3& place : places)
            if (!hasRoom(target_->X_WP * place, contour.reach) && without++ == 0) first = place;
        const double share = static_cast<double>(without) / static_cast<double>(places.size());
        if (share > 1.0 - contour.coverage + 1.0 / kPlaces)
            fail("points", fmt::format("the held part's body has no room within reach_mm of {:.0f} % of the line, from "
                                       "{:.3g}, {:.3g}, {:.3g} mm of the target on; `coverage` asks for {:.0f} %",
                                       100.0 * share, 1e3 * first.x(), 1e3 * first.y(), 1e3 * first.z(),
                                       100.0 * contour.coverage));
    }

    void checkRoom(const NarrowPassageTask& passage) {
        if (target_ == nullptr) return;
        if ((target_->X_WP.inverse() * held_.X_WP.p).z() <= -passage.length)
            return fail("target",
                        "the held part starts beyond the passage already, which begins in the plane z = 0 of the "
                        "target and runs along -z");
        for (int i = 0; i <= kDepths; ++i) {
            const double depth = passage.length * i / kDepths;
            if (hasRoom(target_->X_WP * Vec3(0, 0, -depth), 0.5 * passage.width)) continue;
            return fail("target", fmt::format("the passage is blocked or too narrow {:.4g} mm from its mouth: the held "
                                              "part's body has no room there within half of passage_width_mm",
                                              1e3 * depth));
        }
    }

    void checkWay(const DiscriminationPairTask&) {}
    void checkWay(const PegInHoleTask& peg) {
        if (target_ != nullptr)
            way("target", {target_->X_WP * Vec3(0, 0, -peg.success_fraction * peg.insertion_depth)}, 0.0, 1.0);
    }
    void checkWay(const NarrowPassageTask& passage) {
        if (target_ != nullptr) way("target", {target_->X_WP.p}, 0.5 * passage.width, 1.0);
    }
    void checkWay(const FreePlacementTask& placement) {
        way("position", {placement.X_WGoal.p}, placement.position_tolerance, 1.0);
    }
    void checkWay(const ContourFollowingTask& contour) {
        if (target_ == nullptr) return;
        std::vector<Vec3> places = placesOn(contour);
        for (Vec3& place : places) place = target_->X_WP * place;
        way("points", places, contour.reach, contour.coverage - 1.0 / kPlaces);
    }

    /// From the start the held part's origin comes within `slack` of a `share` of `goals`.
    void way(const char* key, const std::vector<Vec3>& goals, double slack, double share) {
        for (const Ball& ball : balls_) {
            if (ball.radius < 0.0) continue;
            std::vector<Vec3> centres;
            for (const Vec3& goal : goals) centres.push_back(centreAt(goal, ball));
            const Vec3 start = held_.X_WP * ball.centre;
            const double near = slack + spread(ball);
            // Conditions that differ in their contact only have one answer.
            const double reached = geometries_.depth(question(ball, start, centres, near), [&] {
                const Flood flood(obstacles_, needed(ball), start, centres);
                return static_cast<double>(std::count_if(
                    centres.begin(), centres.end(), [&](const Vec3& centre) { return flood.reaches(centre, near); }));
            });
            if (reached >= share * static_cast<double>(goals.size())) continue;
            return fail(key, "no way leads there from the held part's start: obstacles close one of them off");
        }
    }

    std::string question(const Ball& ball, const Vec3& start, const std::vector<Vec3>& centres, double near) const {
        const auto text = [](const Vec3& p) { return fmt::format(" {:a},{:a},{:a}", p.x(), p.y(), p.z()); };
        std::string all = fmt::format("way {:a} {:a}", needed(ball), near) + text(start);
        for (const Vec3& centre : centres) all += text(centre);
        for (const model::PartSpec& part : scene_.parts)
            if (!part.held)
                all += " " + geometryKey(part) + text(part.X_WP.p) + text(part.X_WP.q.vec()) +
                       fmt::format(" {:a}", part.X_WP.q.w());
        return all;
    }

    /// Places of the line, evenly spread, in the target's frame.
    static std::vector<Vec3> placesOn(const ContourFollowingTask& contour) {
        double length = 0.0;
        for (std::size_t i = 1; i < contour.points.size(); ++i)
            length += (contour.points[i] - contour.points[i - 1]).norm();
        std::vector<Vec3> places;
        for (std::size_t i = 1; i < contour.points.size(); ++i) {
            const Vec3 &a = contour.points[i - 1], &b = contour.points[i];
            const int pieces = std::max(1, static_cast<int>(std::lround(kPlaces * (b - a).norm() / length)));
            for (int k = 0; k < pieces; ++k) places.emplace_back(a + (b - a) * ((k + 0.5) / pieces));
        }
        return places;
    }

    void fail(const char* key, std::string message) {
        const Node* value = tables_.task.find(key);
        const Node& at = value != nullptr ? *value : tables_.task;
        errors_.push_back(errorAt(at.place, fmt::format("task.{}", key),
                                  at.kind == Node::Kind::Text ? valueText(at) : "", std::move(message)));
    }

    const StudyTables& tables_;
    const model::SceneSpec& scene_;
    const Task& task_;
    bool turns_;
    PartGeometries& geometries_;
    Errors& errors_;
    const model::PartSpec& held_;
    const model::PartSpec* target_;
    Obstacles obstacles_;
    std::vector<Ball> balls_;
};

}  // namespace

void checkBody(const StudyTables& tables, const Condition& condition, const DeviceDescription& device,
               PartGeometries& geometries, Errors& errors) {
    BodyCheck(tables, condition, device, geometries, errors).run();
}

}  // namespace passung::protocol
