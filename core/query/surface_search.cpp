#include "core/query/surface_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>

namespace passung::query {

namespace {

using model::TriangleCorners;

constexpr int kQuarterings = 2;    // of a triangle that the field may show to be far
constexpr int kMostPerRound = 25;  // steps: the most for a triangle, 1 + 4 + 16 by the field, 4 exact ones
constexpr double kLooseShare =
    0.5;  // of a sphere's radius: what the field may leave open before exact distances are asked
constexpr double kArithmetic = 1e-12;  // rounding of what is computed here, per metre of the numbers it comes from

Vec3 middleOf(const TriangleCorners& t) { return (t[0] + t[1] + t[2]) / 3.0; }

/// The farthest corner from `p` [m].
double reachFrom(const Vec3& p, const TriangleCorners& t) {
    return std::sqrt(std::max({(t[0] - p).squaredNorm(), (t[1] - p).squaredNorm(), (t[2] - p).squaredNorm()}));
}

/// The farthest corner of `piece` from the triangle `t`: no point of the piece is farther.
double farthestFrom(const TriangleCorners& t, const TriangleCorners& piece) {
    double farthest = 0.0;
    for (const Vec3& corner : piece)
        farthest = std::max(farthest, (model::closestOnTriangle(corner, t[0], t[1], t[2]) - corner).norm());
    return farthest;
}

}  // namespace

SurfaceSearch::SurfaceSearch(const model::Part& a, const model::Part& b) : a_(a), b_(b), triangles_(a.mesh) {
    buildNodes();
}

struct SurfaceSearch::Range {
    std::uint32_t node, begin, end;
};

void SurfaceSearch::buildNodes() {
    const auto& mesh = b_.mesh;
    std::vector<Vec3> middles;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto& t = mesh.triangles[i];
        middles.push_back((mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3.0);
        order_.push_back(i);
    }
    nodes_.resize(1);
    std::vector<Range> tasks{{0, 0, static_cast<std::uint32_t>(order_.size())}};
    while (!tasks.empty()) {
        const Range range = tasks.back();
        tasks.pop_back();
        model::Bounds corners, centres;
        for (std::uint32_t i = range.begin; i < range.end; ++i) {
            centres.extend(middles[order_[i]]);
            for (const std::uint32_t v : mesh.triangles[order_[i]]) corners.extend(mesh.vertices[v]);
        }
        Node node{0.5 * (corners.low + corners.high), 0.0, range.begin, range.end - range.begin};
        for (std::uint32_t i = range.begin; i < range.end; ++i)
            for (const std::uint32_t v : mesh.triangles[order_[i]])
                node.radius = std::max(node.radius, (mesh.vertices[v] - node.centre).norm());
        if (node.count > 1) {
            int axis = 0;
            centres.size().maxCoeff(&axis);
            const std::uint32_t middle = range.begin + node.count / 2;
            std::nth_element(order_.begin() + range.begin, order_.begin() + middle, order_.begin() + range.end,
                             [&](std::uint32_t i, std::uint32_t j) {
                                 return std::pair(middles[i][axis], i) < std::pair(middles[j][axis], j);
                             });
            node.first = static_cast<std::uint32_t>(nodes_.size());
            node.count = 0;
            nodes_.resize(nodes_.size() + 2);
            tasks.push_back({node.first, range.begin, middle});
            tasks.push_back({node.first + 1, middle, range.end});
        }
        nodes_[range.node] = node;
    }
}

/// One search; A's frame.
struct SurfaceSearch::Search {
    /// A node of B's tree, or a piece of a triangle.
    struct Item {
        double lower;  // of φ_A on it [m]
        std::uint32_t node;
        bool piece;
        TriangleCorners corners;
    };
    struct Later {
        bool operator()(const Item& a, const Item& b) const { return a.lower > b.lower; }
    };

    const SurfaceSearch& of;
    const Mat3 R_AB;
    const Vec3 p_AB;
    const double rounding;  // of what is computed here [m]
    const double slack;     // of the field's bounds [m]
    const double offset;
    SurfaceBounds found;
    std::priority_queue<Item, std::vector<Item>, Later> waiting;

    Search(const SurfaceSearch& search, const Pose& X_AB)
        : of(search),
          R_AB(X_AB.q.toRotationMatrix()),
          p_AB(X_AB.p),
          rounding(kArithmetic * (1.0 + X_AB.p.norm())),
          slack(search.a_.chord_error + rounding),
          offset(search.a_.field->sheetOffset()) {
        found.upper = std::numeric_limits<double>::infinity();
    }

    bool canBeInside() const { return offset == 0.0; }
    double fieldBound(const Vec3& p) const { return of.a_.field->lowerBound(p) + offset - slack; }

    bool isInside(const Vec3& p) const {
        if (!canBeInside()) return false;
        const double phi = of.a_.field->sample(p, model::FieldMode::Trilinear).phi;
        const double error = of.a_.field->errorBound(p, model::FieldMode::Trilinear) + slack;
        return phi + error < 0.0 || (phi - error <= 0.0 && of.triangles_.inside(p));
    }

    void offer(double phi, const Vec3& p, const Vec3& on_a) {
        if (!(phi < found.upper)) return;
        found.upper = phi;
        found.point = p;
        const Vec3 out = phi < 0.0 ? on_a - p : p - on_a;
        const double length = out.norm();
        found.normal = length > 0.0 ? Vec3(out / length) : Vec3(Vec3::Zero());
    }

