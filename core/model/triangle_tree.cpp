#include "core/model/triangle_tree.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

#include "core/base/assert.h"

namespace passung::model {

namespace {

constexpr std::uint32_t kLeafTriangles = 4;
constexpr int kBins = 16;
constexpr int kSahDepth = 32;            // below: halves, so that the depth stays under kStack
constexpr int kStack = 72;               // 32 + log2(2^32) + slack
constexpr double kFarRadii = 2.0;        // a cluster is far at this many of its radii (Barill's β)
constexpr double kCubeRounding = 1e-12;  // of lengths and coordinates around a cube
constexpr double kNeedle = 1e-4;         // height over longest edge, below which a triangle is treated with care

/// A triangle while the tree is built.
struct Item {
    Vec3 low, high, centre;
    std::uint32_t index;
};

double halfArea(const Vec3& low, const Vec3& high) {
    const Vec3 s = high - low;
    return s.x() * s.y() + s.y() * s.z() + s.z() * s.x();
}

struct Bin {
    Bounds box;
    std::uint32_t count = 0;
    double cost() const { return count > 0 ? halfArea(box.low, box.high) * count : 0.0; }
    void add(const Bin& other) {
        box.low = box.low.cwiseMin(other.box.low);
        box.high = box.high.cwiseMax(other.box.high);
        count += other.count;
    }
};

int binOf(double centre, double low, double extent) {
    return std::clamp(static_cast<int>(kBins * ((centre - low) / extent)), 0, kBins - 1);
}

/// Cheapest of the kBins - 1 splits along an axis by the surface area heuristic: {cost, bins on the left}.
std::pair<double, int> cheapestSplit(const Item* items, std::uint32_t count, int axis, double low, double extent) {
    std::array<Bin, kBins> bins;
    for (std::uint32_t i = 0; i < count; ++i) {
        Bin& bin = bins[static_cast<std::size_t>(binOf(items[i].centre[axis], low, extent))];
        bin.box.extend(items[i].low);
        bin.box.extend(items[i].high);
        ++bin.count;
    }
    std::array<double, kBins> right_cost{};
    Bin right;
    for (std::size_t b = kBins - 1; b > 0; --b) {
        right.add(bins[b]);
        right_cost[b] = right.cost();
    }
    std::pair<double, int> best{std::numeric_limits<double>::infinity(), 0};
    Bin left;
    for (std::size_t b = 1; b < kBins; ++b) {
        left.add(bins[b - 1]);
        const double cost = left.cost() + right_cost[b];
        if (left.count > 0 && left.count < count && cost < best.first) best = {cost, static_cast<int>(b)};
    }
    return best;
}

/// Sorts `items` into two groups; how many are in the first. Never 0, never all.
std::uint32_t split(Item* items, std::uint32_t count, int depth) {
    Bounds centres;
    for (std::uint32_t i = 0; i < count; ++i) centres.extend(items[i].centre);
    int axis = 0;
    centres.size().maxCoeff(&axis);
    if (depth < kSahDepth) {
        double best_cost = std::numeric_limits<double>::infinity();
        int best_axis = -1, best_bins = 0;
        for (int k = 0; k < 3; ++k) {
            const double extent = centres.size()[k];
            if (!(extent > 0.0)) continue;
            const auto [cost, bins] = cheapestSplit(items, count, k, centres.low[k], extent);
            if (cost < best_cost) {
                best_cost = cost;
                best_axis = k;
                best_bins = bins;
            }
        }
        if (best_axis >= 0) {
            const double low = centres.low[best_axis], extent = centres.size()[best_axis];
            const Item* middle = std::stable_partition(items, items + count, [&](const Item& item) {
                return binOf(item.centre[best_axis], low, extent) < best_bins;
            });
            return static_cast<std::uint32_t>(middle - items);
        }
    }
    std::sort(items, items + count, [axis](const Item& a, const Item& b) {
        return std::pair(a.centre[axis], a.index) < std::pair(b.centre[axis], b.index);
    });
    return count / 2;
}

double squaredToBox(const Vec3& p, const Vec3& low, const Vec3& high) {
    return (low - p).cwiseMax(p - high).cwiseMax(0.0).squaredNorm();
}

/// Rounding spoils the regions of a triangle that is much longer than high: the weights err by ε (distance/height)².
/// What they name is still a point of the triangle, so the nearest of it and of the edges' is taken; either errs by
/// less than height²/distance. Without area the regions may name no number, which no comparison prefers.
Vec3 closestOnNeedle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    Vec3 best = closestOnSegment(p, a, b);
    for (const Vec3& q : {closestOnSegment(p, b, c), closestOnSegment(p, c, a), closestOnTriangle(p, a, b, c)})
        if ((q - p).squaredNorm() < (best - p).squaredNorm()) best = q;
    return best;
}

Vec3 closestPoint(const TriangleTree::Corners& t, const Vec3& p) {
    return t.needle ? closestOnNeedle(p, t.a, t.b, t.c) : closestOnTriangle(p, t.a, t.b, t.c);
}

bool isNeedle(const Vec3& a, const Vec3& b, const Vec3& c) {
    const double longest2 = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
    return !((b - a).cross(c - a).norm() > kNeedle * longest2);
}

/// Sum of half solid angles of triangles seen from one point, positive from behind their front faces
/// (A. Van Oosterom, J. Strackee 1983). With a, b, c the corners relative to the point and a, b, c their lengths,
///   tan(Ω/2) = a·(b×c) / (abc + (a·b)c + (b·c)a + (c·a)b) = y/x,
/// so Ω/2 is the angle of the complex number x + iy, and a sum of angles is the angle of a product. Two numbers in the
/// upper half plane whose product leaves it have passed half a turn (and likewise below): that is counted apart, and
/// one arc tangent serves a whole leaf.
class HalfAngleSum {
public:
    void add(const Vec3& a, const Vec3& b, const Vec3& c) {
        const double la = a.norm(), lb = b.norm(), lc = c.norm();
        const double x = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
        const double y = a.dot(b.cross(c));
        if (y == 0.0 && x >= 0.0) return;  // seen edge-on, or without area
        const double next_x = x_ * x - y_ * y, next_y = x_ * y + y_ * x;
        if (y_ >= 0.0 && y >= 0.0 && next_y < 0.0) ++turns_;
        if (y_ < 0.0 && y < 0.0 && next_y >= 0.0) --turns_;
        x_ = next_x;
        y_ = next_y;
    }
    double value() const { return std::atan2(y_, x_) + 2.0 * std::numbers::pi * turns_; }

private:
    double x_ = 1.0, y_ = 0.0;
    int turns_ = 0;
};

}  // namespace

