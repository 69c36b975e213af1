#include "analysis/truth/exact_overlap.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <queue>

#include "analysis/truth/grown_shape.h"
#include "analysis/truth/shape_outside.h"

namespace passung::truth {
namespace {

constexpr double kAside = 1e-9;      // [m] outside a plane: what lies there does not count as in the solid
constexpr double kSlender = 1000.0;  // times as long as wide: is cut across
constexpr double kUnknown = std::numeric_limits<double>::infinity();

double radiusOf(std::span<const Vec3> corners, const Vec3& middle) {
    double squared = 0.0;
    for (const Vec3& corner : corners) squared = std::max(squared, (corner - middle).squaredNorm());
    return std::sqrt(squared);
}

/// A convex piece of a triangle.
struct Polygon {
    std::array<Vec3, 8> corners;
    std::size_t count = 0;
    std::uint8_t fresh = 0;  // bits: corners that the whole it is a half of had not

    std::span<const Vec3> span() const { return std::span(corners).first(count); }
    void add(const Vec3& p) { corners[count++] = p; }
    void addFresh(const Vec3& p) {
        fresh |= static_cast<std::uint8_t>(1u << count);
        add(p);
    }
    bool isFresh(std::size_t corner) const { return (fresh >> corner & 1u) != 0; }
    Vec3 middle() const {
        Vec3 sum = Vec3::Zero();
        for (const Vec3& corner : span()) sum += corner;
        return sum / static_cast<double>(count);
    }
};

Polygon polygonOf(const Corners& t) {
    Polygon polygon;
    for (const Vec3& corner : t) polygon.addFresh(corner);
    return polygon;
}

/// In half across its greatest length, so that the pieces of a sliver get shorter and not thinner; one with as many
/// corners as there is room for from corner to corner.
std::array<Polygon, 2> halves(const Polygon& whole) {
    std::array<Polygon, 2> parts;
    const std::size_t n = whole.count;
    if (n == whole.corners.size()) {
        for (std::size_t i = 0; i <= n / 2; ++i) parts[0].add(whole.corners[i]);
        for (std::size_t i = n / 2; i <= n; ++i) parts[1].add(whole.corners[i % n]);
        return parts;
    }
    double most = -1.0;
    Vec3 way, middle;
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t k = i + 1; k < n; ++k)
            if (const Vec3 d = whole.corners[k] - whole.corners[i]; d.squaredNorm() > most) {
                most = d.squaredNorm();
                way = d;
                middle = 0.5 * (whole.corners[k] + whole.corners[i]);
            }
    for (std::size_t i = 0; i < n; ++i) {
        const Vec3 &a = whole.corners[i], &b = whole.corners[(i + 1) % n];
        const double at_a = way.dot(a - middle), at_b = way.dot(b - middle);
        parts[at_a < 0.0 ? 0 : 1].add(a);
        if ((at_a < 0.0) == (at_b < 0.0)) continue;
        const Vec3 between = a + at_a / (at_a - at_b) * (b - a);
        for (Polygon& part : parts) part.addFresh(between);
    }
    return parts;
}

/// A branch of a surface's tree, a flat piece in the frame of the solid, or a turned one.
struct Piece {
    enum class Kind : std::uint8_t { Node, Flat, Turned };
    double bound;      // no point of it is deeper [m]
    std::uint32_t at;  // node of the tree, or place among those that wait
    bool b_in_a;       // whose surface
    Kind kind;
};

/// Pieces that wait. What one leaves the next takes.
template <class Kept>
class Waiting {
public:
    std::uint32_t keep(const Kept& piece) {
        if (free_.empty()) {
            kept_.push_back(piece);
            return static_cast<std::uint32_t>(kept_.size() - 1);
        }
        const std::uint32_t at = free_.back();
        free_.pop_back();
        kept_[at] = piece;
        return at;
    }
    Kept take(std::uint32_t at) {
        free_.push_back(at);
        return kept_[at];
    }

private:
    std::vector<Kept> kept_;
    std::vector<std::uint32_t> free_;
};

/// Which surface is looked for in which solid.
struct Direction {
    const OverlapBody* solid;
    const OverlapBody* surface;
    Pose X_SolidSurface, X_WSolid;
    Mat3 R_SolidSurface = X_SolidSurface.q.toRotationMatrix();  // for many points faster than the quaternion
    AxialView seen{X_SolidSurface};

