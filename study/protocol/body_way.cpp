#include "study/protocol/body_way.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "study/plan/scene_parts.h"
#include "study/protocol/scene_node.h"

namespace passung::protocol {
namespace {

constexpr int kHalvings = 3;             // of the cube in which a place is searched for
constexpr double kHalfDiagonal = 0.867;  // of a cube with edge 1, rounded up
constexpr int kMostCells = 48;           // along the longest side of the grid
constexpr int kMostSteps = 6;            // of cells around one that are taken with it
constexpr int kDepths = 32;              // of a passage
constexpr int kPieces = 200;             // of a line, equally long
constexpr double kSumRounding = 1e-9;    // of a sum of lengths

/// Obstacles as one distance.
class Obstacles {
public:
    Obstacles(const scene::SceneSpec& scene, PartGeometries& geometries) : geometries_(geometries) {
        for (const scene::PartSpec& part : scene.parts)
            if (!part.held && geometries.of(part) != nullptr) parts_.push_back(&part);
    }

    bool none() const { return parts_.empty(); }

    /// Is a distance worth more than a look at some hundred cells? That of a mesh is.
    bool takesLong() const {
        return std::any_of(parts_.begin(), parts_.end(), [](const scene::PartSpec* part) {
            return std::holds_alternative<scene::MeshFile>(part->geometry);
        });
    }

    /// From all of them [m]; negative inside.
    double distance(const Vec3& p) const {
        double least = 1e9;
        for (const scene::PartSpec* part : parts_)
            least = std::min(least, geometries_.signedDistance(*part, part->X_WP.inverse() * p));
        return least;
    }

    /// Is there a place within `reach` of `centre` where the distance may be `needed`?
    bool roomWithin(const Vec3& centre, double reach, double needed) const {
        return roomIn({centre, reach, needed}, centre, reach, 0);
    }

    geometry::Bounds bounds() const {
        geometry::Bounds all;
        for (const scene::PartSpec* part : parts_) {
            const geometry::Bounds own = geometries_.boundsOf(*part);
            for (int corner = 0; corner < 8; ++corner)
                all.extend(part->X_WP * Vec3(corner & 1 ? own.low.x() : own.high.x(),
                                             corner & 2 ? own.low.y() : own.high.y(),
                                             corner & 4 ? own.low.z() : own.high.z()));
        }
        return all;
    }

private:
    struct Sought {
        Vec3 centre;
        double reach, needed;
    };

    /// Halves the cube about `middle` as long as it may hold such a place.
    bool roomIn(const Sought& sought, const Vec3& middle, double half, int halvings) const {
        const double across = 2.0 * kHalfDiagonal * half, off = (middle - sought.centre).norm();
        if (off > sought.reach + across) return false;
        const double found = distance(middle);
        if (found >= sought.needed && off <= sought.reach) return true;
        if (found + std::min(across, off + sought.reach) < sought.needed) return false;
        if (halvings == kHalvings) return true;
        for (int corner = 0; corner < 8; ++corner) {
            const Vec3 way(corner & 1 ? 0.5 : -0.5, corner & 2 ? 0.5 : -0.5, corner & 4 ? 0.5 : -0.5);
            if (roomIn(sought, middle + half * way, 0.5 * half, halvings + 1)) return true;
        }
        return false;
    }

    PartGeometries& geometries_;
    std::vector<const scene::PartSpec*> parts_;
};

/// The cells that a ball's centre may come to from where it starts.
class Flood {
public:
    Flood(const Obstacles& obstacles, double needed, const Vec3& start, const std::vector<Vec3>& goals) {
        geometry::Bounds box = obstacles.bounds();
        box.extend(start);
        for (const Vec3& goal : goals) box.extend(goal);
        edge_ = (box.size().maxCoeff() + 2.0 * std::max(needed, 0.0)) / (kMostCells - 4);
        const double margin = std::max(needed, 0.0) + 2.0 * edge_;  // a way around everything
        low_ = box.low - Vec3::Constant(margin);
        for (std::size_t axis = 0; axis < 3; ++axis)
            cells_[axis] = 1 + static_cast<int>((box.size()[static_cast<int>(axis)] + 2.0 * margin) / edge_);
        free_.assign(static_cast<std::size_t>(cells_[0]) * static_cast<std::size_t>(cells_[1]) *
                         static_cast<std::size_t>(cells_[2]),
                     kUnseen);
        spread(obstacles, needed - kHalfDiagonal * edge_, start);
    }

