#include "core/geometry/convex_faces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <unordered_map>
#include <utility>

namespace passung::geometry {

namespace {

constexpr double kSameWay = 0.999;        // cosine of the normals of triangles of one face
constexpr std::size_t kMostCorners = 64;  // of a face: more do not pay
constexpr int kRounds = 8;

using Loop = std::vector<std::uint32_t>;

struct CellHash {
    std::size_t operator()(const std::array<std::int64_t, 3>& cell) const {
        std::uint64_t h = 0xcbf29ce484222325u;
        for (const std::int64_t c : cell) h = (h ^ static_cast<std::uint64_t>(c)) * 0x100000001b3u;
        return static_cast<std::size_t>(h ^ h >> 29);
    }
};

/// The vertices that are not the same place, and which one each of the mesh's is.
std::vector<std::uint32_t> weld(const TriangleMesh& mesh, std::vector<Vec3>& vertices) {
    std::unordered_map<std::array<std::int64_t, 3>, std::uint32_t, CellHash> cells;
    std::vector<std::uint32_t> which;
    for (const Vec3& v : mesh.vertices) {
        std::array<std::int64_t, 3> cell;
        for (std::size_t i = 0; i < 3; ++i) cell[i] = std::llround(v[static_cast<Eigen::Index>(i)] / kWelded);
        const auto [at, added] = cells.try_emplace(cell, static_cast<std::uint32_t>(vertices.size()));
        if (added) vertices.push_back(v);
        which.push_back(at->second);
    }
    return which;
}

std::uint64_t sideOf(std::uint32_t from, std::uint32_t to) { return std::uint64_t{from} << 32 | to; }

struct Growing {
    Loop loop;
    Vec3 normal, origin;  // of its first triangle
    std::uint32_t triangle = 0;
    bool gone = false;
};

class Merger {
public:
    explicit Merger(const TriangleMesh& mesh) {
        const std::vector<std::uint32_t> which = weld(mesh, result_.vertices);
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
        owners_.clear();
        for (std::uint32_t f = 0; f < faces_.size(); ++f)
            if (!faces_[f].gone) note(f);
        bool merged = false;
        for (std::uint32_t f = 0; f < faces_.size(); ++f) {
            if (faces_[f].gone || faces_[f].normal.isZero()) continue;
            for (std::size_t i = 0; i < faces_[f].loop.size();) {
                const bool taken = tryTake(f, i);
                merged = merged || taken;
                i = taken ? 0 : i + 1;
            }
        }
        return merged;
    }

    void note(std::uint32_t f) {
        const Loop& loop = faces_[f].loop;
        for (std::size_t i = 0; i < loop.size(); ++i) owners_[sideOf(loop[i], loop[(i + 1) % loop.size()])] = f;
    }

    /// Takes up the face on the other side of side `i` of face `f`.
    bool tryTake(std::uint32_t f, std::size_t i) {
        Growing& face = faces_[f];
        const std::uint32_t from = face.loop[i], to = face.loop[(i + 1) % face.loop.size()];
        const auto found = owners_.find(sideOf(to, from));
        if (found == owners_.end() || found->second == f) return false;
        Growing& other = faces_[found->second];
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
        note(f);
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
    std::unordered_map<std::uint64_t, std::uint32_t> owners_;
};

}  // namespace

ConvexFaces mergeFlatTriangles(const TriangleMesh& mesh) { return Merger(mesh).merge(); }

}  // namespace passung::geometry