    Vec3 inSolid(const Vec3& p_Surface) const { return R_SolidSurface * p_Surface + X_SolidSurface.p; }
    /// The corners of a box (TriangleBoxes::Node::hull).
    std::array<Vec3, 8> boxInSolid(const std::array<Vec3, 8>& box) const {
        std::array<Vec3, 8> corners;
        corners[0] = inSolid(box[0]);
        for (const std::size_t axis : {1u, 2u, 4u}) {
            const Vec3 edge = R_SolidSurface * (box[axis] - box[0]);
            for (std::size_t k = 0; k < axis; ++k) corners[k + axis] = corners[k] + edge;
        }
        return corners;
    }
};

class Search {
public:
    Search(std::span<const Direction> directions, const OverlapEffort& search)
        : directions_(directions), search_(search) {}

    /// Of the surfaces of all directions.
    Overlap run() {
        for (std::size_t i = 0; i < directions_.size(); ++i)
            if (directions_[i].solid->hasInside()) addSurface(i == 1);
        return finish();
    }
    /// Of one piece of the first direction's surface.
    Overlap runOver(const TurnedPiece& piece) {
        addTurned(false, judged(of(false), piece));
        return finish();
    }

private:
    Overlap finish() {
        while (!waiting_.empty() && waiting_.top().bound > (1.0 + search_.share) * found_.depth + search_.tolerance &&
               found_.pieces < search_.most_pieces) {
            const Piece piece = waiting_.top();
            waiting_.pop();
            expand(piece);
        }
        found_.bound = std::max({found_.depth, left_out_, waiting_.empty() ? 0.0 : waiting_.top().bound});
        return found_;
    }

    const Direction& of(bool b_in_a) const { return directions_[b_in_a ? 1 : 0]; }

    /// The exact faces of a shape in a shape; else the triangles.
    void addSurface(bool b_in_a) {
        const Direction& way = of(b_in_a);
        const SurfacePieces& pieces = way.surface->pieces();
        if (!way.solid->isShape() || pieces.empty()) return addNode(b_in_a, 0);
        for (const TurnedPiece& piece : pieces.turned) addTurned(b_in_a, judged(way, piece));
        for (const FlatPiece& piece : pieces.flat) {
            Polygon polygon;
            for (const Vec3& corner : piece) polygon.addFresh(way.inSolid(corner));
            addPolygon(b_in_a, polygon);
        }
    }

    void expand(const Piece& piece) {
        const Direction& way = of(piece.b_in_a);
        if (piece.kind == Piece::Kind::Turned) return expandTurned(piece.b_in_a, turned_.take(piece.at));
        if (piece.kind == Piece::Kind::Flat) {
            for (const Polygon& half : halves(polygons_.take(piece.at))) addPolygon(piece.b_in_a, half);
            return;
        }
        const TriangleBoxes::Node& node = way.surface->surface().nodes()[piece.at];
        if (node.right != 0) {
            addNode(piece.b_in_a, piece.at + 1);
            addNode(piece.b_in_a, node.right);
            return;
        }
        for (std::uint32_t i = node.first; i < node.end; ++i) {
            const Corners& t = way.surface->surface().triangles()[i];
            const Corners placed{way.inSolid(t[0]), way.inSolid(t[1]), way.inSolid(t[2])};
            addPolygon(piece.b_in_a, polygonOf(placed));
        }
    }

    void addNode(bool b_in_a, std::uint32_t index) {
        const Direction& way = of(b_in_a);
        const std::array<Vec3, 8> corners = way.boxInSolid(way.surface->surface().nodes()[index].hull);
        const Vec3 middle = 0.5 * (corners.front() + corners.back());
        ++found_.pieces;
        const double at_once = way.solid->deepestAtOnce(corners, middle);
        if (!isOpen(at_once)) return;
        const double phi = way.solid->signedDistance(middle), radius = radiusOf(corners, middle);
        if (phi >= radius) return;
        const double bound = std::min(at_once, way.solid->deepestOver(corners, middle, phi));
        const double enough = std::max(found_.depth, search_.ignore);
        if (bound > enough && isShallow(way, index, middle, enough))
            left_out_ = std::max(left_out_, search_.ignore);
        else if (isOpen(bound))
            waiting_.push({bound, index, b_in_a, Piece::Kind::Node});
    }