    /// How many of `goals` did it come anywhere within `slack` of? All if it could not begin.
    std::size_t reached(const std::vector<Vec3>& goals, double slack) const {
        if (!began_) return goals.size();
        const double near = slack + kHalfDiagonal * edge_;
        Cell last = cellOf(goals.front());  // of neighbours on a line the same cell often is near
        return static_cast<std::size_t>(std::count_if(goals.begin(), goals.end(), [&](const Vec3& goal) {
            return isNear(last, goal, near) || find(goal, near, last);
        }));
    }

private:
    using Cell = std::array<int, 3>;
    static constexpr char kUnseen = 0, kFree = 1, kBlocked = 2;

    Cell cellOf(const Vec3& p) const {
        Cell cell{};
        const Vec3 at = (p - low_) / edge_;
        for (std::size_t axis = 0; axis < 3; ++axis)
            cell[axis] = std::clamp(static_cast<int>(std::floor(at[static_cast<int>(axis)])), 0, cells_[axis] - 1);
        return cell;
    }
    Vec3 middle(const Cell& c) const { return low_ + edge_ * Vec3(c[0] + 0.5, c[1] + 0.5, c[2] + 0.5); }
    std::size_t indexOf(const Cell& c) const {
        return static_cast<std::size_t>((c[2] * cells_[1] + c[1]) * cells_[0] + c[0]);
    }

    bool isNear(const Cell& cell, const Vec3& goal, double near) const {
        return free_[indexOf(cell)] == kFree && (middle(cell) - goal).norm() <= near;
    }

    bool find(const Vec3& goal, double near, Cell& found) const {
        const Cell low = cellOf(goal - Vec3::Constant(near)), high = cellOf(goal + Vec3::Constant(near));
        for (int x = low[0]; x <= high[0]; ++x)
            for (int y = low[1]; y <= high[1]; ++y)
                for (int z = low[2]; z <= high[2]; ++z)
                    if (isNear({x, y, z}, goal, near)) {
                        found = {x, y, z};
                        return true;
                    }
        return false;
    }

    template <class Visit>
    void around(const Cell& at, int steps, Visit visit) const {
        for (int x = std::max(0, at[0] - steps); x <= std::min(cells_[0] - 1, at[0] + steps); ++x)
            for (int y = std::max(0, at[1] - steps); y <= std::min(cells_[1] - 1, at[1] + steps); ++y)
                for (int z = std::max(0, at[2] - steps); z <= std::min(cells_[2] - 1, at[2] + steps); ++z)
                    visit(Cell{x, y, z});
    }

    void spread(const Obstacles& obstacles, double enough, const Vec3& start) {
        std::vector<Cell> front;
        const int most = obstacles.takesLong() ? kMostSteps : 0;
        const auto enter = [&](const Cell& cell) {
            if (free_[indexOf(cell)] != kUnseen) return;
            const double over = obstacles.distance(middle(cell)) - enough;
            free_[indexOf(cell)] = over >= 0.0 ? kFree : kBlocked;
            if (!(over >= 0.0)) return;
            front.push_back(cell);
            // Whatever is no farther away than that is free, too: of open space few cells are asked for.
            around(cell, most == 0 ? 0 : static_cast<int>(std::min(over / edge_, 1.0 * most)), [&](const Cell& other) {
                char& state = free_[indexOf(other)];
                if (state != kUnseen || (middle(other) - middle(cell)).norm() > over) return;
                state = kFree;
                front.push_back(other);
            });
        };
        enter(cellOf(start));
        began_ = !front.empty();
        while (!front.empty()) {
            const Cell at = front.back();
            front.pop_back();
            around(at, 1, enter);
        }
    }

