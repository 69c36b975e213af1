#include "core/path/free_room.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/surface/nearest_faces.h"

namespace passung::path {

namespace {

constexpr double kTurnPerReach = 0.5;   // radius of the metric over the part's reach
constexpr double kTickWay = 1e-3;       // of the hand in a tick, at most [m]
constexpr int kBudget = 400000;         // of a tick: nobody waits for it
constexpr int kFewestTicks = 4;         // before it may be blocked
constexpr int kLookBack = 12;           // ticks
constexpr double kLeastProgress = 0.1;  // of the hand's way in that time
constexpr double kSurelyFree = 0.9;     // of the clearance, as the next step

surface::SurfaceSettings settingsOf(const motion::Metric& metric) {
    return {.metric = metric, .gap = 1e-6, .budget = kBudget};
}

std::vector<surface::SurfaceBody> bodiesOf(const std::vector<Standing>& standing) {
    std::vector<surface::SurfaceBody> bodies;
    for (const Standing& one : standing) bodies.push_back({one.part->clusters.get(), one.X_WO});
    return bodies;
}

void extendBy(geometry::Bounds& bounds, const geometry::Bounds& box, const Pose& X) {
    for (int corner = 0; corner < 8; ++corner)
        bounds.extend(X * Vec3((corner & 1) != 0 ? box.high.x() : box.low.x(),
                               (corner & 2) != 0 ? box.high.y() : box.low.y(),
                               (corner & 4) != 0 ? box.high.z() : box.low.z()));
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

FreeRoom::FreeRoom(const scene::Part& moving, std::vector<Standing> standing)
    : moving_(moving),
      standing_(std::move(standing)),
      reach_(moving.clusters->reach()),
      metric_{.radius = kTurnPerReach * reach_},
      proxy_(std::make_unique<surface::SurfaceProxy>(*moving.clusters, bodiesOf(standing_), settingsOf(metric_))) {}

FreeRoom::~FreeRoom() = default;

geometry::Bounds FreeRoom::boundsWith(const Pose& a, const Pose& b) const {
    geometry::Bounds bounds;
    extendBy(bounds, moving_.clusters->box(), a);
    extendBy(bounds, moving_.clusters->box(), b);
    for (const Standing& one : standing_) extendBy(bounds, one.part->clusters->box(), one.X_WO);
    return bounds;
}

Clearance FreeRoom::clearanceAt(const Pose& X, double within) const {
    Clearance least{.distance = within, .bound = within, .standing = {}};
    for (std::size_t i = 0; i < standing_.size(); ++i) {
        const Standing& one = standing_[i];
        const surface::NearestHulls now =
            surface::nearestFaces(*moving_.clusters, *one.part->clusters, one.X_WO.inverse() * X, least.distance);
        const double chords = moving_.chord_error + one.part->chord_error;
        if (now.distance >= least.distance) {
            least.bound = std::min(least.bound, least.distance - chords);
            continue;
        }
        least = {now.distance, std::min(least.bound, now.separation - chords), i, one.X_WO * now.on_obstacle};
    }
    return least;
}

bool FreeRoom::isFreeBetween(const Pose& a, const Pose& b, double least) const {
    const double way = wayBetween(a, b, reach_), within = std::max(2.0 * least, 0.5 * reach_);
    // Most ways that are not free are not so at one of these.
    for (const double share : {1.0, 0.5, 0.25, 0.75, 0.125, 0.375, 0.625, 0.875})
        if (clearanceAt(poseBetween(a, b, share), 2.0 * least).distance < least) return false;
    double done = 0.0;
    for (int i = 0; i < kMostPoses; ++i) {
        const double room = clearanceAt(poseBetween(a, b, way > 0.0 ? done / way : 1.0), within).distance;
        if (room < least) return false;
        if (done >= way) return true;
        done = std::min(way, done + kSurelyFree * room);
    }
    return false;
}

std::vector<Pose> FreeRoom::slide(const Pose& X, const Pose& X_to) const {
    proxy_->place(X);
    proxy_->prepare();
    std::vector<Pose> way{X};
    std::vector<Pose> last{X};  // at the end of each tick
    const motion::Motion whole = metric_.between(X, X_to);
    const int ticks = std::max(1, static_cast<int>(std::ceil(metric_.wayOf(whole, reach_) / kTickWay)));
    const double step = metric_.wayOf(whole, reach_) / ticks;
    for (int tick = 1; tick <= ticks; ++tick) {
        proxy_->advance(metric_.moved(X, whole, static_cast<double>(tick) / ticks));
        for (const Pose& pose : proxy_->chain())
            if (wayBetween(way.back(), pose, reach_) > 0.0) way.push_back(pose);
        last.push_back(proxy_->pose());
        if (tick < kFewestTicks) continue;
        const auto before = static_cast<std::size_t>(std::max(0, tick - kLookBack));
        const double progress = wayBetween(last[before], last.back(), reach_);
        if (progress < kLeastProgress * step * static_cast<double>(last.size() - 1 - before)) break;
    }
    if (wayBetween(way.back(), proxy_->pose(), reach_) > 0.0) way.push_back(proxy_->pose());
    return way;
}

}  // namespace passung::path
