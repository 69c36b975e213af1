#include "core/shape/thin_features.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <tuple>

#include "core/geometry/mesh_edges.h"
#include "core/geometry/parallel.h"
#include "core/shape/thread.h"

namespace passung::shape {
namespace {

constexpr double kRoom = 0.97;            // of the radius: a ball of this has room, as far as the search is exact
constexpr std::size_t kMostSeeds = 3000;  // places looked at closely
constexpr double kRegion = 4.0;           // radii: from each of these some places are looked at
constexpr std::size_t kDirections = 32;
constexpr int kClimbs = 80;  // steps of a search
constexpr int kLeaps = 12;
constexpr double kNear = 0.63 * kFelt;  // [radii] from the rim of a pin as thick as 0.85 radii to its middle
constexpr double kTaper = 1.25;         // an end is an edge or tip if it is so much thicker at kFelt than at kNear
constexpr double kFlatDeficit = 1e-4;   // [rad] a vertex of less bends along one axis at most
constexpr double kCornerDeficit = 0.5;  // [rad] of more: a corner
constexpr double kGroupReach = 2.5;     // seeds so many radii apart belong to one feature

/// Places that may be the end of a feature.
struct Seed {
    Vec3 place;
    bool clear;   // on a sharp edge, a corner, or a face that is flat or developed
    bool face;    // amid one
    Vec3 inward;  // unit
};

struct JudgedFeature {
    bool thin = false;
    double near = 0.0, far = 0.0;  // radius of the largest ball within kNear and kFelt radii
    bool looked_at = true;
};

/// Questions asked of the tree, those for the inside counted as several: the same on every machine.
using Work = std::size_t;
constexpr Work kInsideWork = 4;
constexpr std::size_t kSeedsPerRound = 64;  // between two looks at the work

/// Directions spread evenly over the sphere (Fibonacci lattice).
std::array<Vec3, kDirections> directions() {
    std::array<Vec3, kDirections> result;
    const double golden = std::numbers::pi * (3.0 - std::sqrt(5.0));
    for (std::size_t i = 0; i < kDirections; ++i) {
        const double z = 1.0 - (2.0 * static_cast<double>(i) + 1.0) / static_cast<double>(kDirections);
        const double r = std::sqrt(1.0 - z * z), turn = golden * static_cast<double>(i);
        result[i] = {r * std::cos(turn), r * std::sin(turn), z};
    }
    return result;
}

/// One mesh, one radius.
class Search {
public:
    Search(const geometry::TriangleTree& tree, double radius)
        : tree_(tree), radius_(radius), directions_(directions()) {}

    /// A ball of the radius touches the surface at `p`, whose unit normal is `n`, from within.
    bool hasRoomAt(const Vec3& p, const Vec3& n) const {
        return tree_.closest(p - radius_ * n, radius_).distance >= kRoom * radius_;
    }

    JudgedFeature judge(const Seed& seed, Work& work) const {
        const double near = largestWithin(seed, kNear * radius_, work),
                     far = largestWithin(seed, kFelt * radius_, work);
        if (far >= kRoom * radius_) return {false, near, far};
        if (far > kTaper * near && largestWithin(seed, kBlunt * radius_, work) >= kRoom * radius_)
            return {false, near, far};
        return {true, near, far};
    }

private:
    /// Radius of the largest ball in the solid whose centre is within `reach` of the seed, at most the radius asked
    /// for.
    double largestWithin(const Seed& seed, double reach, Work& work) const {
        double largest = 0.0;
        for (const double step : {0.3, 0.1, 0.03, 0.01, 0.003}) {
            const Vec3 c = seed.place + step * radius_ * seed.inward;
            if (!isInside(c, work)) continue;
            largest = climb(seed.place, reach, c, work);
            break;
        }
        // Straight in from an edge, as deep as may be: a climb from its end is slow between faces of a small angle.
        for (const double share : {1.0, 0.8, 0.6}) {
            if (largest >= kRoom * radius_) break;
            const Vec3 c = seed.place + share * reach * seed.inward;
            if (isInside(c, work)) largest = std::max(largest, climb(seed.place, reach, c, work));
        }
        // What lies across a narrow neck, under a low pin for instance, is found from there.
        for (const Vec3& way : directions_) {
            if (largest >= kRoom * radius_) break;
            const Vec3 c = seed.place + 0.9 * reach * way;
            if (closest(c, radius_, work).distance > std::max(largest, 0.3 * radius_) && isInside(c, work))
                largest = std::max(largest, climb(seed.place, reach, c, work));
        }
        return largest;
    }

