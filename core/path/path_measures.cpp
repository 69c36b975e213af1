#include "core/path/path_measures.h"

#include <algorithm>

namespace passung::path {

namespace {

constexpr double kHalf = 0.5;
constexpr double kKept = 0.95;  // of the clearance of what is left out

/// Looks along one piece of a path; begins behind its first pose.
void lookAlong(const FreeRoom& room, const Pose& a, const Pose& b, Nearness before, PathMeasures& found) {
    const double way = wayBetween(a, b, room.reach());
    for (double done = 0.0; done < way;) {
        const double step = std::min(way - done, std::max(kDenseStep, kHalf * before.bound));
        done += step;
        const Pose X = poseBetween(a, b, done / way);
        const Nearness now = room.clearanceAt(X, kFar);
        found.proven = std::min(found.proven, 0.5 * (before.bound + now.bound - step));
        ++found.looked_at;
        if (now.distance < found.least.distance) {
            found.least = now;
            found.X_least = X;
        }
        before = now;
    }
}

}  // namespace

PathMeasures measure(const FreeRoom& room, const std::vector<Pose>& path) {
    PathMeasures found;
    if (path.empty()) return found;
    found.least = room.clearanceAt(path.front(), kFar);
    found.X_least = path.front();
    found.proven = found.least.bound;
    found.looked_at = 1;
    found.at_waypoints.push_back(found.least.distance);
    for (std::size_t i = 1; i < path.size(); ++i) {
        found.length += (path[i].p - path[i - 1].p).norm();
        found.turn += path[i - 1].q.angularDistance(path[i].q);
        lookAlong(room, path[i - 1], path[i], room.clearanceAt(path[i - 1], kFar), found);
        found.at_waypoints.push_back(room.clearanceAt(path[i], kFar).distance);
    }
    return found;
}

std::vector<Pose> shorten(const FreeRoom& room, const std::vector<Pose>& path, double least) {
    if (path.size() < 3) return path;
    std::vector<double> clear;
    for (const Pose& X : path) clear.push_back(room.clearanceAt(X, kFar).distance);
    std::vector<Pose> kept{path.front()};
    for (std::size_t i = 0; i + 1 < path.size();) {
        std::size_t to = path.size() - 1;
        for (; to > i + 1; to = i + std::max<std::size_t>(1, (to - i) / 2)) {
            const double before = *std::min_element(clear.begin() + static_cast<std::ptrdiff_t>(i),
                                                    clear.begin() + static_cast<std::ptrdiff_t>(to) + 1);
            const double enough = std::max(least, kKept * before);
            if (room.isFreeBetween(path[i], path[to], enough)) break;
        }
        kept.push_back(path[to]);
        i = to;
    }
    return kept;
}

}  // namespace passung::path