    /// A point of B that is known to be as near to A's surface as this.
    void offerPair(const model::TrianglePair& pair, bool whole) {
        if (!whole || !isInside(pair.on_first)) offer(pair.distance, pair.on_first, pair.on_second);
    }

    /// φ_A at `p`, exactly; the triangle of A next to it.
    TriangleCorners look(const Vec3& p) {
        const model::ClosestPoint near = of.triangles_.closest(p);
        ++found.steps;
        // Only what would be deeper, or nearer, than what is known needs a sign.
        if (-near.distance < found.upper) {
            const double phi = isInside(p) ? -near.distance : near.distance;
            offer(phi, p, near.point);
        }
        return of.triangles_.cornersOf(near);
    }

    void push(std::uint32_t node) {
        const Node& n = of.nodes_[node];
        const Vec3 c = R_AB * n.centre + p_AB;
        const double bound = fieldBound(c);
        double lower = bound - n.radius;
        ++found.steps;
        if (lower >= found.upper) return;
        // Far away and deep inside the field says little.
        const double read = of.a_.field->sample(c, model::FieldMode::Trilinear).phi + offset;
        if (read - bound > kLooseShare * n.radius) {
            const double d = of.triangles_.closest(c).distance;
            ++found.steps;
            lower = std::max(lower, (isInside(c) ? -d : d) - n.radius - rounding);
        }
        if (lower < found.upper) waiting.push({lower, node, false, {}});
    }

    /// A piece of a triangle that is not known to be outside.
    void pushPiece(const TriangleCorners& piece, double above) {
        const TriangleCorners near = look(middleOf(piece));
        double depth = farthestFrom(near, piece);
        if (-depth < found.upper) {
            std::size_t deepest = 0;
            double most = -1.0;
            for (std::size_t i = 0; i < 3; ++i) {
                const double d = (model::closestOnTriangle(piece[i], near[0], near[1], near[2]) - piece[i]).norm();
                if (d > most) {
                    most = d;
                    deepest = i;
                }
            }
            depth = std::min(depth, farthestFrom(look(piece[deepest]), piece));
        }
        const double lower = std::max(above, -depth - rounding);
        if (lower < found.upper) waiting.push({lower, 0, true, piece});
    }

    /// True if the field proves that no point of a piece is nearer than what is known.
    bool isFar(const TriangleCorners& piece, int quarterings) {
        const Vec3 c = middleOf(piece);
        ++found.steps;
        const double bound = fieldBound(c);
        if (bound - reachFrom(c, piece) >= found.upper) return true;
        // The piece in the middle keeps the centre, however often it is quartered.
        if (quarterings == 0 || bound - std::ldexp(reachFrom(c, piece), -quarterings) < found.upper) return false;
        for (const TriangleCorners& part : quarters(piece))
            if (!isFar(part, quarterings - 1)) return false;
        return true;
    }

    static std::array<TriangleCorners, 4> quarters(const TriangleCorners& t) {
        const Vec3 ab = 0.5 * (t[0] + t[1]), bc = 0.5 * (t[1] + t[2]), ca = 0.5 * (t[2] + t[0]);
        return {{{t[0], ab, ca}, {ab, t[1], bc}, {ca, bc, t[2]}, {ab, bc, ca}}};
    }

    void lookAtTriangle(std::uint32_t index, double above) {
        const auto& v = of.b_.mesh.triangles[index];
        const auto& vertices = of.b_.mesh.vertices;
        const TriangleCorners t{Vec3(R_AB * vertices[v[0]] + p_AB), Vec3(R_AB * vertices[v[1]] + p_AB),
                                Vec3(R_AB * vertices[v[2]] + p_AB)};
        if (found.upper > 0.0 && isFar(t, kQuarterings)) return;
        // Where something is inside, what is outside matters no more: only whether this triangle is.
        const double limit = found.upper > 0.0 ? found.upper : 2.0 * rounding;
        const model::TrianglePair pair = of.triangles_.closestTo(t, limit);
        ++found.steps;
        const bool whole = pair.distance > rounding;  // on one side
        if (pair.distance < limit) offerPair(pair, whole);
        if (!canBeInside() || (whole && !isInside(middleOf(t)))) return;
        pushPiece(t, above);
    }

    void run(double tolerance, int most_steps) {
        push(0);
        while (!waiting.empty() && found.steps + kMostPerRound <= most_steps) {
            const Item item = waiting.top();
            if (item.lower >= found.upper - tolerance) break;
            waiting.pop();
            if (item.piece) {
                for (const TriangleCorners& part : quarters(item.corners)) pushPiece(part, item.lower);
                continue;
            }
            const Node& node = of.nodes_[item.node];
            if (node.count > 0) {
                lookAtTriangle(of.order_[node.first], item.lower);
            } else {
                push(node.first);
                push(node.first + 1);
            }
        }
        found.lower = found.upper;
        if (!waiting.empty()) found.lower = std::min(found.lower, waiting.top().lower);
        found.lower -= rounding;
    }
};

SurfaceBounds SurfaceSearch::bounds(const Pose& X_AB, const Vec3& p_BP, double rounding, double tolerance,
                                    int most_steps) const {
    Search search(*this, X_AB);
    search.look(X_AB * p_BP);
    search.found.upper += rounding;
    search.run(tolerance, most_steps);
    return search.found;
}

}  // namespace passung::query
