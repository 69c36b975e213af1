#include "core/tick/contact_query.h"

#include <algorithm>
#include <array>
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
    const model::DistanceField::Placement S;  // the shell in the field
    const Mat3 R_WF;
    const Mat3 R_FS;
    const Vec3 p_FS;
    const Mat3 R_WS;
    const Vec3 p_WS;
    const QueryRequest& request;
    const bool ordered;  // best first
    const double slack;  // sampleMany is off by at most this next to sample() [m]
    QueryWorkspace& workspace;
    ContactManifold& manifold;
    QueryAnswer answer;
    std::size_t waiting = 0;
    double unproven_area = 0.0;
    std::array<float, model::SphereTree::kLeafPoints> phi, low;
    std::array<float, model::SphereTree::kChildren> at_centre;

    Traversal(const model::DistanceField& f, const Pose& X_WF_, const model::SphereTree& s, const Pose& X_FS_,
              const Pose& X_WS, const QueryRequest& r, QueryWorkspace& w, ContactManifold& m)
        : field(f),
          shell(s),
          X_WF(X_WF_),
          S(f.place(X_FS_)),
          R_WF(X_WF_.q.toRotationMatrix()),
          R_FS(X_FS_.q.toRotationMatrix()),
          p_FS(X_FS_.p),
          R_WS(X_WS.q.toRotationMatrix()),
          p_WS(X_WS.p),
          request(r),
          ordered(r.max_nodes > 0 || r.search_below > r.collect_below),
          // No brick spans more: its cells are those asked for, or at most 1/72 of the longest side.
          slack(0x1p-20 * (f.bounds().size().norm() + 14.0 * f.cell())),
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

    /// Some nodes that follow each other; `above`: the bound of their parent holds for their points too.
    void push(std::uint32_t begin, std::uint32_t count, double above) noexcept {
        const auto& centres = shell.centres();
        field.lowerBounds(S, centres.x(begin, count), centres.y(begin, count), centres.z(begin, count),
                          {at_centre.data(), count});
        for (std::uint32_t i = 0; i < count; ++i) {
            const std::uint32_t node = begin + i;
            const double bound = std::max(above, static_cast<double>(at_centre[i]) - shell.nodes()[node].radius);
            ++answer.nodes_visited;
            if (bound >= pruneAbove()) continue;
            const bool first = request.max_nodes > 0 && !request.spheres && node < shell.roots().size();
            workspace.heap_[waiting++] = {bound, first ? -kInfinity : bound, node};
            if (ordered) std::push_heap(workspace.heap_.begin(), at(waiting), later);
        }
    }

    std::uint32_t pop(double& bound) noexcept {
        if (ordered) std::pop_heap(workspace.heap_.begin(), at(waiting), later);
        --waiting;
        bound = workspace.heap_[waiting].bound;
        return workspace.heap_[waiting].node;
    }

    /// One point; `above`: a lower bound of φ there that is already known.
    void evaluate(const Vec3& position, const Vec3& normal, double area, double above) noexcept {
        ++answer.points_tested;
        const Vec3 p_F = R_FS * position + p_FS;
        prove(p_F, above);
        take(p_F, position, normal, area, field.sample(p_F, request.mode, -(R_FS * normal)));
    }

    void prove(const Vec3& p_F, double above) noexcept {
        if (!request.prove || above >= answer.lower_bound) return;
        answer.lower_bound = std::min(answer.lower_bound, std::max(above, field.lowerBound(p_F)));
    }

    void take(const Vec3& p_F, const Vec3& position, const Vec3& normal, double area,
              const model::FieldSample& s) noexcept {
        if (s.phi < answer.phi) {
            answer.found = true;
            answer.phi = s.phi;
            answer.closest_F = p_F;
            answer.normal_W = s.gradient;
        }
        if (s.phi < request.collect_below) collect(position, normal, area, s.phi, s.gradient);
    }

    void collect(const Vec3& position, const Vec3& normal, double area, double depth, const Vec3& gradient) noexcept {
        ContactPoint contact;
        contact.position = R_WS * position + p_WS;
        contact.gradient = R_WF * gradient;
        // A sample on an edge has no face of its own: the obstacle's face decides.
        contact.normal = area > 0.0 || contact.gradient.squaredNorm() < 1e-12 ? Vec3(R_WS * normal)
                                                                              : Vec3(-contact.gradient.normalized());
        contact.phi = depth;
        contact.area = area;
        if (!manifold.tryPush(contact)) answer.manifold_full = true;
    }

    /// All points of a leaf.
    void evaluateLeaf(const model::SphereNode& leaf, double above) noexcept {
        if (request.mode != model::FieldMode::Trilinear) {
            for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) {
                const model::SurfacePoint& point = shell.points()[i];
                evaluate(point.position, point.normal, point.area, above);
            }
            return;
        }
        const std::size_t first = leaf.first, count = leaf.count;
        const auto& positions = shell.positions();
        field.sampleMany(S, positions.x(first, count), positions.y(first, count), positions.z(first, count),
                         {phi.data(), count});
        answer.points_tested += static_cast<int>(count);
        if (request.prove && above < answer.lower_bound) {
            field.lowerBounds(S, positions.x(first, count), positions.y(first, count), positions.z(first, count),
                              {low.data(), count});
            const double least = static_cast<double>(*std::min_element(low.begin(), low.begin() + leaf.count));
            answer.lower_bound = std::min(answer.lower_bound, std::max(above, least));
        }
        for (std::size_t i = 0; i < count; ++i) {
            const double read = static_cast<double>(phi[i]);
            const bool contact = read < request.collect_below + (request.gradients ? slack : 0.0);
            if (!(contact || read - slack < answer.phi)) continue;
            const model::SurfacePoint& point = shell.points()[first + i];
            if (request.gradients || read - slack < answer.phi || !(point.area > 0.0)) {
                const Vec3 p_F = R_FS * point.position + p_FS;
                take(p_F, point.position, point.normal, point.area, field.sample(p_F, model::FieldMode::Trilinear));
            } else {
                collect(point.position, point.normal, point.area, read, Vec3::Zero());
            }
        }
    }

    /// The sphere of a node that is not looked into.
    void standIn(const model::SphereNode& node, double bound) noexcept {
        if (!(bound < request.collect_below)) return;
        const Vec3 centre_F = R_FS * node.centre + p_FS;
        ContactPoint contact;
        contact.position = X_WF * centre_F;
        contact.gradient = R_WF * field.sample(centre_F, request.mode, -(R_FS * node.normal)).gradient;
        contact.normal = -contact.gradient;
        contact.phi = bound;
        contact.radius = node.radius;
        if (!manifold.tryPush(contact)) answer.manifold_full = true;
    }

    void run() noexcept {
        push(0, static_cast<std::uint32_t>(shell.roots().size()), -kInfinity);
        while (waiting > 0) {
            if (request.max_nodes > 0 && exceedsBudget(shell.nodes()[workspace.heap_.front().node])) {
                answer.budget_reached = true;
                break;
            }
            double bound = 0.0;
            const model::SphereNode& node = shell.nodes()[pop(bound)];
            if (bound >= pruneAbove()) continue;
            if (node.leaf) {
                evaluateLeaf(node, bound);
                continue;
            }
            push(node.first, node.count, bound);
        }
        while (waiting > 0) {  // the budget ended
            double bound = 0.0;
            const model::SphereNode& node = shell.nodes()[pop(bound)];
            if (bound >= pruneAbove()) continue;
            evaluate(node.point, node.normal, node.facing_area, bound);
            if (request.spheres) standIn(node, bound);
            answer.lower_bound = std::min(answer.lower_bound, bound);
            unproven_area += node.area;
        }
    }

private:
    static bool later(const QueryWorkspace::Entry& a, const QueryWorkspace::Entry& b) noexcept {
        return a.order > b.order || (a.order == b.order && a.node > b.node);
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