TriangleTree::TriangleTree(const TriangleMesh& mesh) {
    PASSUNG_ASSERT(!mesh.triangles.empty());
    const std::size_t n = mesh.triangles.size();
    std::vector<Item> items(n);
    for (std::size_t i = 0; i < n; ++i) {
        Bounds box;
        for (const std::uint32_t v : mesh.triangles[i]) box.extend(mesh.vertices[v]);
        items[i] = {box.low, box.high, 0.5 * (box.low + box.high), static_cast<std::uint32_t>(i)};
    }

    struct Task {
        std::uint32_t node, first, count;
        int depth;
    };
    std::vector<Task> tasks{{0, 0, static_cast<std::uint32_t>(n), 0}};
    nodes_.resize(1);
    while (!tasks.empty()) {
        const Task task = tasks.back();
        tasks.pop_back();
        Bounds box;
        for (std::uint32_t i = task.first; i < task.first + task.count; ++i) {
            box.extend(items[i].low);
            box.extend(items[i].high);
        }
        nodes_[task.node] = {box.low, box.high, task.first, task.count};
        if (task.count <= kLeafTriangles) continue;
        const std::uint32_t left = split(items.data() + task.first, task.count, task.depth);
        const auto child = static_cast<std::uint32_t>(nodes_.size());
        nodes_.resize(nodes_.size() + 2);
        nodes_[task.node].first = child;
        nodes_[task.node].count = 0;
        tasks.push_back({child + 1, task.first + left, task.count - left, task.depth + 1});
        tasks.push_back({child, task.first, left, task.depth + 1});
    }

    corners_.reserve(n);
    original_.reserve(n);
    for (const Item& item : items) {
        const Triangle& t = mesh.triangles[item.index];
        const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
        corners_.push_back({a, b, c, isNeedle(a, b, c)});
        original_.push_back(item.index);
    }

    // The triangles below a node are contiguous: from the first of its leftmost leaf to the last of its rightmost one.
    // Children come after their parent, so the ranges are known when going backwards.
    std::vector<std::pair<std::uint32_t, std::uint32_t>> ranges(nodes_.size());
    clusters_.resize(nodes_.size());
    for (std::size_t k = nodes_.size(); k-- > 0;) {
        const Node& node = nodes_[k];
        ranges[k] = node.count > 0 ? std::pair(node.first, node.first + node.count)
                                   : std::pair(ranges[node.first].first, ranges[node.first + 1].second);
        clusters_[k] = summarise(ranges[k].first, ranges[k].second - ranges[k].first);
    }
}