    /// Does the hull of the vertices themselves, tighter than any box, prove it?
    bool isShallow(const Direction& way, std::uint32_t index, const Vec3& middle, double enough) {
        const TriangleBoxes& surface = way.surface->surface();
        placed_.clear();
        for (const Vec3& p : surface.vertices(surface.nodes()[index])) placed_.push_back(way.inSolid(p));
        return !placed_.empty() && way.solid->isShallow(placed_, middle, enough);
    }

    /// A point of the surface that is looked for in a solid.
    void note(const Direction& way, const Vec3& p, double phi) {
        if (!(-phi > found_.depth)) return;
        found_.depth = -phi;
        found_.point = way.X_WSolid * p;
    }

    void addPolygon(bool b_in_a, const Polygon& piece) {
        const Direction& way = of(b_in_a);
        const Vec3 middle = piece.middle();
        ++found_.pieces;
        const double at_once = way.solid->deepestAtOnce(piece.span(), middle);
        if (!isOpen(at_once)) return;
        const double phi = way.solid->signedDistance(middle);
        note(way, middle, phi);
        if (phi >= radiusOf(piece.span(), middle)) return;
        const double bound = std::min(at_once, way.solid->deepestOverPiece(piece.span(), middle, phi));
        if (way.solid->isOutside(piece.span(), phi) || !isOpen(bound)) return;
        waiting_.push({bound, polygons_.keep(piece), b_in_a, Piece::Kind::Flat});
        for (std::size_t i = 0; i < piece.count; ++i)
            if (piece.isFresh(i)) note(way, piece.corners[i], way.solid->signedDistance(piece.corners[i]));
    }

    struct Judged {
        TurnedPiece piece;
        double bound;
    };

    Judged judged(const Direction& way, const TurnedPiece& piece) {
        ++found_.pieces;
        const double bound = way.solid->deepestOver(way.seen.extentOf(piece));
        if (!(bound > std::max(found_.depth, search_.ignore)) || !piece.hasHull()) return {piece, bound};
        std::array<Vec3, 8> corners = piece.corners();
        for (Vec3& corner : corners) corner = way.inSolid(corner);
        return {piece, std::min(bound, way.solid->deepestAtOnce(corners, way.inSolid(piece.middle())))};
    }

    /// In two by whichever cut leaves less to be looked at: a long piece along a bore may well stay long.
    void expandTurned(bool b_in_a, const TurnedPiece& piece) {
        const Direction& way = of(b_in_a);
        const auto bothOf = [&](const std::array<TurnedPiece, 2>& halves) {
            return std::array{judged(way, halves[0]), judged(way, halves[1])};
        };
        const double around = piece.lengthAround(), along = piece.lengthAlong();
        std::array<Judged, 2> both = bothOf(around > along ? piece.halvesAround() : piece.halvesAlong());
        if (std::min(around, along) * kSlender > std::max(around, along)) {
            const auto others = bothOf(around > along ? piece.halvesAlong() : piece.halvesAround());
            if (leftToSee(others) < leftToSee(both)) both = others;
        }
        for (const Judged& half : both) addTurned(b_in_a, half);
    }
    double leftToSee(const std::array<Judged, 2>& both) const {
        const double enough = std::max(found_.depth, search_.ignore);
        double left = 0.0;
        for (const Judged& half : both) left += std::max(0.0, half.bound - enough);
        return left;
    }

    void addTurned(bool b_in_a, const Judged& judged) {
        const Direction& way = of(b_in_a);
        if (!isOpen(judged.bound)) return;
        const Vec3 middle = way.inSolid(judged.piece.middle());
        const double phi = way.solid->signedDistance(middle);
        note(way, middle, phi);
        const double bound = std::min(judged.bound, judged.piece.radius() - phi);
        if (isOpen(bound)) waiting_.push({bound, turned_.keep(judged.piece), b_in_a, Piece::Kind::Turned});
    }

