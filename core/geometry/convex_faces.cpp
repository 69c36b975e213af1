#include "core/geometry/convex_faces.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "core/base/hash_mix.h"

namespace passung::geometry {

namespace {

constexpr double kSameWay = 0.999;        // cosine of the normals of triangles of one face
constexpr std::size_t kMostCorners = 64;  // of a face: more do not pay
constexpr int kRounds = 8;
constexpr std::uint32_t kNobody = ~0u;
constexpr std::size_t kMostSides = 64;  // from one vertex that are looked through

using Loop = std::vector<std::uint32_t>;

/// Vertices by the cells of a grid that they lie in, the first one of each cell; a hash table with linear probing.
class FirstInCell {
public:
    explicit FirstInCell(std::size_t most) : slots_(std::bit_ceil(2 * most + 1)) {}

    /// The name of the first one that lay there: `name`, if this is it.
    std::uint32_t of(const Vec3& p, std::uint32_t name) {
        Slot here{{}, name};
        for (std::size_t i = 0; i < 3; ++i) here.cell[i] = std::llround(p[static_cast<Eigen::Index>(i)] / kWelded);
        std::size_t at = hash(here.cell) & (slots_.size() - 1);
        while (slots_[at].name != kNobody && slots_[at].cell != here.cell) at = (at + 1) & (slots_.size() - 1);
        if (slots_[at].name == kNobody) slots_[at] = here;
        return slots_[at].name;
    }

private:
    using Cell = std::array<std::int64_t, 3>;
    struct Slot {
        Cell cell{};
        std::uint32_t name = kNobody;
    };

    static std::size_t hash(const Cell& cell) {
        std::uint64_t h = 0;
        for (const std::int64_t c : cell) h = hashMix(h, static_cast<std::uint64_t>(c));
        return static_cast<std::size_t>(h);
    }

    std::vector<Slot> slots_;
};

/// The vertices that are not the same place, and which one each of the mesh's is.
std::vector<std::uint32_t> weld(const TriangleMesh& mesh, std::vector<Vec3>& vertices) {
    FirstInCell first(mesh.vertices.size());
    std::vector<std::uint32_t> which;
    which.reserve(mesh.vertices.size());
    for (const Vec3& v : mesh.vertices) {
        const auto next = static_cast<std::uint32_t>(vertices.size());
        which.push_back(first.of(v, next));
        if (which.back() == next) vertices.push_back(v);
    }
    return which;
}

struct Growing {
    Loop loop;
    Vec3 normal, origin;  // of its first triangle
    std::uint32_t triangle = 0;
    bool gone = false;
};

/// Which face has a side last, of all that run from one vertex to another. Those from a vertex lie beside each other,
/// but for the hub of a large fan.
class SideOwners {
public:
    SideOwners(const std::vector<Growing>& faces, std::size_t vertices) : begin_(vertices + 1, 0) {
        for (const Growing& face : faces)
            if (!face.gone)
                for (const std::uint32_t from : face.loop) ++begin_[from + 1];
        for (std::size_t& sides : begin_)
            if (sides > kMostSides) sides = 0;
        std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
        sides_.resize(begin_.back());
        for (std::uint32_t f = 0; f < faces.size(); ++f)
            if (!faces[f].gone) note(faces[f].loop, f);
    }

    void note(const Loop& loop, std::uint32_t face) {
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const std::uint32_t from = loop[i], to = loop[(i + 1) % loop.size()];
            if (Side* side = placeOf(from, to))
                *side = {to, face};
            else
                others_[std::uint64_t{from} << 32 | to] = face;
        }
    }

    /// kNobody: none.
    std::uint32_t of(std::uint32_t from, std::uint32_t to) {
        const Side* side = placeOf(from, to);
        if (side != nullptr && side->face != kNobody) return side->face;
        const auto found = others_.find(std::uint64_t{from} << 32 | to);
        return found == others_.end() ? kNobody : found->second;
    }

private:
    struct Side {
        std::uint32_t to = 0, face = kNobody;
    };

    /// Where the side is, or a free place for it among those from its first vertex.
    Side* placeOf(std::uint32_t from, std::uint32_t to) {
        for (std::size_t i = begin_[from]; i < begin_[from + 1]; ++i)
            if (sides_[i].face == kNobody || sides_[i].to == to) return &sides_[i];
        return nullptr;
    }

