#include "core/contact/contact_query.h"

#include <algorithm>
#include <array>
#include <limits>

#include "core/contact/certificates.h"
#include "core/contact/contact_finds.h"
#include "core/contact/surface_descent.h"

namespace passung::contact {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kBatch = 64;  // nodes or points that are looked at together
constexpr double kSettled = 48.0;   // groups in contact: from here on their errors level out, and some are taken whole

/// Places in the shell's frame, one after the other, though they are parted in memory.
struct Batch {
    std::array<float, kBatch> x, y, z, radius, read;
    std::array<std::uint32_t, kBatch> index, owner;  // owner: the leaf
    std::size_t count = 0;

    void append(const shell::FloatPositions& from, std::uint32_t first, std::size_t n,
                std::uint32_t of = kNoPoint) noexcept {
        std::copy_n(from.x(first, n).data(), n, x.data() + count);
        std::copy_n(from.y(first, n).data(), n, y.data() + count);
        std::copy_n(from.z(first, n).data(), n, z.data() + count);
        for (std::uint32_t i = 0; i < n; ++i) index[count + i] = first + i;
        std::fill_n(owner.begin() + static_cast<std::ptrdiff_t>(count), n, of);
        count += n;
    }
    Vec3 position(std::size_t i) const noexcept {
        return {static_cast<double>(x[i]), static_cast<double>(y[i]), static_cast<double>(z[i])};
    }
    std::span<const float> all(const std::array<float, kBatch>& axis) const noexcept { return {axis.data(), count}; }
};

}  // namespace

void ContactFinds::refine() noexcept {
    if (deepest_ == kNoPoint) return;
    const Descent found = descend(place_.field, place_.S, place_.shell, deepest_, answer.phi);
    answer.points_tested += found.points_tested;
    const Vec3 p_F = place_.inField(found.position);
    const field::FieldSample s = place_.sample(p_F, plan_.request.mode, place_.shell.points()[deepest_].normal);
    if (s.phi < answer.phi) setDeepest(p_F, s);
}

QueryAnswer ContactFinds::told(double unproven_area) noexcept {
    if (plan_.request.load) answer.load = {place_.R_WS * force_, place_.R_WS * moment_};
    if (answer.found) {
        answer.closest_W = place_.X_WF * answer.closest_F;
        const double length = answer.normal_W.norm();
        answer.normal_W = length > 0.0 ? Vec3(place_.R_WF * (answer.normal_W / length)) : Vec3(Vec3::Zero());
    }
    // Rounded sums of areas may exceed the total by a bit.
    const double area = place_.shell.totalArea();
    if (area > 0.0) answer.quality = std::max(0.0, 1.0 - unproven_area / area);
    return answer;
}

/// The way through one shell's tree; the steps of queryContacts.
struct Traversal {
    /// Nodes that wait, in the memory of the workspace.
    class NodeQueue {
    public:
        NodeQueue(std::vector<QueryWorkspace::Entry>& heap, bool ordered) : heap_(heap), ordered_(ordered) {}
        bool empty() const noexcept { return waiting_ == 0; }
        std::size_t size() const noexcept { return waiting_; }
        std::uint32_t next() const noexcept { return (ordered_ ? heap_.front() : heap_[waiting_ - 1]).node; }
        void push(const QueryWorkspace::Entry& entry) noexcept {
            heap_[waiting_++] = entry;
            if (ordered_) std::push_heap(heap_.begin(), end(), later);
        }
        QueryWorkspace::Entry pop() noexcept {
            if (ordered_) std::pop_heap(heap_.begin(), end(), later);
            return heap_[--waiting_];
        }

        /// What was left there.
        void restore(std::size_t waiting) noexcept { waiting_ = waiting; }