    /// Walks away from the surface, no farther than `reach` from `q`: each step is what lacks to the radius, from
    /// whatever is nearest, which next to convex edges leads to the nearest ball that has room (projections on half
    /// spaces in turn), but so short that it cannot leave the solid. Between two faces that goes to and fro: what two
    /// steps lead on is then taken further, as long as it leads to more room.
    double climb(const Vec3& q, double reach, Vec3 c, Work& work) const {
        const auto within = [&](const Vec3& p) {
            const double away = (p - q).norm();
            return away > reach ? Vec3(q + (reach / away) * (p - q)) : p;
        };
        double largest = 0.0;
        Vec3 before = c;  // two steps ago
        for (int i = 0; i < kClimbs; ++i) {
            const geometry::ClosestPoint found = closest(c, 2.0 * radius_, work);
            largest = std::max(largest, std::min(found.distance, radius_));
            if (found.distance >= kRoom * radius_ || !(found.distance > 0.0)) break;
            const double step = std::min(1.001 * radius_ - found.distance, 0.5 * found.distance);
            c = within(c + step * (c - found.point) / found.distance);
            if (i % 2 == 0) continue;
            Vec3 on = c - before;
            double room = closest(c, 2.0 * radius_, work).distance;
            for (int k = 0; k < kLeaps && on.norm() < reach; ++k, on *= 2.0) {
                const Vec3 there = within(c + on);
                const double more = closest(there, 2.0 * radius_, work).distance;
                if (!(more > room) || !isInside(there, work)) break;
                c = there;
                room = more;
            }
            before = c;
        }
        // Between opposite faces that swings for ever: it comes to rest amid them.
        for (double share = 0.5; share > 0.01 && largest < kRoom * radius_; share *= 0.85) {
            const geometry::ClosestPoint found = closest(c, 2.0 * radius_, work);
            largest = std::max(largest, std::min(found.distance, radius_));
            if (!(found.distance > 0.0)) break;
            c = within(c + share * (c - found.point));
        }
        return largest;
    }

    geometry::ClosestPoint closest(const Vec3& p, double limit, Work& work) const {
        ++work;
        return tree_.closest(p, limit);
    }
    bool isInside(const Vec3& p, Work& work) const {
        work += kInsideWork;
        return tree_.inside(p);
    }