    /// What is no deeper than what is found, or need not be told, is left out.
    bool isOpen(double bound) {
        if (bound > std::max(found_.depth, search_.ignore)) return true;
        if (bound <= search_.ignore) left_out_ = std::max(left_out_, bound);
        return false;
    }

    struct Later {
        bool operator()(const Piece& a, const Piece& b) const { return a.bound < b.bound; }
    };
    std::span<const Direction> directions_;
    const OverlapEffort& search_;
    Overlap found_;
    double left_out_ = 0.0;
    std::vector<Vec3> placed_;  // vertices of a node in the solid's frame
    std::priority_queue<Piece, std::vector<Piece>, Later> waiting_;
    Waiting<Polygon> polygons_;
    Waiting<TurnedPiece> turned_;
};

struct Meeting {
    const TriangleBoxes& a;
    const TriangleBoxes& b;
    Pose X_BA;

    /// Is there a pair below these nodes?
    bool below(std::uint32_t of_a) const {
        const TriangleBoxes::Node& node = a.nodes()[of_a];
        geometry::Bounds box;
        for (const Vec3& corner : node.hull) box.extend(X_BA * corner);
        if (!(box.low.array() <= b.nodes()[0].box.high.array()).all() ||
            !(b.nodes()[0].box.low.array() <= box.high.array()).all())
            return false;
        if (node.right != 0) return below(of_a + 1) || below(node.right);
        for (std::uint32_t i = node.first; i < node.end; ++i) {
            const Corners& t = a.triangles()[i];
            if (b.isMetBy({X_BA * t[0], X_BA * t[1], X_BA * t[2]})) return true;
        }
        return false;
    }
};

/// The point of a shape's surface that is nearest to `p` outside it, by steps down its distance.
Vec3 footOn(const OverlapBody& body, Vec3 p) {
    constexpr double kStep = 1e-6, kNear = 1e-12;  // [m]
    for (int i = 0; i < 8; ++i) {
        const double phi = body.signedDistance(p);
        if (std::abs(phi) < kNear) break;
        Vec3 slope;
        for (int axis = 0; axis < 3; ++axis) {
            const Vec3 aside = kStep * Vec3::Unit(axis);
            slope[axis] = body.signedDistance(p + aside) - body.signedDistance(p - aside);
        }
        if (!(slope.norm() > 0.0)) break;
        p -= phi * slope.normalized();
    }
    return p;
}

/// overlapOf() of a ring and a solid; nothing where the ring's circle may enter the solid, or the solid is of a kind
/// that is not known to grow.
std::optional<Overlap> overlapOfRing(const OverlapBody& ring, const Pose& X_WRing, const OverlapBody& solid,
                                     const Pose& X_WSolid, const OverlapEffort& search) {
    if (!ring.isShape() || !solid.isShape()) return std::nullopt;
    const auto* torus = std::get_if<shape::Torus>(&ring.shape());
    const double tube = torus != nullptr ? 0.5 * torus->tube_diameter : 0.0;
    const auto around = torus != nullptr ? grown(solid.shape(), tube) : std::nullopt;
    if (!around) return std::nullopt;
    const OverlapBody near(solid.shape(), *around, tube);
    const Pose X_WNear = X_WSolid * Pose{Quat::Identity(), Vec3(0.0, 0.0, -around->lift)};
    const TurnedPiece::Circle circle{0.5 * torus->diameter, 0.0};
    const std::array way{Direction{&near, &ring, X_WNear.inverse() * X_WRing, X_WNear}};
    Overlap found = Search(way, search).runOver({{}, circle, circle});
    if (!(found.bound < tube)) return std::nullopt;
    if (!(found.depth > 0.0)) return found;
    const Vec3 foot = X_WSolid * footOn(solid, X_WSolid.inverse() * found.point);
    // The circle may pass nearer to the foot than where the search stopped. Where the way down is not unique the
    // circle's point itself stands for it.
    const double depth = -ring.signedDistance(X_WRing.inverse() * foot);
    if (depth < found.depth - 1e-9 || std::abs(solid.signedDistance(X_WSolid.inverse() * foot)) > 1e-9) return found;
    found.depth = depth;
    found.bound = std::max(found.bound, depth);
    found.point = foot;
    return found;
}

}  // namespace

