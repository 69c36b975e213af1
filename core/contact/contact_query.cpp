#include "core/contact/contact_query.h"

#include <algorithm>
#include <array>
#include <limits>

#include "core/contact/rim_gradient.h"
#include "core/contact/surface_descent.h"

namespace passung::tick {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kBatch = 64;  // nodes or points that are looked at together
constexpr std::uint32_t kNoPoint = ~0u;
constexpr double kFacing = 0.8;    // cosine between a face's inward normal and φ's gradient
constexpr double kSettled = 48.0;  // groups in contact: from here on their errors level out, and some are taken whole

/// Places in the shell's frame, one after the other, though they are parted in memory.
struct Batch {
    std::array<float, kBatch> x, y, z, radius, read;
    std::array<std::uint32_t, kBatch> index;
    std::size_t count = 0;

    void append(const model::FloatPositions& from, std::uint32_t first, std::size_t n) noexcept {
        std::copy_n(from.x(first, n).data(), n, x.data() + count);
        std::copy_n(from.y(first, n).data(), n, y.data() + count);
        std::copy_n(from.z(first, n).data(), n, z.data() + count);
        for (std::uint32_t i = 0; i < n; ++i) index[count + i] = first + i;
        count += n;
    }
    Vec3 position(std::size_t i) const noexcept {
        return {static_cast<double>(x[i]), static_cast<double>(y[i]), static_cast<double>(z[i])};
    }
    std::span<const float> all(const std::array<float, kBatch>& axis) const noexcept { return {axis.data(), count}; }
};

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
    const bool grouped;
    const bool gradients;
    const bool facing;
    const double slack;  // sampleMany is off by at most this next to sample() [m]
    QueryWorkspace& workspace;
    ContactManifold& manifold;
    QueryAnswer answer;
    std::size_t waiting = 0;
    double unproven_area = 0.0;
    std::array<float, model::SphereTree::kChildren> at_centre;
    Batch batch;
    std::uint32_t deepest = kNoPoint;  // the point of the shell that answer.phi belongs to
    std::size_t near_groups = 0;
    int groups_inside = 0;
    float least_in_group = std::numeric_limits<float>::infinity();
    std::uint32_t lowest_group = kNoPoint;
    Vec3 force = Vec3::Zero(), moment = Vec3::Zero();  // of the load, in the shell's frame

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
          grouped(r.load && r.collect_below == 0.0 && !ordered && !r.prove && r.mode == model::FieldMode::Trilinear),
          gradients(r.gradients && !r.load),
          facing(r.facing && !(f.sheetOffset() > 0.0)),
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
    void evaluate(const Vec3& position, const Vec3& normal, double area, double above, std::uint32_t point) noexcept {
        ++answer.points_tested;
        const Vec3 p_F = R_FS * position + p_FS;
        prove(p_F, above);
        take(p_F, position, normal, area, field.sample(p_F, request.mode, -(R_FS * normal)), point);
    }

    void prove(const Vec3& p_F, double above) noexcept {
        if (!request.prove || above >= answer.lower_bound) return;
        answer.lower_bound = std::min(answer.lower_bound, std::max(above, field.lowerBound(p_F)));
    }

    void take(const Vec3& p_F, const Vec3& position, const Vec3& normal, double area, const model::FieldSample& s,
              std::uint32_t point) noexcept {
        if (s.phi < answer.phi) {
            answer.found = true;
            deepest = point;
            answer.phi = s.phi;
            answer.closest_F = p_F;
            answer.normal_W = s.gradient;
        }
        if (s.phi < request.collect_below) collect(position, normal, area, s.phi, s.gradient);
    }

    void collect(const Vec3& position, const Vec3& normal, double area, double phi, const Vec3& gradient) noexcept {
        if (facing && area > 0.0 && !(-normal.dot(R_FS.transpose() * gradient) > kFacing * gradient.norm())) return;
        ++answer.contacts;
        if (request.load) {
            const Vec3 f = area * phi * normal;
            force += f;
            moment += position.cross(f);
            return;
        }
        ContactPoint contact;
        contact.position = R_WS * position + p_WS;
        const bool of_face = facing && area > 0.0;
        contact.gradient =
            R_WF * (of_face ? withoutTurnOfRim(gradient, R_FS * normal, phi, field.finestCell()) : gradient);
        // A sample on an edge has no face of its own: the obstacle's face decides.
        contact.normal = area > 0.0 || contact.gradient.squaredNorm() < 1e-12 ? Vec3(R_WS * normal)
                                                                              : Vec3(-contact.gradient.normalized());
        contact.phi = phi;
        contact.area = area;
        if (!manifold.tryPush(contact)) answer.manifold_full = true;
    }