    private:
        static bool later(const QueryWorkspace::Entry& a, const QueryWorkspace::Entry& b) noexcept {
            return a.order > b.order || (a.order == b.order && a.node > b.node);
        }
        std::vector<QueryWorkspace::Entry>::iterator end() noexcept {
            return heap_.begin() + static_cast<std::ptrdiff_t>(waiting_);
        }
        std::vector<QueryWorkspace::Entry>& heap_;
        std::size_t waiting_ = 0;
        const bool ordered_;
    };

    /// Groups of points that lie together, as far as they are near.
    struct NearGroups {
        std::size_t count = 0;  // in the workspace
        int inside = 0;
        float least = std::numeric_limits<float>::infinity();
        std::uint32_t lowest = kNoPoint;
    };

    const ShellInField& place;
    const QueryPlan& plan;
    ContactFinds& finds;
    QueryWorkspace& workspace;
    const QueryRequest& request;
    const field::DistanceField& field;
    const shell::SphereTree& shell;
    Certificates* const known;
    NodeQueue queue;
    NearGroups groups;
    Batch batch;
    double unproven_area = 0.0;
    double waiting_area = 0.0;    // of nodes in the queue, where a least quality is asked for [m²]
    double expected = kInfinity;  // the search will find φ no farther than this

    Traversal(const ShellInField& in, const QueryPlan& p, ContactFinds& f, QueryWorkspace& w, Certificates* k)
        : place(in),
          plan(p),
          finds(f),
          workspace(w),
          request(p.request),
          field(in.field),
          shell(in.shell),
          known(p.pointwise() || p.grouped || p.request.prove ? nullptr : k),
          queue(w.heap_, p.ordered) {}

    /// What waits is more than the quality that is asked for leaves.
    bool needsMore() const noexcept {
        return request.quality > 0.0 && waiting_area > (1.0 - request.quality) * shell.totalArea();
    }
    void wait(const QueryWorkspace::Entry& entry) noexcept {
        queue.push(entry);
        if (request.quality > 0.0) waiting_area += shell.nodes()[entry.node].area;
    }
    QueryWorkspace::Entry takeNext() noexcept {
        const QueryWorkspace::Entry entry = queue.pop();
        if (request.quality > 0.0) waiting_area -= shell.nodes()[entry.node].area;
        return entry;
    }

    bool exceedsBudget(const shell::SphereNode& node) noexcept {
        int children = 0;
        if (!node.leaf)
            for (std::uint32_t i = node.first; i < node.first + node.count; ++i) children += isPassed(i) ? 0 : 1;
        return request.max_nodes > 0 && finds.answer.nodes_visited + children > request.max_nodes;
    }

    /// Some nodes that follow each other; `above`: the bound of their parent holds for their points too.
    void push(std::uint32_t begin, std::uint32_t count, double above) noexcept {
        for (std::uint32_t node = begin; node < begin + count; ++node)
            if (!isPassed(node)) batch.append(shell.centres(), node, 1);
        field.lowerBounds(place.S, batch.all(batch.x), batch.all(batch.y), batch.all(batch.z),
                          {batch.read.data(), batch.count});
        finds.answer.nodes_visited += static_cast<int>(batch.count);
        for (std::size_t i = 0; i < batch.count; ++i) {
            const std::uint32_t node = batch.index[i];
            const double bound = std::max(above, static_cast<double>(batch.read[i]) - shell.nodes()[node].radius);
            if (bound >= finds.pruneAbove()) {
                if (known != nullptr) known->note(node, bound);
                continue;
            }
            const bool first =
                request.max_nodes > 0 && !request.spheres && !request.pauses && node < shell.roots().size();
            wait({bound, first ? -kInfinity : bound, node});
        }
        batch.count = 0;
    }

    /// One sample; `above`: a lower bound of φ there that is already known.
    void evaluate(const ShellSample& sample, double above) noexcept {
        ++finds.answer.points_tested;
        const Vec3 p_F = place.inField(sample.position);
        if (finds.hasToProve(above)) finds.prove(std::max(above, field.lowerBound(p_F)));
        finds.take(p_F, sample, place.sample(p_F, request.mode, sample.normal));
    }