    std::vector<std::size_t> begin_;  // of the sides from a vertex
    std::vector<Side> sides_;
    std::unordered_map<std::uint64_t, std::uint32_t> others_;  // for which there is no place
};

class Merger {
public:
    explicit Merger(const TriangleMesh& mesh) {
        const std::vector<std::uint32_t> which = weld(mesh, result_.vertices);
        faces_.reserve(mesh.triangles.size());
        for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
            const auto& t = mesh.triangles[i];
            Growing face;
            for (const std::uint32_t corner : t)
                if (std::find(face.loop.begin(), face.loop.end(), which[corner]) == face.loop.end())
                    face.loop.push_back(which[corner]);
            face.triangle = i;
            if (face.loop.size() == 3) {
                face.origin = at(face.loop[0]);
                const Vec3 across = (at(face.loop[1]) - face.origin).cross(at(face.loop[2]) - face.origin);
                const double longest = std::max((at(face.loop[1]) - face.origin).squaredNorm(),
                                                (at(face.loop[2]) - face.origin).squaredNorm());
                if (across.norm() > 1e-4 * longest)
                    face.normal = across.normalized();
                else
                    face.normal.setZero();
            } else {
                face.normal.setZero();
            }
            faces_.push_back(std::move(face));
        }
    }

    ConvexFaces merge() {
        for (int round = 0; round < kRounds; ++round)
            if (!mergeOnce()) break;
        for (Growing& face : faces_)
            if (!face.gone) result_.faces.push_back({std::move(face.loop), face.triangle});
        return std::move(result_);
    }

private:
    const Vec3& at(std::uint32_t vertex) const { return result_.vertices[vertex]; }

    /// Each face takes up those beside it as long as it stays convex.
    bool mergeOnce() {
        SideOwners owners(faces_, result_.vertices.size());
        bool merged = false;
        for (std::uint32_t f = 0; f < faces_.size(); ++f) {
            if (faces_[f].gone || faces_[f].normal.isZero()) continue;
            for (std::size_t i = 0; i < faces_[f].loop.size();) {
                const bool taken = tryTake(owners, f, i);
                merged = merged || taken;
                i = taken ? 0 : i + 1;
            }
        }
        return merged;
    }

    /// Takes up the face on the other side of side `i` of face `f`.
    bool tryTake(SideOwners& owners, std::uint32_t f, std::size_t i) {
        Growing& face = faces_[f];
        const std::uint32_t from = face.loop[i], to = face.loop[(i + 1) % face.loop.size()];
        const std::uint32_t across = owners.of(to, from);
        if (across == kNobody || across == f) return false;
        Growing& other = faces_[across];
        if (other.gone || other.normal.dot(face.normal) < kSameWay) return false;
        const auto start = std::find(other.loop.begin(), other.loop.end(), from);
        if (start == other.loop.end()) return false;
        const auto at_from = static_cast<std::size_t>(start - other.loop.begin());
        const std::size_t n = other.loop.size();
        if (other.loop[(at_from + n - 1) % n] != to) return false;  // it has taken others up since
        for (const std::uint32_t v : other.loop)
            if (!(std::abs(face.normal.dot(at(v) - face.origin)) <= kFlatFace)) return false;
        Loop joined;
        for (std::size_t k = 0; k < face.loop.size(); ++k) {
            joined.push_back(face.loop[(i + 1 + k) % face.loop.size()]);
        }
        for (std::size_t k = 1; k + 1 < n; ++k) joined.push_back(other.loop[(at_from + k) % n]);
        dropStraight(joined);
        if (joined.size() > kMostCorners || !isConvex(joined, face.normal)) return false;
        face.loop = std::move(joined);
        other.gone = true;
        owners.note(face.loop, f);
        return true;
    }

    /// Forgets corners on the line between their neighbours.
    void dropStraight(Loop& loop) const {
        for (std::size_t i = 0; i < loop.size() && loop.size() > 3;) {
            const Vec3 &a = at(loop[(i + loop.size() - 1) % loop.size()]), &b = at(loop[i]),
                       &c = at(loop[(i + 1) % loop.size()]);
            const Vec3 way = c - a;
            const double along = (b - a).dot(way);
            const bool straight = along > 0.0 && along < way.squaredNorm() &&
                                  (b - a).cross(way).squaredNorm() <= 1e-22 * way.squaredNorm();
            if (straight)
                loop.erase(loop.begin() + static_cast<std::ptrdiff_t>(i));
            else
                ++i;
        }
    }

    bool isConvex(const Loop& loop, const Vec3& normal) const {
        const std::size_t n = loop.size();
        double turned = 0.0;
        for (std::size_t i = 0; i < n; ++i) {
            const Vec3 u = at(loop[(i + 1) % n]) - at(loop[i]), v = at(loop[(i + 2) % n]) - at(loop[(i + 1) % n]);
            const double turn = std::atan2(u.cross(v).dot(normal), u.dot(v));
            if (turn < -1e-9) return false;
            turned += turn;
        }
        return turned < 7.0;  // once around
    }

    ConvexFaces result_;
    std::vector<Growing> faces_;
};

}  // namespace

ConvexFaces mergeFlatTriangles(const TriangleMesh& mesh) { return Merger(mesh).merge(); }

}  // namespace passung::geometry
