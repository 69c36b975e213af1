#include "core/path/free_room.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <variant>

#include "core/path/room_contacts.h"

namespace passung::path {

namespace {

constexpr double kTurnPerReach = 0.5;   // radius of the metric over the part's reach
constexpr double kTickWay = 1e-3;       // of the hand in a tick, at most [m]
constexpr int kFewestTicks = 4;         // before it may be blocked
constexpr int kLookBack = 12;           // ticks
constexpr double kLeastProgress = 0.1;  // of the hand's way in that time
constexpr double kSurelyFree = 0.9;     // of the clearance, as the next step

void extendBy(geometry::Bounds& bounds, const geometry::Bounds& box, const Pose& X) {
    for (int corner = 0; corner < 8; ++corner)
        bounds.extend(X * Vec3((corner & 1) != 0 ? box.high.x() : box.low.x(),
                               (corner & 2) != 0 ? box.high.y() : box.low.y(),
                               (corner & 4) != 0 ? box.high.z() : box.low.z()));
}

double reachOf(const geometry::TriangleMesh& mesh) {
    double reach = 0.0;
    for (const Vec3& vertex : mesh.vertices) reach = std::max(reach, vertex.norm());
    return reach;
}

}  // namespace

Pose poseBetween(const Pose& a, const Pose& b, double share) {
    Pose between{a.q.slerp(share, b.q), a.p + share * (b.p - a.p)};
    between.q.normalize();
    return between;
}

double wayBetween(const Pose& a, const Pose& b, double reach) {
    return (b.p - a.p).norm() + reach * a.q.angularDistance(b.q);
}

bool inClosedForm(const scene::PartSpec& moving, const scene::PartSpec& standing) {
    const auto* a = std::get_if<shape::Shape>(&moving.geometry);
    const auto* b = std::get_if<shape::Shape>(&standing.geometry);
    if (a == nullptr || b == nullptr) return false;
    const auto solid_a = closed_form::solidOf(*a), solid_b = closed_form::solidOf(*b);
    return solid_a && solid_b && !closed_form::isThread(*solid_a) && !closed_form::isThread(*solid_b);
}

FreeRoom::FreeRoom(const scene::Part& moving, std::vector<RestingPart> standing, bool closed_form)
    : standing_(std::move(standing)),
      box_(geometry::boundsOf(moving.mesh)),
      reach_(reachOf(moving.mesh)),
      per_turn_(kTurnPerReach * reach_),
      contacts_(closed_form ? closedFormContacts(moving, standing_, {.radius = per_turn_})
                            : surfaceContacts(moving, standing_, {.radius = per_turn_})) {}

FreeRoom::~FreeRoom() = default;

geometry::Bounds FreeRoom::boundsWith(const Pose& a, const Pose& b) const {
    geometry::Bounds bounds;
    extendBy(bounds, box_, a);
    extendBy(bounds, box_, b);
    for (const RestingPart& one : standing_) extendBy(bounds, geometry::boundsOf(one.part->mesh), one.X_WO);
    return bounds;
}

Nearness FreeRoom::clearanceAt(const Pose& X, double within) const { return contacts_->clearanceAt(X, within); }

bool FreeRoom::isFreeBetween(const Pose& a, const Pose& b, double least) const {
    const double way = wayBetween(a, b, reach_), within = std::max(2.0 * least, 0.5 * reach_);
    // Most ways that are not free are not so at one of these.
    for (const double share : {1.0, 0.5, 0.25, 0.75, 0.125, 0.375, 0.625, 0.875})
        if (clearanceAt(poseBetween(a, b, share), 2.0 * least).bound < least) return false;
    double done = 0.0;
    for (int i = 0; i < kMostPoses; ++i) {
        const double room = clearanceAt(poseBetween(a, b, way > 0.0 ? done / way : 1.0), within).bound;
        if (room < least) return false;
        if (done >= way) return true;
        done = std::min(way, done + kSurelyFree * room);
    }
    return false;
}

std::vector<Pose> FreeRoom::slide(const Pose& X, const Pose& X_to) const {
    const motion::Metric metric{.radius = per_turn_};
    contacts_->begin(X);
    std::vector<Pose> way{X};
    std::vector<Pose> last{X};  // at the end of each tick
    const motion::Motion whole = metric.between(X, X_to);
    const int ticks = std::max(1, static_cast<int>(std::ceil(metric.wayOf(whole, reach_) / kTickWay)));
    const double step = metric.wayOf(whole, reach_) / ticks;
    for (int tick = 1; tick <= ticks; ++tick) {
        contacts_->pull(metric.moved(X, whole, static_cast<double>(tick) / ticks), way);
        last.push_back(way.back());
        if (tick < kFewestTicks) continue;
        const auto before = static_cast<std::size_t>(std::max(0, tick - kLookBack));
        const double progress = wayBetween(last[before], last.back(), reach_);
        if (progress < kLeastProgress * step * static_cast<double>(last.size() - 1 - before)) break;
    }
    return way;
}

}  // namespace passung::path