    /// True if earlier looks have proven that a node holds nothing that is asked for.
    bool isPassed(std::uint32_t node) noexcept {
        return known != nullptr && !request.every_node &&
               known->above(node, shell.nodes()[node].centre, shell.nodes()[node].radius,
                            std::max(request.collect_below, std::min(expected, finds.pruneAbove())) + 2.0 * plan.slack);
    }

    /// True if what was read of a leaf earlier says so of its points, and of no more: what could be proven of it now
    /// would be, were it read.
    bool isLeafPassed(std::uint32_t leaf) noexcept {
        if (known == nullptr) return false;
        const shell::SphereNode& node = shell.nodes()[leaf];
        const double provable = request.every_node ? kInfinity : known->provableFrom(finds.pruneAbove());
        if (!known->readsWithin(leaf, node.centre, node.radius, finds.pruneAbove() + 2.0 * plan.slack, provable))
            return false;
        finds.answer.points_spared += static_cast<int>(node.count);
        return true;
    }

    /// What was deepest in the last look tells how deep this one gets at least.
    void expect() noexcept {
        known->begin(place.S.X_FS);
        if (workspace.pause_.open || !plan.ordered || known->deepest == Certificates::kNone) return;
        const Vec3 p_F = place.inField(shell.points()[known->deepest].position);
        expected = field.sample(p_F, request.mode).phi;
        ++finds.answer.points_tested;
    }

    /// Proves of the leaves in the batch, as they were read, what they do not hold.
    void certify() noexcept {
        const double limit = finds.pruneAbove();
        for (std::size_t first = 0, end = 0; first < batch.count; first = end) {
            const std::uint32_t node = batch.owner[first];
            float least = batch.read[first];
            for (end = first + 1; end < batch.count && batch.owner[end] == node; ++end)
                least = std::min(least, batch.read[end]);
            known->noteRead(node, static_cast<double>(least));
            if (request.every_node) continue;
            const shell::SphereNode& leaf = shell.nodes()[node];
            if (!known->paysToProve(node, leaf.centre, leaf.radius, static_cast<double>(least), limit)) continue;
            known->noteProof(node, leastBound(leaf), limit);
        }
    }