TriangleTree::Cluster TriangleTree::summarise(std::uint32_t first, std::uint32_t count) const {
    Vec3 dipole = Vec3::Zero(), moment = Vec3::Zero(), mean = Vec3::Zero();
    double area = 0.0;
    for (std::uint32_t i = first; i < first + count; ++i) {
        const auto& [a, b, c, needle] = corners_[i];
        const Vec3 normal = 0.5 * (b - a).cross(c - a);
        const Vec3 centroid = (a + b + c) / 3.0;
        dipole += normal;
        moment += normal.norm() * centroid;
        mean += centroid / count;
        area += normal.norm();
    }
    const Vec3 centre = area > 0.0 ? Vec3(moment / area) : mean;
    double radius2 = 0.0;
    for (std::uint32_t i = first; i < first + count; ++i)
        for (const Vec3& corner : {corners_[i].a, corners_[i].b, corners_[i].c})
            radius2 = std::max(radius2, (corner - centre).squaredNorm());
    return {centre, dipole, kFarRadii * kFarRadii * radius2};
}

ClosestPoint TriangleTree::closest(const Vec3& p, double limit) const {
    struct Entry {
        std::uint32_t node;
        double squared;
    };
    std::array<Entry, kStack> stack;
    int size = 0;
    double best = limit * limit;
    Vec3 way = Vec3::Zero();
    ClosestPoint result{limit, p, 0, 0};
    bool found = false;
    stack[static_cast<std::size_t>(size++)] = {0, squaredToBox(p, nodes_[0].low, nodes_[0].high)};
    while (size > 0) {
        const Entry entry = stack[static_cast<std::size_t>(--size)];
        if (entry.squared >= best) continue;
        const Node& node = nodes_[entry.node];
        if (node.count == 0) {
            const Node &left = nodes_[node.first], &right = nodes_[node.first + 1];
            Entry near{node.first, squaredToBox(p, left.low, left.high)};
            Entry far{node.first + 1, squaredToBox(p, right.low, right.high)};
            if (far.squared < near.squared) std::swap(near, far);
            if (far.squared < best) stack[static_cast<std::size_t>(size++)] = far;
            if (near.squared < best) stack[static_cast<std::size_t>(size++)] = near;
            continue;
        }
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
            // A triangle beyond the plane through the best point, across the way to it, is no nearer.
            const Corners& t = corners_[i];
            if (std::min({t.a.dot(way), t.b.dot(way), t.c.dot(way)}) - p.dot(way) >= best) continue;
            const Vec3 q = closestPoint(t, p);
            const double squared = (q - p).squaredNorm();
            if (squared < best) {
                best = squared;
                way = q - p;
                result.point = q;
                result.triangle = original_[i];
                result.place = i;
                found = true;
            }
        }
    }
    if (found) result.distance = std::sqrt(best);
    return result;
}

static bool meet(const Bounds& box, const Vec3& low, const Vec3& high) {
    return (low.array() <= box.high.array()).all() && (high.array() >= box.low.array()).all();
}

static bool meets(const Bounds& box, const TriangleTree::Corners& t) {
    return meet(box, t.a.cwiseMin(t.b).cwiseMin(t.c), t.a.cwiseMax(t.b).cwiseMax(t.c));
}

/// Looks into the nodes that `enters` lets through, and gives the triangles of their leaves to `visit`, in tree order,
/// until it says false.
template <class Enters, class Visit>
void TriangleTree::walk(Enters enters, Visit visit) const {
    std::array<std::uint32_t, kStack> stack;
    int size = 0;
    stack[static_cast<std::size_t>(size++)] = 0;
    while (size > 0) {
        const Node& node = nodes_[stack[static_cast<std::size_t>(--size)]];
        if (!enters(node)) continue;
        if (node.count == 0) {
            stack[static_cast<std::size_t>(size++)] = node.first + 1;
            stack[static_cast<std::size_t>(size++)] = node.first;
            continue;
        }
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
            if (!visit(i)) return;
    }
}

void TriangleTree::findNear(const Vec3& p, double radius, std::vector<std::uint32_t>& found) const {
    walk([&](const Node& node) { return squaredToBox(p, node.low, node.high) <= radius * radius; },
         [&](std::uint32_t i) {
             found.push_back(i);
             return true;
         });
}

void TriangleTree::findAbove(const Bounds& box, const Vec3& way, double least,
                             std::vector<std::uint32_t>& found) const {
    const Vec3 half_way = 0.5 * way, half_reach = half_way.cwiseAbs();
    walk(
        [&](const Node& node) {
            return meet(box, node.low, node.high) &&
                   half_way.dot(node.low + node.high) + half_reach.dot(node.high - node.low) >= least;
        },
        [&](std::uint32_t i) {
            const Corners& t = corners_[i];
            if (std::max({way.dot(t.a), way.dot(t.b), way.dot(t.c)}) >= least && meets(box, t)) found.push_back(i);
            return true;
        });
}