OverlapBody::OverlapBody(const shape::Shape& shape, double chord_error)
    : shape_(std::make_unique<const shape::Shape>(shape)),
      pieces_(SurfacePieces::of(shape)),
      asked_chord_(chord_error),
      chord_error_(shape::chordError(shape, chord_error)) {}

OverlapBody::OverlapBody(const geometry::TriangleMesh& mesh) : surface_(std::make_unique<const TriangleBoxes>(mesh)) {}

OverlapBody::OverlapBody(const shape::Shape& shape, const GrownShape& grown, double by)
    : shape_(std::make_unique<const shape::Shape>(grown.shape)), core_(Core{shape, grown.lift, by}) {}

const TriangleBoxes& OverlapBody::surface() const {
    std::call_once(made_, [this] {
        if (!surface_) surface_ = std::make_unique<const TriangleBoxes>(shape::tessellate(*shape_, asked_chord_));
    });
    return *surface_;
}

bool OverlapBody::hasInside() const { return shape_ == nullptr || !std::holds_alternative<shape::Sheet>(*shape_); }

double OverlapBody::signedDistance(const Vec3& p) const {
    if (core_) return shape::signedDistance(core_->shape, p - Vec3(0.0, 0.0, core_->lift)) - core_->by;
    if (shape_ != nullptr) return shape::signedDistance(*shape_, p);
    const double distance = surface_->nearest(p).distance;
    return surface_->contains(p) ? -distance : distance;
}

double OverlapBody::deepestOver(const AxialExtent& extent) const { return truth::deepestOver(*shape_, extent); }

double OverlapBody::deepestAtOnce(std::span<const Vec3> corners, const Vec3& middle) const {
    return shape_ != nullptr ? truth::deepestOver(*shape_, corners, middle) : kUnknown;
}

/// Of a mesh: the nearest triangle is one convex set outside, the shadow of the hull on its plane another, if nothing
/// of the mesh crosses it. The triangle that is nearest to the middle shows how near the bound gets to the depth.
double OverlapBody::deepestOver(std::span<const Vec3> corners, const Vec3& middle, double phi) const {
    const double lipschitz = radiusOf(corners, middle) - phi;
    if (shape_ != nullptr || !(phi < 0.0)) return lipschitz;
    const Corners& nearest = surface_->triangles()[surface_->nearest(middle).triangle];
    double of_triangle = 0.0;
    for (const Vec3& corner : corners) of_triangle = std::max(of_triangle, distanceToTriangle(corner, nearest));
    return std::min(lipschitz, of_triangle);
}

double OverlapBody::deepestOverPiece(std::span<const Vec3> corners, const Vec3& middle, double phi) const {
    const double bound = deepestOver(corners, middle, phi);
    if (shape_ != nullptr || !(phi < 0.0)) return bound;
    const Corners& nearest = surface_->triangles()[surface_->nearest(middle).triangle];
    const Vec3 n = (nearest[1] - nearest[0]).cross(nearest[2] - nearest[0]).normalized();
    Polygon shadow;
    double of_plane = 0.0;
    for (const Vec3& corner : corners) {
        const double height = n.dot(corner - nearest[0]) - kAside;
        of_plane = std::max(of_plane, std::abs(height));
        shadow.add(corner - height * n);
    }
    const bool open = of_plane < bound && !surface_->contains(shadow.middle()) && !isMetBy(shadow.span());
    return open ? of_plane : bound;
}

bool OverlapBody::isShallow(std::span<const Vec3> corners, const Vec3& middle, double enough) const {
    if (shape_ == nullptr) return false;
    const double just_above = enough + 1e-12;  // [m]
    return truth::deepestOver(*shape_, corners, middle, just_above) < just_above;
}

bool OverlapBody::isMetBy(std::span<const Vec3> piece) const {
    for (std::size_t i = 2; i < piece.size(); ++i)
        if (surface_->isMetBy({piece[0], piece[i - 1], piece[i]})) return true;
    return false;
}

bool OverlapBody::isOutside(std::span<const Vec3> piece, double phi) const {
    return shape_ == nullptr && phi >= 0.0 && !isMetBy(piece);
}

