#include "core/import/patch_orientation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numeric>
#include <utility>

#include "core/geometry/triangle_tree.h"

namespace passung::importer {

namespace {

constexpr std::size_t kLargePatches = 64;
constexpr std::size_t kProbes = 24;  // triangles asked for a large patch, at most
constexpr std::size_t kFewProbes = 3;
constexpr double kAway = 0.2;  // of the root of a patch's area: how far before and behind it the others are asked
constexpr double kBesidePatch = 1e-4;  // the same, for what it says itself
constexpr double kDoubt = 0.05;        // evidence below this may be an error of the winding number
constexpr double kClear = 0.05;        // evidence above this decides the order
constexpr double kInside = 0.5;
constexpr double kBounds = 0.5;  // |B| above this: the patch bounds a solid of its own
constexpr int kSweeps = 4;
constexpr std::size_t kDisorderProbes = 1000;
constexpr double kBesideMesh = 1e-5;  // of the mesh's size

struct Patch {
    std::unique_ptr<geometry::TriangleTree> tree;  // of its triangles alone
    std::vector<Vec3> behind, before;
    double own = 0.0;   // B
    double size = 0.0;  // diagonal of its box [m]
    double area = 0.0;
};

Patch describe(const geometry::TriangleMesh& mesh, const std::vector<std::uint32_t>& triangles,
               std::size_t most_probes) {
    geometry::TriangleMesh alone;
    std::vector<Vec3> middles, areas;
    Patch patch;
    for (const std::uint32_t i : triangles) {
        const auto first = static_cast<std::uint32_t>(alone.vertices.size());
        for (const std::uint32_t v : mesh.triangles[i]) alone.vertices.push_back(mesh.vertices[v]);
        alone.triangles.push_back({first, first + 1, first + 2});
        const Vec3 &a = alone.vertices[first], &b = alone.vertices[first + 1], &c = alone.vertices[first + 2];
        middles.emplace_back((a + b + c) / 3.0);
        areas.emplace_back(0.5 * (b - a).cross(c - a));
        patch.area += areas.back().norm();
    }
    patch.tree = std::make_unique<geometry::TriangleTree>(alone);
    patch.size = geometry::boundsOf(alone).size().norm();
    const double length = std::sqrt(patch.area);
    const std::size_t stride = (triangles.size() + most_probes - 1) / most_probes;
    double asked_area = 0.0;
    const auto ask = [&](const auto& use) {
        for (std::size_t k = stride / 2; k < triangles.size(); k += stride)
            use(middles[k], Vec3(areas[k].normalized()), areas[k].norm());
    };
    ask([&](const Vec3& middle, const Vec3& normal, double area) {
        const Vec3 beside = kBesidePatch * length * normal;
        patch.own += area * (patch.tree->windingNumber(middle - beside) + patch.tree->windingNumber(middle + beside));
        asked_area += area;
    });
    patch.own /= asked_area;
    // Round a solid of its own the others need not be asked far away, where a thin wall might end.
    const double away = (std::abs(patch.own) > kBounds ? kBesidePatch : kAway) * length;
    ask([&](const Vec3& middle, const Vec3& normal, double) {
        patch.behind.emplace_back(middle - away * normal);
        patch.before.emplace_back(middle + away * normal);
    });
    return patch;
}

/// What others say about a patch: means over its probes.
struct Evidence {
    double behind = 0.0, before = 0.0;  // winding numbers
    double rise() const { return behind - before; }
    bool inside() const { return 0.5 * (behind + before) > kInside; }
    double score(const Patch& patch) const { return rise() + (inside() ? 0.0 : patch.own); }
};

template <class Winding>
Evidence ask(const Patch& patch, const Winding& winding) {
    Evidence evidence;
    for (const Vec3& p : patch.behind) evidence.behind += winding(p);
    for (const Vec3& p : patch.before) evidence.before += winding(p);
    const auto count = static_cast<double>(patch.behind.size());
    return {evidence.behind / count, evidence.before / count};
}

/// How far the mesh is from bounding a solid, or one inside out: the mean over its area of what the winding numbers
/// just behind and just in front, added, are off 1.
double disorderOf(const geometry::TriangleMesh& mesh) {
    const geometry::TriangleTree tree(mesh);
    const double step = kBesideMesh * geometry::boundsOf(mesh).size().norm();
    const std::size_t stride = std::max<std::size_t>(1, mesh.triangles.size() / kDisorderProbes);
    std::array<double, 2> off{};  // outside out, inside out
    double total_area = 0.0;
    for (std::size_t i = 0; i < mesh.triangles.size(); i += stride) {
        const auto& t = mesh.triangles[i];
        const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
        const Vec3 area = (b - a).cross(c - a), middle = (a + b + c) / 3.0, beside = step * area.normalized();
        const double balance = tree.windingNumber(middle - beside) + tree.windingNumber(middle + beside);
        off[0] += area.norm() * std::abs(balance - 1.0);
        off[1] += area.norm() * std::abs(balance + 1.0);
        total_area += area.norm();
    }
    return std::min(off[0], off[1]) / total_area;
}

class Orientation {
public:
    Orientation(geometry::TriangleMesh& mesh, const std::vector<std::vector<std::uint32_t>>& patches)
        : mesh_(mesh), patches_(patches), turned_(patches.size(), 0) {
        std::vector<double> area(patches.size(), 0.0);
        for (std::size_t i = 0; i < patches.size(); ++i) {
            for (const std::uint32_t t : patches[i]) {
                const auto& [a, b, c] = mesh.triangles[t];
                area[i] += (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).norm();
            }
        }
        by_area_.resize(patches.size());
        std::iota(by_area_.begin(), by_area_.end(), std::size_t{0});
        std::stable_sort(by_area_.begin(), by_area_.end(),
                         [&](std::size_t i, std::size_t j) { return area[i] > area[j]; });
    }