/// Above is the distance u from the triangle nearest to the centre c, convex, hence nowhere above its values at the
/// corners interpolated; below is the support s of the distance from a box at c, linear. Where s > u at all corners the
/// triangles of the box are nowhere nearest.
void TriangleTree::findNearest(const Vec3& centre, double half, std::vector<std::uint32_t>& found) const {
    const ClosestPoint closest_point = closest(centre);
    const double rounding = kCubeRounding * (closest_point.distance + half + centre.cwiseAbs().maxCoeff());
    std::array<double, 8> above;
    for (std::size_t i = 0; i < 8; ++i) {
        const Vec3 corner = centre + half * Vec3(i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0);
        above[i] = (closestPoint(corners_[closest_point.place], corner) - corner).norm() + rounding;
    }
    walk(
        [&](const Node& node) {
            const Vec3 way = centre - centre.cwiseMax(node.low).cwiseMin(node.high);
            const double d = way.norm();
            const Vec3 turn = d > 0.0 ? Vec3((half / d) * way) : Vec3(Vec3::Zero());
            bool near = false;
            for (std::size_t i = 0; i < 8; ++i)
                near |= d + ((i & 1 ? turn.x() : -turn.x()) + (i & 2 ? turn.y() : -turn.y()) +
                             (i & 4 ? turn.z() : -turn.z())) <=
                        above[i];
            return near;
        },
        [&](std::uint32_t i) {
            found.push_back(i);
            return true;
        });
}

TrianglePair TriangleTree::closestTo(const TriangleCorners& triangle, double limit) const {
    struct Entry {
        std::uint32_t node;
        double squared;
    };
    Bounds box;
    for (const Vec3& corner : triangle) box.extend(corner);
    const auto apart = [&](const Node& node) {
        return (box.low - node.high).cwiseMax(node.low - box.high).cwiseMax(0.0).squaredNorm();
    };
    std::array<Entry, kStack> stack;
    int size = 0;
    TrianglePair best{limit, triangle[0], triangle[0]};
    double squared = limit * limit;
    stack[static_cast<std::size_t>(size++)] = {0, apart(nodes_[0])};
    while (size > 0) {
        const Entry entry = stack[static_cast<std::size_t>(--size)];
        if (entry.squared >= squared) continue;
        const Node& node = nodes_[entry.node];
        if (node.count == 0) {
            Entry near{node.first, apart(nodes_[node.first])};
            Entry far{node.first + 1, apart(nodes_[node.first + 1])};
            if (far.squared < near.squared) std::swap(near, far);
            if (far.squared < squared) stack[static_cast<std::size_t>(size++)] = far;
            if (near.squared < squared) stack[static_cast<std::size_t>(size++)] = near;
            continue;
        }
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
            const TrianglePair pair =
                closestPair(triangle, {corners_[i].a, corners_[i].b, corners_[i].c}, best.distance);
            if (!(pair.distance < best.distance)) continue;
            best = pair;
            squared = pair.distance * pair.distance;
        }
    }
    return best;
}

double TriangleTree::windingNumber(const Vec3& p) const {
    std::array<std::uint32_t, kStack> stack;
    int size = 0;
    stack[static_cast<std::size_t>(size++)] = 0;
    double near_sum = 0.0;  // half solid angles
    double far_sum = 0.0;   // solid angles of dipoles
    while (size > 0) {
        const std::uint32_t index = stack[static_cast<std::size_t>(--size)];
        const Cluster& cluster = clusters_[index];
        const Vec3 to_centre = cluster.centre - p;
        const double squared = to_centre.squaredNorm();
        if (squared > cluster.far_squared) {
            far_sum += to_centre.dot(cluster.dipole) / (squared * std::sqrt(squared));
            continue;
        }
        const Node& node = nodes_[index];
        if (node.count == 0) {
            stack[static_cast<std::size_t>(size++)] = node.first + 1;
            stack[static_cast<std::size_t>(size++)] = node.first;
            continue;
        }
        HalfAngleSum leaf;
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
            leaf.add(corners_[i].a - p, corners_[i].b - p, corners_[i].c - p);
        near_sum += leaf.value();
    }
    return (2.0 * near_sum + far_sum) / (4.0 * std::numbers::pi);
}

void TriangleTree::collectWithin(const Bounds& box, std::size_t most, std::vector<std::uint32_t>& triangles) const {
    triangles.clear();
    walk([&](const Node& node) { return meet(box, node.low, node.high); },
         [&](std::uint32_t i) {
             if (!meets(box, corners_[i])) return true;
             if (triangles.size() == most) return false;
             triangles.push_back(original_[i]);
             return true;
         });
}

}  // namespace passung::model
