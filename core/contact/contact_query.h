#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/base/types.h"
#include "core/field/field_mode.h"
#include "core/shell/sphere_tree.h"

namespace passung::field {
class DistanceField;
}

namespace passung::contact {

class Certificates;

/// One shell point near or inside an obstacle, or a sphere that stands for points nobody looked at; world frame.
struct ContactPoint {
    Vec3 position;      // p_WP [m]
    Vec3 normal;        // of the shell, unit, outward from the held part; of the field (turned) for edge samples
    Vec3 gradient;      // of φ, as interpolated; zero if the request does without
    double phi = 0.0;   // [m], < 0 inside the obstacle
    double area = 0.0;  // [m²]; of a node that stands for its points: the length of Σ area · normal over them
    std::uint32_t obstacle = 0;  // its place in the scene's list
    double radius = 0.0;  // of a sphere [m]: `position` is then its centre and `phi` a lower bound of what it holds
};

/// Contact manifold of one query or of several (it is appended to). Memory is sized once.
class ContactManifold {
public:
    explicit ContactManifold(std::size_t capacity = 0) : points_(capacity) {}
    std::size_t capacity() const noexcept { return points_.size(); }
    void clear() noexcept { count_ = 0; }
    /// Forgets all but the first `count`.
    void keepFirst(std::size_t count) noexcept { count_ = std::min(count, count_); }
    /// False if full.
    bool tryPush(const ContactPoint& point) noexcept {
        if (count_ == points_.size()) return false;
        points_[count_++] = point;
        return true;
    }
    /// Tells the points from number `first` on as seen from the other part: normals and gradients turn round.
    void reverseFrom(std::size_t first) noexcept {
        for (std::size_t i = first; i < count_; ++i) {
            points_[i].normal = -points_[i].normal;
            points_[i].gradient = -points_[i].gradient;
        }
    }
    /// Notes that the points from `first` on belong to `obstacle`.
    void assign(std::size_t first, std::uint32_t obstacle) noexcept {
        for (std::size_t i = first; i < count_; ++i) points_[i].obstacle = obstacle;
    }
    const ContactPoint* begin() const noexcept { return points_.data(); }
    const ContactPoint* end() const noexcept { return points_.data() + count_; }
    std::size_t size() const noexcept { return count_; }
    const ContactPoint& operator[](std::size_t i) const noexcept { return points_[i]; }

private:
    std::vector<ContactPoint> points_;
    std::size_t count_ = 0;
};

struct QueryAnswer {
    bool found = false;             // a point with φ < search_below exists
    double phi = 0.0;               // of the deepest or closest point if found, else search_below (a lower bound)
    Vec3 closest_W = Vec3::Zero();  // that point
    Vec3 normal_W = Vec3::Zero();   // unit gradient of φ there: out of the obstacle
    Vec3 closest_F = Vec3::Zero();  // the same point in the field's frame
    double lower_bound = 0.0;       // if asked to prove: no point of the shell has a true φ below this [m]
    double quality = 1.0;           // share of the shell's area pruned with proof or evaluated point by point
    int nodes_visited = 0;
    int points_tested = 0;
    int points_spared = 0;  // in leaves of which earlier readings told that they hold nothing that is asked for
    int contacts = 0;       // points with φ < collect_below, those taken as one included
    Wrench load;  // if asked for: Σ area · depth · (-normal) over the contacts, about the shell's origin, world axes
    bool budget_reached = false;
    bool paused = false;  // QueryRequest::pauses: nothing else but the counts says anything yet
    bool manifold_full = false;
};

/// Memory of a traversal, sized once for a tree, and in it the traversal that waits for more budget.
class QueryWorkspace {
public:
    explicit QueryWorkspace(std::size_t nodes = 0) : heap_(nodes), near_(nodes * shell::SphereTree::kLeafGroups) {}
    /// Forgets what waits.
    void drop() noexcept { pause_.open = false; }

private:
    struct Entry {
        double bound;  // no point below the node is nearer than this [m]
        double order;  // the least is taken first
        std::uint32_t node;
    };
    struct Near {
        float phi;  // at the group's mean position
        std::uint32_t group;
    };
    /// Nodes that wait are the first of heap_.
    struct Pause {
        bool open = false;
        std::size_t waiting = 0;
        QueryAnswer answer;
        std::uint32_t deepest = 0;
        double expected = 0.0;
    };
    std::vector<Entry> heap_;
    std::vector<Near> near_;
    Pause pause_;
    friend struct Traversal;
};

/// What a query is asked for.
struct QueryRequest {
    double collect_below = 0.0;  // points with φ < this go into the manifold [m] (the thesis's p_c)
    // Of those at this or above it only the nearest of each leaf and octant of the normal [m]; with gradients, in
    // FieldMode::Trilinear.
    double every_below = std::numeric_limits<double>::infinity();
    double search_below = 0.0;  // the deepest or closest point is searched up to this φ [m]
    int max_nodes = 0;          // budget (the thesis's η_c, in nodes so that it is deterministic); 0 = none
    // Least QueryAnswer::quality (the thesis's q_c), 0 … 1: wins over the budget, but not of a query that pauses.
    double quality = 0.0;
    bool pauses = false;  // where the budget ends the query waits in its workspace, for more (queryContacts)
    field::FieldMode mode = field::FieldMode::Trilinear;
    bool prove = false;     // also find QueryAnswer::lower_bound; costs about as much again
    bool spheres = false;   // a node left over by the budget also enters the manifold as a sphere
    bool gradients = true;  // of every contact; without them, φ of contacts is read in single precision, several times
                            // as fast (DistanceField::sampleMany), in FieldMode::Trilinear
    bool facing = false;  // a sample of a face is a contact only where the other surface faces it, not at a rim, whose
                          // own samples are then asked too (two_way); with gradients; not of open sheets
    bool load = false;    // instead of contacts in the manifold QueryAnswer::load; where many points are in contact,
                          // neighbours may then be taken as one
    bool edges = false;   // what lies on edges between their samples is searched too (queryObstacles: edge_search.h)
    // Every node that pruning leaves is looked at, whatever earlier looks have proven: only leaves' points are spared.
    bool every_node = false;
    bool refine = false;  // the deepest point is searched on the surface between the samples too
};

/// Collision, proximity and penalty in one traversal of a point-sphere tree against a distance field.
///   Source: Sagardia 2019, algorithm 3.1 (reconstructed), with φ = -V.
///   Best first by  b = φ_low(c) - R,  φ_low a rigorous lower bound of φ at the sphere's centre c and R its radius:
///   φ is 1-Lipschitz, so no point below the node has φ < b, and a node with  b ≥ max(collect, min(search, best))
///   is pruned with proof. Where nothing but contacts is sought the order does not matter and nodes are taken as they
///   come; under a budget without spheres the roots come first, because they alone join what faces apart and
///   would spoil the wrench. A leaf's points are all
///   evaluated, in one loop over the whole leaf. Limit cases: everything far → the roots are all that is visited; a
///   budget that ends → each node still waiting is represented by its own point with the area vector of all points
///   below (the wrench of a constant pressure stays the same), and `quality` says which share of the area was proven or
///   evaluated. With a least quality asked for it goes on, best first still, until nodes of no more than the rest of
///   the area wait, though some of these might be ruled out yet. With `spheres` its sphere enters the manifold besides,
///   with φ = b: what keeps the sphere out keeps its points out.
/// A query that `pauses` when its budget ends leaves no node out: the same call, with the contacts found so far in
/// `manifold`, goes on where it stopped, by one node at least, until its answer is no longer `paused` and is that of a
/// query without a budget. Its counts are those of one call each.
/// With `known`, of this shell in this field, nodes are passed over that earlier looks have proven to hold nothing that
/// is asked for (certificates.h): the answer is the same but for what it took, `nodes_visited` and points; with
/// `every_node` for points alone. Appends to `manifold`. rt-safe; the number of steps is bounded by the
/// number of nodes.
/// @pre `workspace` has room for all nodes of `shell`; poses are finite.
QueryAnswer queryContacts(const field::DistanceField& field, const Pose& X_WF, const shell::SphereTree& shell,
                          const Pose& X_WS, const QueryRequest& request, QueryWorkspace& workspace,
                          ContactManifold& manifold, Certificates* known = nullptr) noexcept;

}  // namespace passung::contact