    /// All points of a leaf.
    void evaluateLeaf(std::uint32_t node, double above) noexcept {
        const shell::SphereNode& leaf = shell.nodes()[node];
        if (plan.pointwise()) {
            for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) {
                const shell::SurfacePoint& point = shell.points()[i];
                evaluate({point.position, point.normal, point.area, i}, above);
            }
            return;
        }
        batch.append(shell.positions(), leaf.first, leaf.count, node);
        evaluateBatch();
        if (finds.hasToProve(above)) finds.prove(std::max(above, leastBound(leaf)));
    }

    /// No point of the leaf has a true φ below this.
    double leastBound(const shell::SphereNode& leaf) const noexcept {
        std::array<float, shell::SphereTree::kLeafPoints> low;
        const auto& at = shell.positions();
        field.lowerBounds(place.S, at.x(leaf.first, leaf.count), at.y(leaf.first, leaf.count),
                          at.z(leaf.first, leaf.count), {low.data(), leaf.count});
        return static_cast<double>(*std::min_element(low.begin(), low.begin() + leaf.count));
    }

    /// The points of the batch; in FieldMode::Trilinear.
    void evaluateBatch() noexcept {
        field.sampleMany(place.S, batch.all(batch.x), batch.all(batch.y), batch.all(batch.z),
                         {batch.read.data(), batch.count});
        finds.answer.points_tested += static_cast<int>(batch.count);
        const double read_off = plan.gradients ? plan.slack : 0.0;
        // Those that matter, without a jump, first.
        const auto limit =
            static_cast<float>(std::max(request.collect_below + read_off, finds.answer.phi + plan.slack));
        std::array<std::uint32_t, kBatch> near;
        std::size_t nears = 0;
        float least = std::numeric_limits<float>::infinity();
        for (std::uint32_t i = 0; i < batch.count; ++i) {
            near[nears] = i;
            nears += batch.read[i] <= limit ? 1 : 0;
            least = std::min(least, batch.read[i]);
        }
        // Only what is not surely above another is read exactly.
        const double lowest = std::min(static_cast<double>(least) + 2.0 * plan.slack, finds.answer.phi + plan.slack);
        const double every = request.every_below - read_off;
        const bool thinned = plan.gradients && every < request.collect_below;
        std::size_t rest = 0;
        for (std::size_t k = 0; k < nears; ++k) {
            const double read = static_cast<double>(batch.read[near[k]]);
            if (thinned && !(read < std::max(every, lowest))) {
                near[rest++] = near[k];
                continue;
            }
            const ShellSample sample = sampleAt(near[k]);
            const bool exactly = plan.gradients || (!request.load && !(sample.area > 0.0));
            if (read < lowest || (exactly && read < request.collect_below + read_off)) {
                const Vec3 p_F = place.inField(sample.position);
                finds.take(p_F, sample, field.sample(p_F, request.mode));
            } else if (read < request.collect_below) {
                finds.collect(sample, read, Vec3::Zero());
            }
        }
        if (rest > 0) takeNearest({near.data(), rest});
        if (known != nullptr) certify();
        batch.count = 0;
    }

    ShellSample sampleAt(std::uint32_t place_in_batch) const noexcept {
        const std::uint32_t point = batch.index[place_in_batch];
        const shell::Facing& weight = shell.facings()[point];
        return {batch.position(place_in_batch), weight.normal.cast<double>(), static_cast<double>(weight.area), point};
    }

    /// Of places in the batch, all of one leaf, in each octant of the normal the nearest that is a contact: the nearest
    /// first.
    void takeNearestOf(std::span<const std::uint32_t> leaf) noexcept {
        constexpr std::uint32_t kNoPlace = kBatch;
        const auto comesBefore = [&](std::uint32_t a, std::uint32_t b) {
            return batch.read[a] < batch.read[b] || (batch.read[a] == batch.read[b] && a < b);
        };
        std::array<std::uint8_t, kBatch> octant;
        std::array<std::uint32_t, 8> next;  // of each octant
        next.fill(kNoPlace);
        for (const std::uint32_t i : leaf) {
            const Eigen::Vector3f& n = shell.facings()[batch.index[i]].normal;
            octant[i] =
                static_cast<std::uint8_t>((n.x() < 0.0f ? 1 : 0) | (n.y() < 0.0f ? 2 : 0) | (n.z() < 0.0f ? 4 : 0));
            std::uint32_t& first = next[octant[i]];
            if (first == kNoPlace || comesBefore(i, first)) first = i;
        }
        for (;;) {
            std::uint32_t i = kNoPlace;
            for (const std::uint32_t other : next)
                if (other != kNoPlace && (i == kNoPlace || comesBefore(other, i))) i = other;
            if (i == kNoPlace) return;
            const ShellSample sample = sampleAt(i);
            const Vec3 p_F = place.inField(sample.position);
            std::uint32_t& then = next[octant[i]];
            then = kNoPlace;
            if (finds.take(p_F, sample, field.sample(p_F, request.mode))) continue;
            for (const std::uint32_t other : leaf)
                if (octant[other] == octant[i] && comesBefore(i, other) &&
                    (then == kNoPlace || comesBefore(other, then)))
                    then = other;
        }
    }

    /// Of places in the batch, leaf after leaf.
    void takeNearest(std::span<const std::uint32_t> near) noexcept {
        for (std::size_t first = 0; first < near.size();) {
            std::size_t end = first;
            while (end < near.size() && batch.owner[near[end]] == batch.owner[near[first]]) ++end;
            takeNearestOf(near.subspan(first, end - first));
            first = end;
        }
    }

    /// All nodes level by level, and then the leaves that are left: many together are read several times as fast.
    /// For a limit that stays the same; no budget.
    void sweep() noexcept {
        std::vector<QueryWorkspace::Entry>& heap = workspace.heap_;
        std::size_t next = 0, end = 0, leaves = heap.size();  // nodes wait from the front, leaves from the back
        const auto screen = [&] {
            field.lowerBounds(place.S, batch.all(batch.x), batch.all(batch.y), batch.all(batch.z),
                              {batch.read.data(), batch.count});
            finds.answer.nodes_visited += static_cast<int>(batch.count);
            for (std::size_t i = 0; i < batch.count; ++i) {
                const std::uint32_t node = batch.index[i];
                const double bound = static_cast<double>(batch.read[i]) - static_cast<double>(shell.radii()[node]);
                if (bound >= request.collect_below) {
                    if (known != nullptr) known->note(node, bound);
                    continue;
                }
                heap[shell.nodes()[node].leaf ? --leaves : end++] = {bound, bound, node};
            }
            batch.count = 0;
        };
        const auto appendNodes = [&](std::uint32_t begin, std::uint32_t count) {
            for (std::uint32_t node = begin; node < begin + count; ++node)
                if (!isPassed(node)) batch.append(shell.centres(), node, 1);
        };
        appendNodes(0, static_cast<std::uint32_t>(shell.roots().size()));
        for (screen(); next < end; screen())
            while (next < end && batch.count + shell::SphereTree::kChildren <= kBatch) {
                const shell::SphereNode& node = shell.nodes()[heap[next++].node];
                appendNodes(node.first, node.count);
            }
        if (plan.grouped) return sweepGroups(leaves);
        while (leaves < heap.size()) {
            if (plan.pointwise()) {
                evaluateLeaf(heap[leaves].node, heap[leaves].bound);
                ++leaves;
                continue;
            }
            // Those that are passed take their room, so that the others are looked at in the same company.
            for (std::uint32_t room = 0; leaves < heap.size(); ++leaves) {
                const std::uint32_t node = heap[leaves].node;
                const shell::SphereNode& leaf = shell.nodes()[node];
                if (room + leaf.count > kBatch) break;
                if (isPassed(node)) continue;
                room += leaf.count;
                if (!isLeafPassed(node)) batch.append(shell.positions(), leaf.first, leaf.count, node);
            }
            if (batch.count > 0) evaluateBatch();
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
                const shell::SphereNode& node = shell.nodes()[heap[leaf].node];
                const std::uint32_t count =
                    (node.count + shell::SphereTree::kGroupPoints - 1) / shell::SphereTree::kGroupPoints;
                if (batch.count + count > kBatch) break;
                batch.append(shell.groupPositions(), node.first_group, count);
            }
            screenGroups();
        }
        const double share = kSettled / std::max(1, groups.inside);
        const auto within = static_cast<float>(-share), without = static_cast<float>(std::min(1.0, share));
        const auto takeApart = [&](std::uint32_t group) {
            const std::uint32_t first = shell.groupPoints()[group], count = shell.groupPoints()[group + 1] - first;
            if (batch.count + count > kBatch) evaluateBatch();
            batch.append(shell.positions(), first, count);
        };
        if (groups.lowest != kNoPoint) {
            takeApart(groups.lowest);
            evaluateBatch();
        }
        for (std::size_t i = 0; i < groups.count; ++i) {
            const auto& [phi, group] = workspace.near_[i];
            if (group == groups.lowest) continue;
            const float radius = shell.groupRadii()[group];
            const bool may_be_deepest = static_cast<double>(phi - radius) < finds.answer.phi;
            if (may_be_deepest || (phi > within * radius && phi < without * radius)) {
                takeApart(group);
            } else if (phi < 0.0f) {
                const shell::Facing& whole = shell.groupFacings()[group];
                finds.collect(
                    {shell.groupPositions().at(group), whole.normal.cast<double>(), static_cast<double>(whole.area)},
                    static_cast<double>(phi), Vec3::Zero());
                finds.answer.contacts +=
                    static_cast<int>(shell.groupPoints()[group + 1] - shell.groupPoints()[group]) - 1;
            }
        }
        if (batch.count > 0) evaluateBatch();
    }

    void screenGroups() noexcept {
        field.sampleMany(place.S, batch.all(batch.x), batch.all(batch.y), batch.all(batch.z),
                         {batch.read.data(), batch.count});
        finds.answer.points_tested += static_cast<int>(batch.count);
        for (std::size_t i = 0; i < batch.count; ++i) {
            const std::uint32_t group = batch.index[i];
            if (!(batch.read[i] < shell.groupRadii()[group])) continue;
            workspace.near_[groups.count++] = {batch.read[i], group};
            groups.inside += batch.read[i] < 0.0f ? 1 : 0;
            if (!(batch.read[i] < groups.least)) continue;
            groups.least = batch.read[i];
            groups.lowest = group;
        }
        batch.count = 0;
    }

    void run() noexcept {
        if (!plan.ordered && !request.prove && !request.pauses) return sweep();
        if (workspace.pause_.open)
            resume();
        else
            push(0, static_cast<std::uint32_t>(shell.roots().size()), -kInfinity);
        while (!queue.empty()) {
            const bool ends = request.max_nodes > 0 && exceedsBudget(shell.nodes()[queue.next()]);
            if (ends && (request.pauses || !needsMore())) {
                finds.answer.budget_reached = true;
                if (!request.pauses) break;
                if (finds.answer.nodes_visited > 0) return pause();
            }
            const QueryWorkspace::Entry entry = takeNext();
            const shell::SphereNode& node = shell.nodes()[entry.node];
            if (entry.bound >= finds.pruneAbove()) continue;
            if (node.leaf) {
                if (!isPassed(entry.node) && !isLeafPassed(entry.node)) evaluateLeaf(entry.node, entry.bound);
                continue;
            }
            push(node.first, node.count, entry.bound);
        }
        while (!queue.empty()) standIn(queue.pop());  // the budget ended
    }

    void pause() noexcept {
        finds.answer.paused = true;
        workspace.pause_ = {true, queue.size(), finds.answer, finds.deepest(), expected};
    }

    void resume() noexcept {
        const QueryWorkspace::Pause& was = workspace.pause_;
        finds.goOnFrom(was.answer, was.deepest);
        finds.answer.paused = finds.answer.budget_reached = false;
        queue.restore(was.waiting);
        expected = was.expected;
        workspace.pause_.open = false;
    }

    /// One point and the sphere of a node that is not looked into.
    void standIn(const QueryWorkspace::Entry& entry) noexcept {
        const shell::SphereNode& node = shell.nodes()[entry.node];
        if (entry.bound >= finds.pruneAbove()) return;
        evaluate({node.point, node.normal, node.facing_area}, entry.bound);
        if (request.spheres) finds.standIn(node, entry.bound);
        finds.prove(entry.bound);
        unproven_area += node.area;
    }
};

QueryAnswer queryContacts(const field::DistanceField& field, const Pose& X_WF, const shell::SphereTree& shell,
                          const Pose& X_WS, const QueryRequest& request, QueryWorkspace& workspace,
                          ContactManifold& manifold, Certificates* known) noexcept {
    const ShellInField place(field, X_WF, shell, X_WF.inverse() * X_WS, X_WS);
    const QueryPlan plan(request, field);
    ContactFinds finds(place, plan, manifold);
    Traversal traversal(place, plan, finds, workspace, known);
    if (traversal.known != nullptr) traversal.expect();
    traversal.run();
    if (finds.answer.paused) return finds.answer;
    if (traversal.known != nullptr && finds.deepest() != kNoPoint) known->deepest = finds.deepest();
    if (request.refine) finds.refine();
    return finds.told(traversal.unproven_area);
}

}  // namespace passung::contact