    const geometry::TriangleTree& tree_;
    double radius_;
    std::array<Vec3, kDirections> directions_;
};

Vec3 areaVectorOf(const geometry::TriangleMesh& mesh, const geometry::Triangle& t) {
    const Vec3& a = mesh.vertices[t[0]];
    return (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a);
}

/// What angles at each vertex are short of a full turn [rad].
std::vector<double> deficits(const geometry::TriangleMesh& mesh) {
    std::vector<double> left(mesh.vertices.size(), 2.0 * std::numbers::pi);
    for (const geometry::Triangle& t : mesh.triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 &p = mesh.vertices[t[k]], a = mesh.vertices[t[(k + 1) % 3]] - p,
                       b = mesh.vertices[t[(k + 2) % 3]] - p;
            left[t[k]] -= std::atan2(a.cross(b).norm(), a.dot(b));
        }
    return left;
}

/// All places worth a look; one for each cube of half a radius.
std::vector<Seed> seedsOf(const geometry::TriangleMesh& mesh, const Search& search, double radius, ThinIn where) {
    std::vector<Seed> found;
    std::vector<bool> sharp(mesh.vertices.size(), false);
    std::vector<Vec3> outward(mesh.vertices.size(), Vec3::Zero());  // of the sharp edges at a vertex
    for (const geometry::SharpEdge& edge : geometry::sharpEdges(mesh)) {
        const Vec3 &a = mesh.vertices[edge.edge.low], &b = mesh.vertices[edge.edge.high];
        sharp[edge.edge.low] = sharp[edge.edge.high] = true;
        if (edge.inner) continue;
        const Vec3 out = edge.normal.stableNormalized();
        outward[edge.edge.low] += out;
        outward[edge.edge.high] += out;
        const int pieces = std::clamp(static_cast<int>(std::ceil((b - a).norm() / radius)), 1, 200);
        for (int i = 0; i < pieces; ++i) found.push_back({a + (b - a) * ((i + 0.5) / pieces), true, false, -out});
    }
    for (std::size_t v = 0; v < outward.size(); ++v)
        if (outward[v].squaredNorm() > 0.0)
            found.push_back({mesh.vertices[v], true, false, -outward[v].stableNormalized()});
    std::vector<Vec3> normals(mesh.vertices.size(), Vec3::Zero());
    for (const geometry::Triangle& t : mesh.triangles)
        for (const std::uint32_t v : t) normals[v] += areaVectorOf(mesh, t);
    const std::vector<double> bend = deficits(mesh);
    std::vector<char> tight(mesh.vertices.size(), 0);
    geometry::parallelFor(mesh.vertices.size(), [&](std::size_t v) {
        if (sharp[v] || !(normals[v].squaredNorm() > 0.0)) return;
        tight[v] = search.hasRoomAt(mesh.vertices[v], normals[v].normalized()) ? 0 : 1;
    });
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
        if (tight[v] == 0) continue;
        const double deficit = std::abs(bend[v]);
        // A face that is bent along one axis ends at edges, which are there already.
        const bool developed = deficit < kFlatDeficit;
        if (developed && where == ThinIn::Points) continue;
        found.push_back({mesh.vertices[v], developed || deficit > kCornerDeficit, false, -normals[v].normalized()});
    }
    if (where == ThinIn::Field)
        for (const geometry::Triangle& t : mesh.triangles) {
            const Vec3 area = areaVectorOf(mesh, t);
            const Vec3 p = (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3.0;
            const bool large = area.norm() > radius * radius;
            if (large && !search.hasRoomAt(p, area.normalized())) found.push_back({p, true, true, -area.normalized()});
        }
    std::map<std::array<long, 3>, Seed> cubes;
    const double edge = 0.5 * radius;
    for (const Seed& seed : found) {
        const auto at = [&](int axis) { return std::lround(seed.place[axis] / edge); };
        cubes.try_emplace({at(0), at(1), at(2)}, seed);
    }
    // Of many, as many from each region of some radii, so that none is left out.
    std::map<std::array<long, 3>, std::vector<const Seed*>> regions;
    for (const auto& [cube, seed] : cubes) {
        const auto at = [&, &p = seed.place](int axis) { return std::lround(p[axis] / (kRegion * radius)); };
        regions[{at(0), at(1), at(2)}].push_back(&seed);
    }
    const std::size_t most = std::max<std::size_t>(2, kMostSeeds / std::max<std::size_t>(1, regions.size()));
    std::vector<Seed> seeds;
    for (const auto& [region, of] : regions) {
        const std::size_t every = cubes.size() <= kMostSeeds ? 1 : 1 + (of.size() - 1) / most;
        for (std::size_t i = 0; i < of.size(); i += every) seeds.push_back(*of[i]);
    }
    return seeds;
}

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// Every seed, in rounds, each of which is spread over the part; the rounds end when the work is too much.
std::vector<JudgedFeature> judgeAll(const Search& search, const std::vector<Seed>& seeds, SearchLimit& limit) {
    const std::size_t n = seeds.size(), rounds = (n + kSeedsPerRound - 1) / kSeedsPerRound;
    std::vector<JudgedFeature> judged(n, JudgedFeature{.looked_at = false});
    limit.work = 0;
    for (std::size_t round = 0; round < rounds && limit.work <= limit.most_work; ++round) {
        const std::size_t count = (n - round + rounds - 1) / rounds;
        std::vector<Work> work(count, 0);
        geometry::parallelFor(count, [&](std::size_t i) {
            const std::size_t k = round + i * rounds;
            judged[k] = search.judge(seeds[k], work[i]);
        });
        limit.work = std::accumulate(work.begin(), work.end(), limit.work);
    }
    limit.left_out = static_cast<std::size_t>(
        std::count_if(judged.begin(), judged.end(), [](const JudgedFeature& seed) { return !seed.looked_at; }));
    return judged;
}

/// One feature of the seeds in `members`.
ThinFeature summarise(const std::vector<Seed>& seeds, const std::vector<JudgedFeature>& judged,
                      const std::vector<std::size_t>& members) {
    geometry::Bounds bounds;
    std::vector<double> far, near;
    std::size_t clear = 0;
    Vec3 mean = Vec3::Zero();
    for (const std::size_t i : members) {
        far.push_back(judged[i].far);
        near.push_back(judged[i].near);
        mean += seeds[i].place / static_cast<double>(members.size());
        clear += seeds[i].clear ? 1 : 0;
    }
    Mat3 spread = Mat3::Zero();
    for (const std::size_t i : members) spread += (seeds[i].place - mean) * (seeds[i].place - mean).transpose();
    const Mat3 axes = Eigen::SelfAdjointEigenSolver<Mat3>(spread).eigenvectors();
    for (const std::size_t i : members) bounds.extend(axes.transpose() * (seeds[i].place - mean));
    Vec3 size = bounds.size();
    std::sort(size.data(), size.data() + 3);
    ThinFeature feature;
    feature.size = 2.0 * *std::max_element(far.begin(), far.end());
    feature.place = seeds[members[0]].place;
    const bool taper = median(far) > kTaper * median(near);
    if (2 * clear < members.size())
        feature.kind = FeatureKind::Relief;
    else if (taper)
        feature.kind = size[2] > 2.0 * feature.size ? FeatureKind::Edge : FeatureKind::Tip;
    else
        feature.kind = size[1] > 1.8 * feature.size ? FeatureKind::Wall : FeatureKind::Pin;
    return feature;
}

/// A dimension of a shape that may be thin.
struct Thickness {
    double size;
    FeatureKind kind;
    bool free_end;  // that a surface may be pressed on from its thin side
};

Thickness slab(double thickness, double other, double third, bool free_end = true) {
    const double second = std::min(other, third);
    const bool pin = second < 2.0 * thickness && std::max(other, third) > 1.2 * second;
    return {thickness, pin ? FeatureKind::Pin : FeatureKind::Wall, free_end};
}

Thickness block(double x, double y, double z) {
    std::array sides{x, y, z};
    std::sort(sides.begin(), sides.end());
    return slab(sides[0], sides[1], sides[2]);
}

Thickness rod(double diameter, double length) {
    return length < diameter ? Thickness{length, FeatureKind::Wall, true} : Thickness{diameter, FeatureKind::Pin, true};
}

struct ThicknessesOf {
    using List = std::vector<Thickness>;
    List operator()(const Sphere& s) const { return {{s.diameter, FeatureKind::Pin, true}}; }
    List operator()(const Box& s) const { return {block(s.width, s.depth, s.height)}; }
    List operator()(const Cylinder& s) const { return {rod(s.diameter, s.length)}; }
    List operator()(const Torus& s) const { return {{s.tube_diameter, FeatureKind::Pin, true}}; }
    List operator()(const Sheet&) const { return {{0.0, FeatureKind::Wall, true}}; }
    List operator()(const Peg& s) const { return {rod(s.diameter, s.length)}; }
    List operator()(const SquarePeg& s) const { return {block(s.width, s.depth, s.length)}; }
    List operator()(const KeyedPeg& s) const {
        return {rod(s.diameter, s.length), {s.key_width, FeatureKind::Wall, s.key_height > 0.5 * s.key_width}};
    }
    List operator()(const BorePlate& s) const { return plate(s, s.bore_diameter, s.bore_diameter, 0.0); }
    List operator()(const SquareBorePlate& s) const { return plate(s, s.pocket_width, s.pocket_depth, 0.0); }
    List operator()(const KeyedBorePlate& s) const { return plate(s, s.bore_diameter, s.bore_diameter, s.key_height); }
    List operator()(const ThreadBolt& s) const {
        return {rod(2.0 * threadOf(s).inner, s.length), {0.5 * s.pitch, FeatureKind::Wall, true}};
    }
    List operator()(const ThreadNut& s) const {
        return {{0.5 * s.outer_diameter - threadOf(s).outer, FeatureKind::Wall, true},
                {s.height, FeatureKind::Wall, true},
                {0.5 * s.pitch, FeatureKind::Wall, true}};
    }

