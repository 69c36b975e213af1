#include "core/path/search/path_search.h"

#include <ompl/base/goals/GoalRegion.h>
#include <ompl/base/spaces/SE3StateSpace.h>
#include <ompl/control/DirectedControlSampler.h>
#include <ompl/control/PathControl.h>
#include <ompl/control/planners/rrt/RRT.h>
#include <ompl/control/spaces/RealVectorControlSpace.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/PathSimplifier.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <numbers>

#include "core/path/path_measures.h"

namespace passung::path {

namespace {

namespace ob = ompl::base;
namespace oc = ompl::control;
namespace og = ompl::geometric;

constexpr double kOut = 0.25;             // of the part's reach: with so much room around it a part is out
constexpr double kLeast = 5e-6;           // kept by straight ways [m]
constexpr double kRoomAround = 2.0;       // reaches beyond all parts that a search may go
constexpr double kLongestPull = 1.5;      // reaches
constexpr double kMostTurn = 0.7;         // of a pull [rad]
constexpr double kShareOfEscape = 0.25;   // of the time, for either end
constexpr double kShareOfJoining = 0.65;  // of the time, until straight ways have joined them
constexpr double kNoWay = 1e-5;           // [m]: a pull that takes it no farther is none

using SearchClock = std::chrono::steady_clock;

double secondsUntil(SearchClock::time_point end) {
    return std::max(0.0, std::chrono::duration<double>(end - SearchClock::now()).count());
}

Pose poseOf(const ob::State* state) {
    const auto& at = *state->as<ob::SE3StateSpace::StateType>();
    const auto& q = at.rotation();
    return {Quat(q.w, q.x, q.y, q.z), Vec3(at.getX(), at.getY(), at.getZ())};
}

void setPose(ob::State* state, const Pose& X) {
    auto& at = *state->as<ob::SE3StateSpace::StateType>();
    at.setXYZ(X.p.x(), X.p.y(), X.p.z());
    auto& q = at.rotation();
    q.w = X.q.w();
    q.x = X.q.x();
    q.y = X.q.y();
    q.z = X.q.z();
}

std::shared_ptr<ob::SE3StateSpace> spaceOf(const FreeRoom& room, const Pose& a, const Pose& b) {
    auto space = std::make_shared<ob::SE3StateSpace>();
    const geometry::Bounds box = room.boundsWith(a, b);
    ob::RealVectorBounds bounds(3);
    for (unsigned axis = 0; axis < 3; ++axis) {
        bounds.setLow(axis, box.low[axis] - kRoomAround * room.reach());
        bounds.setHigh(axis, box.high[axis] + kRoomAround * room.reach());
    }
    space->setBounds(bounds);
    space->setSubspaceWeight(1, room.reach());  // a turn counts as the way of the farthest point
    return space;
}

/// A pull: where the part is asked to go, as a way of its origin and a turn about it, world axes.
using PulledWay = Eigen::Matrix<double, 6, 1>;

PulledWay pullOf(const oc::Control* control) {
    const double* values = control->as<oc::RealVectorControlSpace::ControlType>()->values;
    return Eigen::Map<const PulledWay>(values);
}

Pose pulled(const Pose& X, const PulledWay& pull) {
    Pose to{rotationFromVector(pull.tail<3>()) * X.q, X.p + pull.head<3>()};
    to.q.normalize();
    return to;
}

class Slides : public oc::StatePropagator {
public:
    Slides(const oc::SpaceInformationPtr& space, const FreeRoom& room) : StatePropagator(space), room_(room) {}
    void propagate(const ob::State* from, const oc::Control* control, double, ob::State* to) const override {
        const Pose X = poseOf(from);
        setPose(to, room_.slide(X, pulled(X, pullOf(control))).back());
    }
    bool canPropagateBackward() const override { return false; }

private:
    const FreeRoom& room_;
};

/// Chooses pulls towards a pose: its way alone, its way and its turn, or along an axis of the part's frame.
class Pulls : public oc::DirectedControlSampler {
public:
    Pulls(const oc::SpaceInformation* space, const FreeRoom& room) : DirectedControlSampler(space), room_(room) {}

