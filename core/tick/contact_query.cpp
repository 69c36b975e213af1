#include "core/tick/contact_query.h"

#include <algorithm>
#include <limits>

namespace passung::tick {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

/// State of one traversal; the steps of queryContacts.
struct Traversal {
    const model::DistanceField& field;
    const model::SphereTree& shell;
    const Pose& X_WF;
    const Mat3 R_WF;
    const Mat3 R_FS;
    const Vec3 p_FS;
    const Mat3 R_WS;
    const QueryRequest& request;
    QueryWorkspace& workspace;
    ContactManifold& manifold;
    QueryAnswer answer;
    std::size_t waiting = 0;
    double unproven_area = 0.0;

    Traversal(const model::DistanceField& f, const Pose& X_WF_, const model::SphereTree& s, const Pose& X_FS,
              const Pose& X_WS, const QueryRequest& r, QueryWorkspace& w, ContactManifold& m)
        : field(f),
          shell(s),
          X_WF(X_WF_),
          R_WF(X_WF_.q.toRotationMatrix()),
          R_FS(X_FS.q.toRotationMatrix()),
          p_FS(X_FS.p),
          R_WS(X_WS.q.toRotationMatrix()),
          request(r),
          workspace(w),
          manifold(m) {
        answer.phi = answer.lower_bound = request.search_below;
    }

    double pruneAbove() const noexcept {
        return std::max(request.collect_below, std::min(request.search_below, answer.phi));
    }

    bool exceedsBudget(const model::SphereNode& node) const noexcept {
        const int children = node.leaf ? 0 : static_cast<int>(node.count);
        return request.max_nodes > 0 && answer.nodes_visited + children > request.max_nodes;
    }

    /// `above`: the bound of the node's parent holds for its points too.
    void push(std::uint32_t node, double above) noexcept {
        const model::SphereNode& n = shell.nodes()[node];
        const double bound = std::max(above, field.lowerBound(R_FS * n.centre + p_FS) - n.radius);
        ++answer.nodes_visited;
        if (bound >= pruneAbove()) return;
        workspace.heap_[waiting++] = {bound, node};
        std::push_heap(workspace.heap_.begin(), at(waiting), later);
    }

    std::uint32_t pop(double& bound) noexcept {
        std::pop_heap(workspace.heap_.begin(), at(waiting), later);
        --waiting;
        bound = workspace.heap_[waiting].bound;
        return workspace.heap_[waiting].node;
    }

    /// `above`: a lower bound of φ there that is already known.
    void evaluate(const Vec3& position, const Vec3& normal, double area, double above) noexcept {
        const Vec3 p_F = R_FS * position + p_FS;
        const model::FieldSample s = field.sample(p_F, request.mode);
        ++answer.points_tested;
        if (request.prove) answer.lower_bound = std::min(answer.lower_bound, std::max(above, field.lowerBound(p_F)));
        if (s.phi < answer.phi) {
            answer.found = true;
            answer.phi = s.phi;
            answer.closest_F = p_F;
            answer.normal_W = s.gradient;
        }
        if (!(s.phi < request.collect_below)) return;
        ContactPoint contact;
        contact.position = X_WF * p_F;
        contact.gradient = R_WF * s.gradient;
        // A sample on an edge has no face of its own: the obstacle's face decides.
        contact.normal =
            area > 0.0 || contact.gradient.norm() < 1e-6 ? Vec3(R_WS * normal) : Vec3(-contact.gradient.normalized());
        contact.phi = s.phi;
        contact.area = area;
        if (!manifold.tryPush(contact)) answer.manifold_full = true;
    }

    /// The sphere of a node that is not looked into.
    void standIn(const model::SphereNode& node, double bound) noexcept {
        if (!(bound < request.collect_below)) return;
        const Vec3 centre_F = R_FS * node.centre + p_FS;
        ContactPoint contact;
        contact.position = X_WF * centre_F;
        contact.gradient = R_WF * field.sample(centre_F, request.mode).gradient;
        contact.normal = -contact.gradient;
        contact.phi = bound;
        contact.radius = node.radius;
        if (!manifold.tryPush(contact)) answer.manifold_full = true;
    }

    void run() noexcept {
        for (std::uint32_t root = 0; root < shell.roots().size(); ++root) push(root, -kInfinity);
        while (waiting > 0) {
            if (exceedsBudget(shell.nodes()[workspace.heap_.front().node])) {
                answer.budget_reached = true;
                break;
            }
            double bound = 0.0;
            const model::SphereNode& node = shell.nodes()[pop(bound)];
            if (bound >= pruneAbove()) continue;
            const std::uint32_t end = node.first + node.count;
            if (!node.leaf) {
                for (std::uint32_t child = node.first; child < end; ++child) push(child, bound);
                continue;
            }
            for (std::uint32_t i = node.first; i < end; ++i) {
                const model::SurfacePoint& point = shell.points()[i];
                evaluate(point.position, point.normal, point.area, bound);
            }
        }
        while (waiting > 0) {  // the budget ended
            double bound = 0.0;
            const model::SphereNode& node = shell.nodes()[pop(bound)];
            if (bound >= pruneAbove()) continue;
            evaluate(node.point, node.normal, node.area, bound);
            if (request.spheres) standIn(node, bound);
            answer.lower_bound = std::min(answer.lower_bound, bound);
            unproven_area += node.area;
        }
    }

private:
    static bool later(const QueryWorkspace::Entry& a, const QueryWorkspace::Entry& b) noexcept {
        return a.bound > b.bound || (a.bound == b.bound && a.node > b.node);
    }
    std::vector<QueryWorkspace::Entry>::iterator at(std::size_t i) noexcept {
        return workspace.heap_.begin() + static_cast<std::ptrdiff_t>(i);
    }
};

QueryAnswer queryContacts(const model::DistanceField& field, const Pose& X_WF, const model::SphereTree& shell,
                          const Pose& X_WS, const QueryRequest& request, QueryWorkspace& workspace,
                          ContactManifold& manifold) noexcept {
    const Pose X_FS = X_WF.inverse() * X_WS;
    Traversal traversal(field, X_WF, shell, X_FS, X_WS, request, workspace, manifold);
    traversal.run();
    QueryAnswer& answer = traversal.answer;
    if (answer.found) {
        answer.closest_W = X_WF * answer.closest_F;
        const double length = answer.normal_W.norm();
        answer.normal_W = length > 0.0 ? Vec3(traversal.R_WF * (answer.normal_W / length)) : Vec3(Vec3::Zero());
    }
    // Rounded sums of areas may exceed the total by a bit.
    if (shell.totalArea() > 0.0) answer.quality = std::max(0.0, 1.0 - traversal.unproven_area / shell.totalArea());
    return answer;
}

}  // namespace passung::tick
