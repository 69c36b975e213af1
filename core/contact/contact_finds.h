#pragma once

#include <span>

#include "core/contact/contact_query.h"
#include "core/contact/rim_gradient.h"
#include "core/field/distance_field.h"

namespace passung::contact {

inline constexpr std::uint32_t kNoPoint = ~0u;
inline constexpr double kFacing = 0.8;  // cosine between a face's inward normal and φ's gradient

/// A shell in a field, both in the world.
struct ShellInField {
    const field::DistanceField& field;
    const shell::SphereTree& shell;
    const Pose& X_WF;
    const field::DistanceField::Placement S;  // the shell in the field
    const Mat3 R_WF;
    const Mat3 R_FS;
    const Vec3 p_FS;
    const Mat3 R_WS;
    const Vec3 p_WS;

    ShellInField(const field::DistanceField& f, const Pose& X_WF_, const shell::SphereTree& s, const Pose& X_FS,
                 const Pose& X_WS)
        : field(f),
          shell(s),
          X_WF(X_WF_),
          S(f.place(X_FS)),
          R_WF(X_WF_.q.toRotationMatrix()),
          R_FS(X_FS.q.toRotationMatrix()),
          p_FS(X_FS.p),
          R_WS(X_WS.q.toRotationMatrix()),
          p_WS(X_WS.p) {}

    Vec3 inField(const Vec3& position) const noexcept { return R_FS * position + p_FS; }
    Vec3 inWorld(const Vec3& position) const noexcept { return R_WS * position + p_WS; }
    /// φ and its gradient where the shell has the normal `normal`.
    field::FieldSample sample(const Vec3& p_F, field::FieldMode mode, const Vec3& normal) const noexcept {
        return field.sample(p_F, mode, -(R_FS * normal));
    }
};

/// What a request asks for, as the traversal goes about it.
struct QueryPlan {
    const QueryRequest& request;
    const bool ordered;  // best first
    const bool grouped;  // points that lie together may be taken as one
    const bool gradients;
    const bool facing;
    const double slack;  // sampleMany is off by at most this next to sample() [m]

    QueryPlan(const QueryRequest& r, const field::DistanceField& field)
        : request(r),
          ordered((r.max_nodes > 0 && !r.pauses) || r.search_below > r.collect_below),
          grouped(r.load && r.collect_below == 0.0 && !ordered && !r.prove && r.mode == field::FieldMode::Trilinear),
          gradients(r.gradients && !r.load),
          facing(r.facing && !(field.sheetOffset() > 0.0)),
          // No brick spans more: its cells are those asked for, or at most 1/72 of the longest side.
          slack(0x1p-20 * (field.bounds().size().norm() + 14.0 * field.cell())) {}

    bool pointwise() const noexcept { return request.mode != field::FieldMode::Trilinear; }
};

/// A sample of the shell.
struct ShellSample {
    Vec3 position, normal;  // in the shell's frame
    double area = 0.0;
    std::uint32_t point = kNoPoint;  // its place in the shell
};

/// What a traversal has found so far: the answer, the contacts, the load.
class ContactFinds {
public:
    ContactFinds(const ShellInField& place, const QueryPlan& plan, ContactManifold& manifold)
        : place_(place), plan_(plan), manifold_(manifold) {
        answer.phi = answer.lower_bound = plan.request.search_below;
    }

    /// A node whose points are all above this has nothing to find.
    double pruneAbove() const noexcept {
        return std::max(plan_.request.collect_below, std::min(plan_.request.search_below, answer.phi));
    }

    /// Whether a lower bound of `above` leaves something to prove.
    bool hasToProve(double above) const noexcept { return plan_.request.prove && above < answer.lower_bound; }
    void prove(double bound) noexcept { answer.lower_bound = std::min(answer.lower_bound, bound); }

    /// A sample that was read: the deepest so far, a contact, both or neither. True: a contact.
    bool take(const Vec3& p_F, const ShellSample& sample, const field::FieldSample& s) noexcept {
        if (s.phi < answer.phi) {
            answer.found = true;
            deepest_ = sample.point;
            setDeepest(p_F, s);
        }
        return s.phi < plan_.request.collect_below && collect(sample, s.phi, s.gradient);
    }

    /// False where the other surface does not face a face's sample.
    bool collect(const ShellSample& sample, double phi, const Vec3& gradient) noexcept {
        const auto& [position, normal, area, point] = sample;
        const bool of_face = plan_.facing && area > 0.0;
        if (of_face && !(-normal.dot(place_.R_FS.transpose() * gradient) > kFacing * gradient.norm())) return false;
        ++answer.contacts;
        if (plan_.request.load) {
            const Vec3 f = area * phi * normal;
            force_ += f;
            moment_ += position.cross(f);
            return true;
        }
        ContactPoint contact;
        contact.position = place_.inWorld(position);
        contact.gradient =
            place_.R_WF *
            (of_face ? withoutTurnOfRim(gradient, place_.R_FS * normal, phi, place_.field.finestCell()) : gradient);
        // A sample on an edge has no face of its own: the obstacle's face decides.
        contact.normal = area > 0.0 || contact.gradient.squaredNorm() < 1e-12 ? Vec3(place_.R_WS * normal)
                                                                              : Vec3(-contact.gradient.normalized());
        contact.phi = phi;
        contact.area = area;
        push(contact);
        return true;
    }

    /// The sphere of a node that is not looked into.
    void standIn(const shell::SphereNode& node, double bound) noexcept {
        if (!(bound < plan_.request.collect_below)) return;
        const Vec3 centre_F = place_.inField(node.centre);
        ContactPoint contact;
        contact.position = place_.X_WF * centre_F;
        contact.gradient = place_.R_WF * place_.sample(centre_F, plan_.request.mode, node.normal).gradient;
        contact.normal = -contact.gradient;
        contact.phi = bound;
        contact.radius = node.radius;
        push(contact);
    }

    /// The point of the shell that answer.phi belongs to; kNoPoint: none.
    std::uint32_t deepest() const noexcept { return deepest_; }

    /// Goes on from what an earlier call had found.
    void goOnFrom(const QueryAnswer& found, std::uint32_t deepest) noexcept {
        answer = found;
        answer.nodes_visited = answer.points_tested = answer.contacts = 0;
        deepest_ = deepest;
    }

    /// The deepest point, between the samples too.
    void refine() noexcept;
    /// The answer, in the world; of the shell's area `unproven_area` was neither proven nor evaluated.
    QueryAnswer told(double unproven_area) noexcept;

    QueryAnswer answer;

private:
    void push(const ContactPoint& contact) noexcept {
        if (!manifold_.tryPush(contact)) answer.manifold_full = true;
    }
    void setDeepest(const Vec3& p_F, const field::FieldSample& s) noexcept {
        answer.phi = s.phi;
        answer.closest_F = p_F;
        answer.normal_W = s.gradient;
    }

    const ShellInField& place_;
    const QueryPlan& plan_;
    ContactManifold& manifold_;
    std::uint32_t deepest_ = kNoPoint;                   // the point of the shell that answer.phi belongs to
    Vec3 force_ = Vec3::Zero(), moment_ = Vec3::Zero();  // of the load, in the shell's frame
};

}  // namespace passung::contact