    /// What is left of a plate around and under its hole.
    template <class Plate>
    static List plate(const Plate& s, double hole_x, double hole_y, double key) {
        const double beside = std::min(0.5 * (s.width - hole_x) - key, 0.5 * (s.depth - hole_y));
        List list{{beside, FeatureKind::Wall, true}, block(s.width, s.depth, s.height)};
        if (s.bore_depth < s.height) list.push_back({s.height - s.bore_depth, FeatureKind::Wall, false});
        return list;
    }
};

}  // namespace

const char* featureName(FeatureKind kind) {
    constexpr std::array kNames{"pin", "wall", "edge", "tip", "relief"};
    return kNames[static_cast<std::size_t>(kind)];
}

std::vector<ThinFeature> thinFeatures(const Shape& shape, double radius, ThinIn where) {
    std::vector<ThinFeature> features;
    for (const Thickness& thickness : std::visit(ThicknessesOf{}, shape)) {
        const bool felt = thickness.size >= 2.0 * radius || (where == ThinIn::Points && !thickness.free_end);
        if (!felt) features.push_back({thickness.kind, thickness.size, Vec3::Zero()});
    }
    return features;
}

std::vector<ThinFeature> thinFeatures(const geometry::TriangleMesh& mesh, const geometry::TriangleTree& tree,
                                      double radius, ThinIn where, SearchLimit* limit) {
    const Search search(tree, radius);
    const std::vector<Seed> seeds = seedsOf(mesh, search, radius, where);
    SearchLimit usual;
    const std::vector<JudgedFeature> judged = judgeAll(search, seeds, limit != nullptr ? *limit : usual);
    std::vector<std::size_t> thin;
    for (std::size_t i = 0; i < seeds.size(); ++i)
        if (judged[i].thin) thin.push_back(i);
    geometry::Groups groups(thin.size());
    const double reach = kGroupReach * radius;
    for (std::size_t i = 0; i < thin.size(); ++i)
        for (std::size_t k = i + 1; k < thin.size(); ++k)
            if ((seeds[thin[i]].place - seeds[thin[k]].place).squaredNorm() < reach * reach)
                groups.join(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(k));
    std::map<std::uint32_t, std::vector<std::size_t>> members;
    for (std::size_t i = 0; i < thin.size(); ++i)
        members[groups.find(static_cast<std::uint32_t>(i))].push_back(thin[i]);
    std::vector<ThinFeature> features;
    std::vector<ThinFeature> floors;  // thin amid a face, without an end that is
    for (const auto& [root, of] : members) {
        const bool faces = std::all_of(of.begin(), of.end(), [&](std::size_t i) { return seeds[i].face; });
        (faces ? floors : features).push_back(summarise(seeds, judged, of));
    }
    for (ThinFeature& floor : floors) {
        floor.kind = FeatureKind::Wall;
        if (std::none_of(features.begin(), features.end(), [&](const ThinFeature& other) {
                return std::abs(other.size - floor.size) < 0.3 * floor.size;
            }))
            features.push_back(floor);
    }
    std::sort(features.begin(), features.end(),
              [](const ThinFeature& a, const ThinFeature& b) { return a.size < b.size; });
    return features;
}

}  // namespace passung::shape