    Vec3 low_;
    double edge_ = 0.0;
    Cell cells_{};
    std::vector<char> free_;
    bool began_ = false;
};

class BodyCheck {
public:
    BodyCheck(const StudyTables& tables, const plan::Condition& condition, const DeviceDescription& device,
              PartGeometries& geometries, Errors& errors)
        : tables_(tables),
          scene_(condition.scene),
          task_(condition.task),
          turns_(device.sensed_degrees >= 6),
          geometries_(geometries),
          errors_(errors),
          held_(*plan::heldPart(condition.scene)),
          target_(plan::partNamed(condition.scene, condition.task.target)),
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

    /// Of `places` (world) those without room: how many, and the first; `places.size()` if there is none.
    struct Without {
        std::size_t count, first;
    };
    Without withoutRoom(const std::vector<Vec3>& places, double reach) {
        const auto tight = [&](const Vec3& place) { return !hasRoom(place, reach); };
        const auto ask = [&](const char* what, const auto& reckon) {
            std::string all = what;
            for (const Ball& ball : balls_)
                if (ball.radius >= 0.0) all += question(ball, centresAt(places, ball), reach + spread(ball));
            return static_cast<std::size_t>(geometries_.remembered(all, reckon));
        };
        const std::size_t count =
            ask("tight ", [&] { return static_cast<double>(std::count_if(places.begin(), places.end(), tight)); });
        if (count == 0) return {0, places.size()};
        return {count, ask("first ", [&] {
                    return static_cast<double>(std::find_if(places.begin(), places.end(), tight) - places.begin());
                })};
    }

    void checkRoom(const plan::PegInHoleTask&) {}
    void checkRoom(const plan::FreePlacementTask&) {}
    void checkRoom(const plan::DiscriminationPairTask&) {}
    void checkRoom(const plan::AssemblyTask&) {}
    void checkRoom(const plan::ContourFollowingTask& contour) {
        if (target_ == nullptr) return;
        const Line line = piecesOf(contour);
        const Without without = withoutRoom(line.places, contour.reach + line.half);
        const double share = static_cast<double>(without.count) / static_cast<double>(line.places.size());
        if (!(share > 1.0 - contour.coverage + kSumRounding)) return;
        const Vec3 first = 1e3 * (target_->X_WP.inverse() * line.places[without.first]);
        fail("points", fmt::format("the held part's body has no room within reach_mm of {:.0f} % of the line, from "
                                   "{:.3g}, {:.3g}, {:.3g} mm of the target on; `coverage` asks for {:.0f} %",
                                   100.0 * share, first.x(), first.y(), first.z(), 100.0 * contour.coverage));
    }

    void checkRoom(const plan::NarrowPassageTask& passage) {
        if (target_ == nullptr) return;
        if ((target_->X_WP.inverse() * held_.X_WP.p).z() <= -passage.length)
            return fail("target",
                        "the held part starts beyond the passage already, which begins in the plane z = 0 of the "
                        "target and runs along -z");
        std::vector<Vec3> places;
        for (int i = 0; i <= kDepths; ++i)
            places.emplace_back(target_->X_WP * Vec3(0, 0, -passage.length * i / kDepths));
        const Without without = withoutRoom(places, 0.5 * passage.width);
        if (without.count == 0) return;
        fail("target",
             fmt::format("the passage is blocked or too narrow {:.4g} mm from its mouth: the held part's body "
                         "has no room there within half of passage_width_mm",
                         1e3 * passage.length * static_cast<double>(without.first) / kDepths));
    }

    void checkWay(const plan::DiscriminationPairTask&) {}
    void checkWay(const plan::AssemblyTask&) {}
    void checkWay(const plan::PegInHoleTask& peg) {
        if (target_ != nullptr)
            way("target", {target_->X_WP * (peg.X_TMouth * Vec3(0, 0, -peg.success_fraction * peg.insertion_depth))},
                0.0, 1.0);
    }
    void checkWay(const plan::NarrowPassageTask& passage) {
        if (target_ != nullptr) way("target", {target_->X_WP.p}, 0.5 * passage.width, 1.0);
    }
    void checkWay(const plan::FreePlacementTask& placement) {
        way("position", {placement.X_WGoal.p}, placement.position_tolerance, 1.0);
    }
    void checkWay(const plan::ContourFollowingTask& contour) {
        if (target_ == nullptr) return;
        const Line line = piecesOf(contour);
        way("points", line.places, contour.reach + line.half, contour.coverage - kSumRounding);
    }