    unsigned int sampleTo(oc::Control* control, const ob::State* source, ob::State* dest) override {
        const Pose X = poseOf(source);
        const PulledWay pull = choose(X, poseOf(dest));
        Eigen::Map<PulledWay>(control->as<oc::RealVectorControlSpace::ControlType>()->values) = pull;
        const Pose end = room_.slide(X, pulled(X, pull)).back();
        if (wayBetween(X, end, room_.reach()) < kNoWay) return 0;
        setPose(dest, end);
        return si_->satisfiesBounds(dest) ? 1 : 0;
    }
    unsigned int sampleTo(oc::Control* control, const oc::Control*, const ob::State* source, ob::State* dest) override {
        return sampleTo(control, source, dest);
    }

private:
    PulledWay choose(const Pose& X, const Pose& X_to) {
        constexpr double kAlongAxis = 0.25, kWayAlone = 0.55;
        const double kind = random_.uniform01(), longest = kLongestPull * room_.reach();
        PulledWay pull = PulledWay::Zero();
        if (kind < kAlongAxis) {
            const Vec3 axis = X.q * Vec3::Unit(random_.uniformInt(0, 2));
            pull.head<3>() = (random_.uniformBool() ? longest : -longest) * random_.uniformReal(0.2, 1.0) * axis;
            return pull;
        }
        const Vec3 way = X_to.p - X.p;
        pull.head<3>() = way * std::min(1.0, longest / std::max(way.norm(), kNoWay));
        if (kind < kWayAlone) return pull;
        const Vec3 turn = rotationVector(X_to.q * X.q.conjugate());
        pull.tail<3>() = turn * std::min(1.0, kMostTurn / std::max(turn.norm(), 1e-9));
        return pull;
    }