    /// All points of a leaf.
    void evaluateLeaf(const model::SphereNode& leaf, double above) noexcept {
        if (request.mode != model::FieldMode::Trilinear) {
            for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) {
                const model::SurfacePoint& point = shell.points()[i];
                evaluate(point.position, point.normal, point.area, above, i);
            }
            return;
        }
        batch.append(shell.positions(), leaf.first, leaf.count);
        evaluateBatch();
        if (request.prove && above < answer.lower_bound) {
            std::array<float, model::SphereTree::kLeafPoints> low;
            const auto& at = shell.positions();
            field.lowerBounds(S, at.x(leaf.first, leaf.count), at.y(leaf.first, leaf.count),
                              at.z(leaf.first, leaf.count), {low.data(), leaf.count});
            const double least = static_cast<double>(*std::min_element(low.begin(), low.begin() + leaf.count));
            answer.lower_bound = std::min(answer.lower_bound, std::max(above, least));
        }
    }

    /// The points of the batch; in FieldMode::Trilinear.
    void evaluateBatch() noexcept {
        field.sampleMany(S, batch.all(batch.x), batch.all(batch.y), batch.all(batch.z),
                         {batch.read.data(), batch.count});
        answer.points_tested += static_cast<int>(batch.count);
        const double read_off = gradients ? slack : 0.0;
        // Those that matter, without a jump, first.
        const auto limit = static_cast<float>(std::max(request.collect_below + read_off, answer.phi + slack));
        std::array<std::uint32_t, kBatch> near;
        std::size_t nears = 0;
        float least = std::numeric_limits<float>::infinity();
        for (std::uint32_t i = 0; i < batch.count; ++i) {
            near[nears] = i;
            nears += batch.read[i] <= limit ? 1 : 0;
            least = std::min(least, batch.read[i]);
        }
        // Only what is not surely above another is read exactly.
        const double lowest = std::min(static_cast<double>(least) + 2.0 * slack, answer.phi + slack);
        for (std::size_t k = 0; k < nears; ++k) {
            const double read = static_cast<double>(batch.read[near[k]]);
            const std::uint32_t point = batch.index[near[k]];
            const Vec3 position = batch.position(near[k]);
            const model::Facing& weight = shell.facings()[point];
            const Vec3 normal = weight.normal.cast<double>();
            const auto area = static_cast<double>(weight.area);
            const bool exactly = gradients || (!request.load && !(area > 0.0));
            if (read < lowest || (exactly && read < request.collect_below + read_off)) {
                const Vec3 p_F = R_FS * position + p_FS;
                take(p_F, position, normal, area, field.sample(p_F, request.mode), point);
            } else if (read < request.collect_below) {
                collect(position, normal, area, read, Vec3::Zero());
            }
        }
        batch.count = 0;
    }

    /// All nodes level by level, and then the leaves that are left: many together are read several times as fast.
    /// For a limit that stays the same; no budget.
    void sweep() noexcept {
        std::vector<QueryWorkspace::Entry>& heap = workspace.heap_;
        std::size_t next = 0, end = 0, leaves = heap.size();  // nodes wait from the front, leaves from the back
        const auto screen = [&] {
            field.lowerBounds(S, batch.all(batch.x), batch.all(batch.y), batch.all(batch.z),
                              {batch.read.data(), batch.count});
            answer.nodes_visited += static_cast<int>(batch.count);
            for (std::size_t i = 0; i < batch.count; ++i) {
                const std::uint32_t node = batch.index[i];
                const double bound = static_cast<double>(batch.read[i]) - static_cast<double>(shell.radii()[node]);
                if (bound >= request.collect_below) continue;
                heap[shell.nodes()[node].leaf ? --leaves : end++] = {bound, bound, node};
            }
            batch.count = 0;
        };
        batch.append(shell.centres(), 0, shell.roots().size());
        for (screen(); next < end; screen())
            while (next < end && batch.count + model::SphereTree::kChildren <= kBatch) {
                const model::SphereNode& node = shell.nodes()[heap[next++].node];
                batch.append(shell.centres(), node.first, node.count);
            }
        if (grouped) return sweepGroups(leaves);
        while (leaves < heap.size()) {
            if (request.mode != model::FieldMode::Trilinear) {
                evaluateLeaf(shell.nodes()[heap[leaves].node], heap[leaves].bound);
                ++leaves;
                continue;
            }
            while (leaves < heap.size()) {
                const model::SphereNode& leaf = shell.nodes()[heap[leaves].node];
                if (batch.count + leaf.count > kBatch) break;
                batch.append(shell.positions(), leaf.first, leaf.count);
                ++leaves;
            }
            evaluateBatch();
        }
    }

    /// Groups of the leaves first, then the points of those groups that matter.
    ///   Taking a group of radius R whole errs where the depth has its kink within it, |φ| < R, and by the surface's
    /// curvature; over n groups in contact such errors level out. So of n groups those are taken apart for which
    ///   -R t < φ < R min(1, t),  t = kSettled / n:  all of a small contact, ever fewer at the rim of a larger one,
    /// and those that may hold the deepest point.
    void sweepGroups(std::size_t leaf) noexcept {
        const std::vector<QueryWorkspace::Entry>& heap = workspace.heap_;
        while (leaf < heap.size()) {
            for (; leaf < heap.size(); ++leaf) {
                const model::SphereNode& node = shell.nodes()[heap[leaf].node];
                const std::uint32_t groups =
                    (node.count + model::SphereTree::kGroupPoints - 1) / model::SphereTree::kGroupPoints;
                if (batch.count + groups > kBatch) break;
                batch.append(shell.groupPositions(), node.first_group, groups);
            }
            screenGroups();
        }
        const double share = kSettled / std::max(1, groups_inside);
        const auto within = static_cast<float>(-share), without = static_cast<float>(std::min(1.0, share));
        const auto takeApart = [&](std::uint32_t group) {
            const std::uint32_t first = shell.groupPoints()[group], count = shell.groupPoints()[group + 1] - first;
            if (batch.count + count > kBatch) evaluateBatch();
            batch.append(shell.positions(), first, count);
        };
        if (lowest_group != kNoPoint) {
            takeApart(lowest_group);
            evaluateBatch();
        }
        for (std::size_t i = 0; i < near_groups; ++i) {
            const auto& [phi, group] = workspace.near_[i];
            if (group == lowest_group) continue;
            const float radius = shell.groupRadii()[group];
            const bool may_be_deepest = static_cast<double>(phi - radius) < answer.phi;
            if (may_be_deepest || (phi > within * radius && phi < without * radius)) {
                takeApart(group);
            } else if (phi < 0.0f) {
                const model::Facing& whole = shell.groupFacings()[group];
                collect(shell.groupPositions().at(group), whole.normal.cast<double>(), static_cast<double>(whole.area),
                        static_cast<double>(phi), Vec3::Zero());
                answer.contacts += static_cast<int>(shell.groupPoints()[group + 1] - shell.groupPoints()[group]) - 1;
            }
        }
        if (batch.count > 0) evaluateBatch();
    }

    void screenGroups() noexcept {
        field.sampleMany(S, batch.all(batch.x), batch.all(batch.y), batch.all(batch.z),
                         {batch.read.data(), batch.count});
        answer.points_tested += static_cast<int>(batch.count);
        for (std::size_t i = 0; i < batch.count; ++i) {
            const std::uint32_t group = batch.index[i];
            if (!(batch.read[i] < shell.groupRadii()[group])) continue;
            workspace.near_[near_groups++] = {batch.read[i], group};
            groups_inside += batch.read[i] < 0.0f ? 1 : 0;
            if (!(batch.read[i] < least_in_group)) continue;
            least_in_group = batch.read[i];
            lowest_group = group;
        }
        batch.count = 0;
    }

    /// The deepest point, between the samples too.
    void refine() noexcept {
        if (deepest == kNoPoint) return;
        const Descent found = descend(field, S, shell, deepest, answer.phi);
        answer.points_tested += found.points_tested;
        const Vec3 p_F = R_FS * found.position + p_FS;
        const model::FieldSample s = field.sample(p_F, request.mode, -(R_FS * shell.points()[deepest].normal));
        if (!(s.phi < answer.phi)) return;
        answer.phi = s.phi;
        answer.closest_F = p_F;
        answer.normal_W = s.gradient;
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
        if (!ordered && !request.prove) return sweep();
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
            evaluate(node.point, node.normal, node.facing_area, bound, kNoPoint);
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
    if (request.refine) traversal.refine();
    QueryAnswer& answer = traversal.answer;
    if (request.load) answer.load = {traversal.R_WS * traversal.force, traversal.R_WS * traversal.moment};
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