    /// From the start the held part's origin comes within `slack` of a `share` of `goals`.
    void way(const char* key, const std::vector<Vec3>& goals, double slack, double share) {
        for (const Ball& ball : balls_) {
            if (ball.radius < 0.0) continue;
            const std::vector<Vec3> centres = centresAt(goals, ball);
            const Vec3 start = held_.X_WP * ball.centre;
            const double near = slack + spread(ball);
            // Conditions that differ in their contact only have one answer.
            const double reached = geometries_.remembered("way " + text(start) + question(ball, centres, near), [&] {
                return static_cast<double>(Flood(obstacles_, needed(ball), start, centres).reached(centres, near));
            });
            if (reached >= share * static_cast<double>(goals.size())) continue;
            return fail(key, "no way leads there from the held part's start: obstacles close one of them off");
        }
    }

    static std::string text(const Vec3& p) { return fmt::format(" {:a},{:a},{:a}", p.x(), p.y(), p.z()); }

    std::vector<Vec3> centresAt(const std::vector<Vec3>& places, const Ball& ball) const {
        std::vector<Vec3> centres;
        for (const Vec3& place : places) centres.push_back(centreAt(place, ball));
        return centres;
    }

    /// What tells a ball about these centres, each give or take `near`, amid these obstacles from another.
    std::string question(const Ball& ball, const std::vector<Vec3>& centres, double near) const {
        std::string all = fmt::format("{:a} {:a}", needed(ball), near);
        for (const Vec3& centre : centres) all += text(centre);
        for (const scene::PartSpec& part : scene_.parts)
            if (!part.held)
                all += " " + geometryKey(part) + text(part.X_WP.p) + text(part.X_WP.q.vec()) +
                       fmt::format(" {:a}", part.X_WP.q.w());
        return all;
    }

    /// Middles (world) of equally long pieces of a line. Any place of a piece is within `half` of its middle.
    struct Line {
        std::vector<Vec3> places;
        double half;
    };
    Line piecesOf(const plan::ContourFollowingTask& contour) const {
        const auto& points = contour.points;
        const auto lengthOf = [&](std::size_t i) { return (points[i + 1] - points[i]).norm(); };
        double length = 0.0, before = 0.0;
        for (std::size_t i = 0; i + 1 < points.size(); ++i) length += lengthOf(i);
        Line line{{}, 0.5 * length / kPieces};
        for (std::size_t i = 0; line.places.size() < std::size_t{kPieces};) {
            const double at = (2.0 * static_cast<double>(line.places.size()) + 1.0) * line.half, own = lengthOf(i);
            if (at > before + own && i + 2 < points.size()) {
                before += own;
                ++i;
                continue;
            }
            const double share = own > 0.0 ? std::min((at - before) / own, 1.0) : 0.0;
            line.places.emplace_back(target_->X_WP * (points[i] + share * (points[i + 1] - points[i])));
        }
        return line;
    }

    void fail(const char* key, std::string message) {
        const Node* value = tables_.task.find(key);
        const Node& at = value != nullptr ? *value : tables_.task;
        errors_.push_back(errorAt(at.place, fmt::format("task.{}", key),
                                  at.kind == Node::Kind::Text ? valueText(at) : "", std::move(message)));
    }

    const StudyTables& tables_;
    const scene::SceneSpec& scene_;
    const plan::Task& task_;
    bool turns_;
    PartGeometries& geometries_;
    Errors& errors_;
    const scene::PartSpec& held_;
    const scene::PartSpec* target_;
    Obstacles obstacles_;
    std::vector<Ball> balls_;
};

}  // namespace

void checkBody(const StudyTables& tables, const plan::Condition& condition, const DeviceDescription& device,
               PartGeometries& geometries, Errors& errors) {
    const scene::ContactSpec& contact = condition.scene.contact;
    const bool stops = contact.method != scene::ContactMethod::Penalty && condition.scene.display_wrench;
    if (!stops || condition.timed_by != plan::TimedBy::Program) return;
    if (plan::heldPart(condition.scene) == nullptr) return;  // of what is picked up the steps are looked at
    BodyCheck(tables, condition, device, geometries, errors).run();
}

}  // namespace passung::protocol
