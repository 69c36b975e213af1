#include "core/contact/edge_search.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/contact/certificates.h"
#include "core/field/distance_field.h"

namespace passung::contact {

namespace {

constexpr std::size_t kStretches = 64;  // looked at together
constexpr std::size_t kStations = shell::EdgeCurves::kStretchStations + 2;
constexpr double kInset = 0.05;  // of the way between the ends: no nearer to one of them is looked
constexpr double kBeside = 2.0;  // per finest cell: trilinear values round off a ridge as far as it cuts cells

/// φ at one place of a curve.
struct Spot {
    double t;  // number of the vertex, and how far on to the next
    double phi;
    double slope;   // dφ/dt
    Vec3 gradient;  // in the field's frame, as is `way`
    Vec3 way;       // dp/dt
    Vec3 p_S;
};

/// State of one search.
struct EdgeSearch {
    const field::DistanceField& field;
    const shell::EdgeCurves& edges;
    const Pose& X_WF;
    const field::DistanceField::Placement S;
    const Mat3 R_WF, R_FS, R_WS;
    const Vec3 p_FS, p_WS;
    const QueryRequest& request;
    const double settled;  // what a further step may still find [m]
    ContactManifold& manifold;
    Certificates* const known;
    QueryAnswer answer;
    double low = 0.0, high = 0.0;  // between which t's the search is

    EdgeSearch(const field::DistanceField& f, const Pose& X_WF_, const shell::EdgeCurves& e, const Pose& X_FS,
               const Pose& X_WS, const QueryRequest& r, ContactManifold& m, Certificates* k)
        : field(f),
          edges(e),
          X_WF(X_WF_),
          S(f.place(X_FS)),
          R_WF(X_WF_.q.toRotationMatrix()),
          R_FS(X_FS.q.toRotationMatrix()),
          R_WS(X_WS.q.toRotationMatrix()),
          p_FS(X_FS.p),
          p_WS(X_WS.p),
          request(r),
          settled(kAlong * f.cell()),
          manifold(m),
          known(r.prove ? nullptr : k) {
        answer.phi = answer.lower_bound = request.search_below;
    }

    double pruneAbove() const noexcept {
        return std::max(request.collect_below, std::min(request.search_below, answer.phi));
    }

    /// From the stretch `first` on, `most` of them; the first one that is left.
    std::uint32_t run(std::uint32_t first, std::size_t most) noexcept {
        const auto stretches = edges.stretches();
        const auto& at = edges.centres();
        std::array<float, kStretches> x, y, z, bound;
        std::array<std::uint32_t, kStretches> which;
        std::uint32_t next = first;
        while (next < stretches.size() && most > 0) {
            std::size_t count = 0;
            for (; next < stretches.size() && count < std::min(kStretches, most); ++next) {
                if (isPassed(next)) continue;
                x[count] = at.x(next, 1)[0];
                y[count] = at.y(next, 1)[0];
                z[count] = at.z(next, 1)[0];
                which[count++] = next;
            }
            field.lowerBounds(S, {x.data(), count}, {y.data(), count}, {z.data(), count}, {bound.data(), count});
            answer.nodes_visited += static_cast<int>(count);
            most -= count;
            for (std::size_t i = 0; i < count; ++i) {
                const auto least = static_cast<double>(bound[i] - edges.radii()[which[i]]);
                if (least < pruneAbove())
                    scan(stretches[which[i]]);
                else if (known != nullptr)
                    known->note(which[i], least);
            }
        }
        return next;
    }

    /// True if earlier looks have proven that a stretch holds nothing that is asked for.
    bool isPassed(std::uint32_t stretch) noexcept {
        return known != nullptr && known->above(stretch, edges.centres().at(stretch),
                                                static_cast<double>(edges.radii()[stretch]), pruneAbove());
    }

    /// Looks for stations that are lower than those beside them.
    void scan(const shell::EdgeCurves::Stretch& stretch) noexcept {
        const std::uint32_t before = stretch.begins ? 0 : 1, after = stretch.ends ? 0 : 1;
        const std::uint32_t first = stretch.first - before, count = stretch.count + before + after;
        const auto& at = edges.positions();
        std::array<float, kStations> phi;
        field.sampleMany(S, at.x(first, count), at.y(first, count), at.z(first, count), {phi.data(), count});
        answer.points_tested += static_cast<int>(count);
        for (std::uint32_t i = before; i < before + stretch.count; ++i) {
            const bool left = i > 0, right = i + 1 < count;
            if ((left && !(phi[i] < phi[i - 1])) || (right && !(phi[i] <= phi[i + 1]))) continue;
            const std::uint32_t station = first + i;
            // Overlap deeper than the stations are apart is seen by the samples.
            if (phi[i] < -edges.gaps()[station]) continue;
            // φ is 1-Lipschitz: between two stations it is no lower than this.
            const auto lowest = [&](std::uint32_t k) {
                return 0.5 * static_cast<double>(phi[k] + phi[k + 1] - edges.gaps()[first + k]);
            };
            const bool search_left = left && lowest(i - 1) < pruneAbove();
            const bool search_right = right && lowest(i) < pruneAbove();
            if (search_left || search_right) searchAround(station, search_left, search_right);
        }
    }