    const FreeRoom& room_;
    ompl::RNG random_;
};

/// Where the part has room around it.
class Out : public ob::GoalRegion {
public:
    Out(const ob::SpaceInformationPtr& space, const FreeRoom& room) : GoalRegion(space), room_(room) {
        setThreshold(0.0);
    }
    double distanceGoal(const ob::State* state) const override {
        const double asked = kOut * room_.reach();
        return asked - room_.clearanceAt(poseOf(state), asked).distance;
    }

private:
    const FreeRoom& room_;
};

/// From where a straight way leads to a pose.
class Seen : public ob::GoalRegion {
public:
    Seen(const ob::SpaceInformationPtr& space, const FreeRoom& room, const Pose& X_to)
        : GoalRegion(space), room_(room), X_to_(X_to) {
        setThreshold(0.0);
    }
    double distanceGoal(const ob::State* state) const override {
        const Pose X = poseOf(state);
        return room_.isFreeBetween(X, X_to_, kLeast) ? 0.0 : wayBetween(X, X_to_, room_.reach());
    }

private:
    const FreeRoom& room_;
    Pose X_to_;
};

bool isOut(const FreeRoom& room, const Pose& X) {
    const double asked = kOut * room.reach();
    return room.clearanceAt(X, asked).distance >= asked;
}

/// Leaves out what comes after the first pose that is out; false if none is.
bool endWhereOut(const FreeRoom& room, std::vector<Pose>& way) {
    if (way.empty() || !isOut(room, way.back())) return false;
    constexpr std::size_t kEvery = 4;
    for (std::size_t i = 0; i < way.size(); i += kEvery) {
        if (!isOut(room, way[i])) continue;
        way.resize(i + 1);
        break;
    }
    return true;
}

/// Straight pulls along the axes of the part's frame, far enough to come out of what is as deep as the room is wide.
std::optional<std::vector<Pose>> pullStraightOut(const FreeRoom& room, const Pose& X, SearchClock::time_point end) {
    const double far = 3.0 * room.reach();
    for (const double sign : {1.0, -1.0}) {
        for (const int axis : {2, 0, 1}) {
            if (SearchClock::now() > end) return std::nullopt;
            PulledWay pull = PulledWay::Zero();
            pull.head<3>() = sign * far * (X.q * Vec3(Vec3::Unit(axis)));
            auto way = room.slide(X, pulled(X, pull));
            if (endWhereOut(room, way)) return way;
        }
    }
    return std::nullopt;
}

/// The slides of a solution, once more: the poses between its states.
std::vector<Pose> slidesOf(const FreeRoom& room, oc::PathControl& path) {
    std::vector<Pose> way{poseOf(path.getState(0))};
    for (std::size_t i = 0; i < path.getControlCount(); ++i) {
        const Pose X = poseOf(path.getState(static_cast<unsigned>(i)));
        const auto piece = room.slide(X, pulled(X, pullOf(path.getControl(static_cast<unsigned>(i)))));
        way.insert(way.end(), piece.begin() + 1, piece.end());
    }
    return way;
}

struct Slid {
    std::vector<Pose> way;
    bool arrived = false;  // at the goal; else as near to it as was come in the time
};

/// A tree of pulls from `X` on; `goalOf` makes the goal.
template <class GoalOf>
Slid growSlides(const FreeRoom& room, const Pose& X, const std::shared_ptr<ob::SE3StateSpace>& space,
                SearchClock::time_point end, const GoalOf& goalOf) {
    auto pulls = std::make_shared<oc::RealVectorControlSpace>(space, 6);
    ob::RealVectorBounds most(6);
    most.setLow(-100.0);
    most.setHigh(100.0);
    pulls->setBounds(most);
    auto si = std::make_shared<oc::SpaceInformation>(space, pulls);
    si->setStateValidityChecker([&si = *si](const ob::State* state) { return si.satisfiesBounds(state); });
    si->setStatePropagator(std::make_shared<Slides>(si, room));
    si->setPropagationStepSize(1.0);
    si->setMinMaxControlDuration(1, 1);
    si->setDirectedControlSamplerAllocator(
        [&room](const oc::SpaceInformation* at) { return std::make_shared<Pulls>(at, room); });
    si->setup();
    auto problem = std::make_shared<ob::ProblemDefinition>(si);
    ob::ScopedState<ob::SE3StateSpace> start(space);
    setPose(start.get(), X);
    problem->addStartState(start);
    problem->setGoal(goalOf(si));
    oc::RRT planner(si);
    planner.setProblemDefinition(problem);
    planner.setup();
    const auto solved = planner.solve(ob::timedPlannerTerminationCondition(secondsUntil(end)));
    const ob::PathPtr path = problem->getSolutionPath();
    if (!path) return {{X}};
    return {slidesOf(room, *path->as<oc::PathControl>()), solved == ob::PlannerStatus::EXACT_SOLUTION};
}

/// From `X` to where there is room around the part, or as near to that as was come in the time.
std::vector<Pose> leave(const FreeRoom& room, const Pose& X, const std::shared_ptr<ob::SE3StateSpace>& space,
                        SearchClock::time_point end) {
    if (isOut(room, X)) return {X};
    if (auto way = pullStraightOut(room, X, end)) return *std::move(way);
    return growSlides(room, X, space, end, [&](const auto& si) { return std::make_shared<Out>(si, room); }).way;
}

/// A straight way, proven by distances.
class ProvenWays : public ob::MotionValidator {
public:
    ProvenWays(const ob::SpaceInformationPtr& space, const FreeRoom& room) : MotionValidator(space), room_(room) {}
    bool checkMotion(const ob::State* a, const ob::State* b) const override {
        return room_.isFreeBetween(poseOf(a), poseOf(b), kLeast);
    }
    bool checkMotion(const ob::State* a, const ob::State* b, std::pair<ob::State*, double>& last) const override {
        const bool is_free = checkMotion(a, b);
        last.second = is_free ? 1.0 : 0.0;
        if (!is_free && last.first != nullptr) si_->copyState(last.first, a);
        return is_free;
    }

private:
    const FreeRoom& room_;
};

/// Straight from `a` to `b`, or along an axis of the world, across and back.
std::optional<std::vector<Pose>> goAround(const FreeRoom& room, const Pose& a, const Pose& b,
                                          SearchClock::time_point end) {
    if (room.isFreeBetween(a, b, kLeast)) return std::vector<Pose>{a, b};
    for (const double reaches : {0.5, 1.0, 2.0, 4.0}) {
        for (const int axis : {2, 0, 1}) {
            for (const double sign : {1.0, -1.0}) {
                if (SearchClock::now() > end) return std::nullopt;
                const Vec3 away = sign * reaches * room.reach() * Vec3::Unit(axis);
                const Pose a_away{a.q, a.p + away}, b_away{b.q, b.p + away};
                if (room.isFreeBetween(a_away, b_away, kLeast) && room.isFreeBetween(a, a_away, kLeast) &&
                    room.isFreeBetween(b_away, b, kLeast))
                    return std::vector<Pose>{a, a_away, b_away, b};
            }
        }
    }
    return std::nullopt;
}

/// Straight ways from `a` to `b`.
std::optional<std::vector<Pose>> join(const FreeRoom& room, const Pose& a, const Pose& b,
                                      const std::shared_ptr<ob::SE3StateSpace>& space, SearchClock::time_point end) {
    if (auto way = goAround(room, a, b, end)) return way;
    auto si = std::make_shared<ob::SpaceInformation>(space);
    si->setStateValidityChecker([&room, &at = *si](const ob::State* state) {
        return at.satisfiesBounds(state) && room.clearanceAt(poseOf(state), 2.0 * kLeast).distance > kLeast;
    });
    si->setMotionValidator(std::make_shared<ProvenWays>(si, room));
    si->setup();
    auto problem = std::make_shared<ob::ProblemDefinition>(si);
    ob::ScopedState<ob::SE3StateSpace> from(space), to(space);
    setPose(from.get(), a);
    setPose(to.get(), b);
    problem->setStartAndGoalStates(from, to);
    og::RRTConnect planner(si);
    planner.setProblemDefinition(problem);
    planner.setup();
    const auto solved = planner.solve(ob::timedPlannerTerminationCondition(secondsUntil(end)));
    if (solved != ob::PlannerStatus::EXACT_SOLUTION) return std::nullopt;
    auto& path = *problem->getSolutionPath()->as<og::PathGeometric>();
    og::PathSimplifier simplifier(si);
    simplifier.reduceVertices(path);
    simplifier.shortcutPath(path);
    std::vector<Pose> way;
    for (const ob::State* state : path.getStates()) way.push_back(poseOf(state));
    return way;
}

}  // namespace

void seedSearches(std::uint32_t seed) {
    ompl::msg::noOutputHandler();
    ompl::RNG::setSeed(seed);
}

std::optional<std::vector<Pose>> findPath(const FreeRoom& room, const Pose& X_start, const Pose& X_goal,
                                          const SearchLimits& limits) {
    const auto share = [&, begin = SearchClock::now()](double of_all) {
        return begin + std::chrono::duration_cast<SearchClock::duration>(
                           std::chrono::duration<double>(of_all * limits.seconds));
    };
    const auto space = spaceOf(room, X_start, X_goal);
    const std::vector<Pose> from_goal = leave(room, X_goal, space, share(kShareOfEscape));
    const std::vector<Pose> from_start = leave(room, X_start, space, share(2.0 * kShareOfEscape));
    const Pose &X_from = from_start.back(), &X_to = from_goal.back();
    auto between = join(room, X_from, X_to, space, share(kShareOfJoining));
    if (!between) {
        Slid slid = growSlides(room, X_from, space, share(1.0),
                               [&](const auto& si) { return std::make_shared<Seen>(si, room, X_to); });
        if (!slid.arrived) return std::nullopt;
        slid.way.push_back(X_to);
        between = shorten(room, slid.way, kLeast);
    }
    std::vector<Pose> path = from_start;
    path.insert(path.end(), between->begin() + 1, between->end());
    path.insert(path.end(), from_goal.rbegin() + 1, from_goal.rend());
    return shorten(room, path, kLeast);
}

}  // namespace passung::path