Overlap overlapOf(const OverlapBody& a, const Pose& X_WA, const OverlapBody& b, const Pose& X_WB,
                  const OverlapEffort& search) {
    if (const auto found = overlapOfRing(a, X_WA, b, X_WB, search)) return *found;
    if (const auto found = overlapOfRing(b, X_WB, a, X_WA, search)) return *found;
    const Pose X_AB = X_WA.inverse() * X_WB;
    const std::array ways{Direction{&b, &a, X_AB.inverse(), X_WB}, Direction{&a, &b, X_AB, X_WA}};
    return Search(ways, search).run();
}

bool surfacesMeet(const OverlapBody& a, const Pose& X_WA, const OverlapBody& b, const Pose& X_WB) {
    return Meeting{a.surface(), b.surface(), X_WB.inverse() * X_WA}.below(0);
}

const OverlapBodies::Boxed& OverlapBodies::of(const scene::Part& part) {
    std::string key = part.shape ? shape::kindName(*part.shape) : std::to_string(geometry::contentHash(part.mesh));
    if (part.shape)
        for (const double value : shape::dimensions(*part.shape))
            key += " " + std::to_string(std::bit_cast<std::uint64_t>(value));
    Boxed& boxed = bodies_[key];
    if (boxed.body) return boxed;
    boxed.body = part.shape ? std::make_shared<const OverlapBody>(*part.shape, chord_error_)
                            : std::make_shared<const OverlapBody>(part.mesh);
    boxed.box = geometry::boundsOf(part.mesh);
    boxed.box.low.array() -= part.chord_error;
    boxed.box.high.array() += part.chord_error;
    return boxed;
}

SceneOverlap::SceneOverlap(const scene::Scene& scene, OverlapBodies& bodies) : held_(scene.held) {
    for (std::size_t i = 0; i < scene.parts.size(); ++i)
        parts_.push_back({bodies.of(*scene.parts[i]), scene.spec.parts[i].X_WP});
}

bool SceneOverlap::areApart(const Part& a, const Pose& X_WA, const Part& b, const Pose& X_WB) {
    const auto beyond = [](const Part& ball, const Pose& X_WBall, const Part& box, const Pose& X_WBox) {
        const Vec3 centre = X_WBox.inverse() * (X_WBall * Vec3(0.5 * (ball.box.low + ball.box.high)));
        const Vec3 out = (box.box.low - centre).cwiseMax(centre - box.box.high).cwiseMax(0.0);
        return out.norm() > 0.5 * (ball.box.high - ball.box.low).norm();
    };
    return beyond(a, X_WA, b, X_WB) || beyond(b, X_WB, a, X_WA);
}

void SceneOverlap::add(const Part& a, const Pose& X_WA, const Part& b, const OverlapEffort& search, Overlap& deepest) {
    if (areApart(a, X_WA, b, b.X_W)) return;
    OverlapEffort deeper = search;
    deeper.ignore = std::max(search.ignore, deepest.depth);
    const Overlap found = overlapOf(*a.body, X_WA, *b.body, b.X_W, deeper);
    if (found.depth > deepest.depth) {
        deepest.depth = found.depth;
        deepest.point = found.point;
    }
    deepest.bound = std::max(deepest.bound, found.bound);
    deepest.pieces += found.pieces;
}

Overlap SceneOverlap::at(const Pose& X_WG, const OverlapEffort& search) const {
    Overlap deepest;
    for (std::size_t i = 0; i < parts_.size(); ++i)
        if (i != held_) add(parts_[held_], X_WG, parts_[i], search, deepest);
    return deepest;
}

Overlap SceneOverlap::of(std::span<const std::size_t> held, const OverlapEffort& search) const {
    Overlap deepest;
    for (std::size_t k = 0; k < held.size(); ++k) {
        const auto before = held.first(k);
        for (std::size_t i = 0; i < parts_.size(); ++i)
            if (i != held[k] && std::find(before.begin(), before.end(), i) == before.end())
                add(parts_[held[k]], parts_[held[k]].X_W, parts_[i], search, deepest);
    }
    return deepest;
}

bool SceneOverlap::surfacesMeet(const Pose& X_WG) const {
    for (std::size_t i = 0; i < parts_.size(); ++i)
        if (i != held_ && truth::surfacesMeet(*parts_[held_].body, X_WG, *parts_[i].body, parts_[i].X_W)) return true;
    return false;
}

}  // namespace passung::truth