    /// φ at `t`, its slope along the piece of the curve before or after.
    Spot spotAt(double t, bool after) noexcept {
        ++answer.points_tested;
        const double whole = std::floor(t);
        const auto k = static_cast<std::size_t>(whole) - (after || whole < t ? 0u : 1u);
        const Vec3& p = edges.vertices()[k];
        const Vec3 way = edges.vertices()[k + 1] - p;
        Spot spot;
        spot.t = t;
        spot.p_S = p + (t - static_cast<double>(k)) * way;
        const field::FieldSample sample = field.sample(R_FS * spot.p_S + p_FS, request.mode);
        spot.phi = sample.phi;
        spot.gradient = sample.gradient;
        spot.way = R_FS * way;
        spot.slope = sample.gradient.dot(spot.way);
        return spot;
    }

    /// A station that is lower than those beside it; at a corner there is one, and the shell has a sample of its own.
    void searchAround(std::uint32_t station, bool left, bool right) noexcept {
        const double t = edges.stations()[station];
        low = left ? edges.stations()[station - 1] : t;
        high = right ? edges.stations()[station + 1] : t;
        const Spot after = spotAt(t, right), before = spotAt(t, !left);
        const bool goes_on = right && after.slope < 0.0, goes_back = left && before.slope > 0.0;
        if (goes_on) searchBetween(after, spotAt(high, false));
        if (goes_back) searchBetween(spotAt(low, true), before);
        if (left && right && !goes_on && !goes_back) take(after);
    }

    /// φ descends from `a` towards `b`, from `b` towards `a`, or from one of them and is not lower at the other.
    void searchBetween(Spot a, Spot b) noexcept {
        Spot best = a.phi < b.phi ? a : b;
        for (int step = 0; step < kEdgeSteps; ++step) {
            double t = 0.5 * (a.t + b.t);
            if (a.slope < 0.0 && b.slope > 0.0) {
                t = (b.phi - a.phi + a.slope * a.t - b.slope * b.t) / (a.slope - b.slope);
                const double least = a.phi + a.slope * (t - a.t);
                if (least > best.phi - settled || least >= pruneAbove()) break;
                const double inset = kInset * (b.t - a.t);
                t = std::clamp(t, a.t + inset, b.t - inset);
            }
            const Spot m = spotAt(t, true);
            if (m.phi < best.phi) best = m;
            // The side that is kept goes down from its end into the bracket.
            const bool on = m.slope < 0.0 ? m.phi <= a.phi || !(a.slope < 0.0) : !(m.phi <= b.phi || !(b.slope > 0.0));
            (on ? a : b) = m;
        }
        if (best.phi < pruneAbove()) take(best);
    }

    /// Of two places beside `spot`, beyond the cells that the ridge may cut, the mixture of gradients that is square to
    /// the edge.
    Vec3 mixtureAround(const Spot& spot) noexcept {
        const double dt = kBeside * field.finestCell() / spot.way.norm();
        const Spot a = spotAt(std::max(low, spot.t - dt), true), b = spotAt(std::min(high, spot.t + dt), false);
        const double down = a.gradient.dot(spot.way), up = b.gradient.dot(spot.way);
        if (!(down < 0.0 && up > 0.0)) return spot.gradient;
        return (up * a.gradient - down * b.gradient) / (up - down);
    }

    void take(const Spot& spot) noexcept {
        if (spot.phi < answer.phi) {
            answer.found = true;
            answer.phi = answer.lower_bound = spot.phi;
            answer.closest_F = R_FS * spot.p_S + p_FS;
            answer.normal_W = R_WF * spot.gradient;
        }
        if (!(spot.phi < request.collect_below)) return;
        const Vec3 gradient = mixtureAround(spot);
        ++answer.contacts;
        ContactPoint contact;
        contact.position = R_WS * spot.p_S + p_WS;
        contact.gradient = R_WF * gradient;
        const double length = gradient.norm();
        contact.normal = length > 0.0 ? Vec3(-contact.gradient / length) : Vec3(Vec3::Zero());
        contact.phi = spot.phi;
        if (!manifold.tryPush(contact)) answer.manifold_full = true;
    }
};

}  // namespace

QueryAnswer searchEdges(const field::DistanceField& field, const Pose& X_WF, const shell::EdgeCurves& edges,
                        const Pose& X_WS, const QueryRequest& request, ContactManifold& manifold, Certificates* known,
                        EdgePause* pause) noexcept {
    const Pose X_FS = X_WF.inverse() * X_WS;
    EdgeSearch search(field, X_WF, edges, X_FS, X_WS, request, manifold, known);
    const bool smooth = request.mode == field::FieldMode::Trilinear || request.mode == field::FieldMode::Cubic;
    const bool sharp = field.finestCell() < field.cell();
    QueryAnswer& answer = search.answer;
    if (smooth && sharp && (request.max_nodes == 0 || pause != nullptr)) {
        if (known != nullptr) known->begin(X_FS);
        std::uint32_t first = 0;
        if (pause != nullptr && pause->open) {
            first = pause->next;
            answer = pause->answer;
            answer.nodes_visited = answer.points_tested = answer.contacts = 0;
            answer.paused = answer.budget_reached = pause->open = false;
        }
        const auto budget = static_cast<std::size_t>(std::max(1, request.max_nodes));
        const std::uint32_t left = search.run(first, request.max_nodes == 0 ? edges.stretches().size() : budget);
        if (left < edges.stretches().size()) {
            answer.paused = answer.budget_reached = true;
            *pause = {true, left, answer};
            return answer;
        }
    }
    if (answer.found) {
        answer.closest_W = X_WF * answer.closest_F;
        if (answer.normal_W.squaredNorm() > 0.0) answer.normal_W.normalize();
    }
    return answer;
}

}  // namespace passung::contact