    PatchOrientation settle() {
        judgeLarge();
        for (int sweep = 0; sweep < kSweeps && judgeSmall(); ++sweep) {
        }
        PatchOrientation result;
        result.turned_all = turned_all_;
        result.cavities = cavities_large_ + cavities_small_;
        result.nested_solids = nested_large_ + nested_small_;
        for (std::size_t i = 0; i < patches_.size(); ++i) {
            if (turned_[i] == 0) continue;
            ++result.turned_patches;
            result.turned_triangles += patches_[i].size();
        }
        return result;
    }

private:
    void turn(std::size_t i) {
        for (const std::uint32_t t : patches_[i]) std::swap(mesh_.triangles[t][1], mesh_.triangles[t][2]);
        turned_[i] ^= 1;
    }

    void turnAll() {
        for (geometry::Triangle& t : mesh_.triangles) std::swap(t[1], t[2]);
        turned_all_ = true;
    }

    /// One after the other; what is judged adds its winding number to the evidence of the others.
    void judgeLarge() {
        const std::size_t count = std::min(kLargePatches, by_area_.size());
        std::vector<Patch> large;
        for (std::size_t k = 0; k < count; ++k) large.push_back(describe(mesh_, patches_[by_area_[k]], kProbes));
        std::vector<Evidence> evidence(count);
        std::vector<char> judged(count, 0);
        for (std::size_t done = 0; done < count; ++done) {
            std::size_t next = count;
            const auto rank = [&](std::size_t k) {
                const double clear = std::abs(evidence[k].rise());
                return std::pair(clear > kClear ? clear : 0.0, large[k].size);
            };
            for (std::size_t k = 0; k < count; ++k)
                if (judged[k] == 0 && (next == count || rank(k) > rank(next))) next = k;
            judged[next] = 1;
            if (done == 0 && large[next].own < -kBounds) {
                turnAll();
                for (Patch& patch : large) {
                    patch.own = -patch.own;
                    std::swap(patch.behind, patch.before);
                }
            }
            const bool wrong = evidence[next].score(large[next]) < -kDoubt;
            if (wrong) turn(by_area_[next]);
            const double facing = wrong ? -1.0 : 1.0, since_described = turned_all_ ? -facing : facing;
            if (evidence[next].inside() && std::abs(large[next].own) > kBounds)
                ++(facing * large[next].own < 0.0 ? cavities_large_ : nested_large_);
            for (std::size_t k = 0; k < count; ++k) {
                if (judged[k] != 0) continue;
                const Evidence more =
                    ask(large[k], [&](const Vec3& p) { return since_described * large[next].tree->windingNumber(p); });
                evidence[k].behind += more.behind;
                evidence[k].before += more.before;
            }
        }
    }

    /// All at once against all; true if one was turned.
    bool judgeSmall() {
        cavities_small_ = nested_small_ = 0;
        if (by_area_.size() <= kLargePatches) return false;
        const geometry::TriangleTree all(mesh_);
        std::vector<std::size_t> wrong;
        for (std::size_t k = kLargePatches; k < by_area_.size(); ++k) {
            const Patch patch = describe(mesh_, patches_[by_area_[k]], kFewProbes);
            const Evidence evidence =
                ask(patch, [&](const Vec3& p) { return all.windingNumber(p) - patch.tree->windingNumber(p); });
            if (evidence.score(patch) < -kDoubt) wrong.push_back(by_area_[k]);
            if (evidence.inside() && std::abs(patch.own) > kBounds)
                ++(patch.own < 0.0 ? cavities_small_ : nested_small_);
        }
        for (const std::size_t i : wrong) turn(i);
        return !wrong.empty();
    }

    geometry::TriangleMesh& mesh_;
    const std::vector<std::vector<std::uint32_t>>& patches_;
    std::vector<std::size_t> by_area_;  // falling
    std::vector<char> turned_;
    bool turned_all_ = false;
    std::size_t cavities_large_ = 0, cavities_small_ = 0, nested_large_ = 0, nested_small_ = 0;
};

}  // namespace

std::vector<std::vector<std::uint32_t>> piecesToOrient(const geometry::TriangleMesh& mesh,
                                                       const std::vector<geometry::HalfEdge>& edges) {
    auto patches = geometry::patchesOf(mesh, edges);
    std::vector<std::uint32_t> patch_of(mesh.triangles.size());
    for (std::size_t i = 0; i < patches.size(); ++i)
        for (const std::uint32_t t : patches[i]) patch_of[t] = static_cast<std::uint32_t>(i);
    geometry::Groups components(patches.size());
    std::vector<char> alone(patches.size(), 1);     // each edge balanced by the patch itself
    std::vector<char> together(patches.size(), 1);  // by all that use it
    geometry::forEachEdge(edges, [&](const geometry::HalfEdge* use, std::size_t count) {
        int balance = 0;
        for (std::size_t k = 0; k < count; ++k) {
            const std::uint32_t patch = patch_of[use[k].triangle];
            int own = 0;
            for (std::size_t i = 0; i < count; ++i)
                if (patch_of[use[i].triangle] == patch) own += use[i].forward ? 1 : -1;
            if (own != 0) alone[patch] = 0;
            components.join(patch_of[use[0].triangle], patch);
            balance += use[k].forward ? 1 : -1;
        }
        for (std::size_t k = 0; k < count && balance != 0; ++k) together[patch_of[use[k].triangle]] = 0;
    });
    std::vector<char> closed(patches.size(), 1);
    for (std::uint32_t i = 0; i < patches.size(); ++i)
        if (together[i] == 0) closed[components.find(i)] = 0;
    constexpr std::size_t kNone = ~std::size_t{0};
    std::vector<std::size_t> piece_of(patches.size(), kNone);  // of components
    std::vector<std::vector<std::uint32_t>> pieces;
    for (std::uint32_t i = 0; i < patches.size(); ++i) {
        const std::uint32_t component = components.find(i);
        const bool joins = closed[component] != 0 && alone[i] == 0;
        if (joins && piece_of[component] != kNone) {
            auto& piece = pieces[piece_of[component]];
            piece.insert(piece.end(), patches[i].begin(), patches[i].end());
            continue;
        }
        if (joins) piece_of[component] = pieces.size();
        pieces.push_back(std::move(patches[i]));
    }
    return pieces;
}

PatchOrientation orientPatches(geometry::TriangleMesh& mesh, const std::vector<std::vector<std::uint32_t>>& patches) {
    std::vector<geometry::Triangle> written = mesh.triangles;
    const PatchOrientation result = Orientation(mesh, patches).settle();
    if (result.turned_patches == 0) return result;
    const double turned = disorderOf(mesh);
    std::swap(mesh.triangles, written);
    if (disorderOf(mesh) < turned) return {};
    std::swap(mesh.triangles, written);
    return result;
}

}  // namespace passung::importer
