#include "core/tick/part_query.h"

#include <algorithm>

#include "core/tick/penalty.h"

namespace passung::tick {

namespace {

std::size_t nodesOf(const model::Part& part) { return part.shell ? part.shell->nodes().size() : 0; }
std::size_t pointsOf(const model::Part& part) { return part.shell ? part.shell->points().size() : 0; }

}  // namespace

PartQuery::PartQuery(const model::Part& field, const model::Part& shell, const PartQueryRequest& request)
    : field_(field),
      shell_(shell),
      request_(request),
      workspace_(std::max(nodesOf(field), nodesOf(shell))),
      manifold_(std::max(nodesOf(field) + pointsOf(field), nodesOf(shell) + pointsOf(shell))) {}

PartQueryResult PartQuery::oneWay(const model::Part& field, const model::Part& shell, const Pose& X_FS) {
    QueryRequest request{
        .search_below = request_.proximity, .max_nodes = request_.max_nodes, .mode = request_.mode, .prove = true};
    manifold_.clear();
    QueryAnswer answer = queryContacts(*field.field, Pose{}, *shell.shell, X_FS, request, workspace_, manifold_);
    PartQueryResult result;
    if (answer.quality < request_.quality) {
        request.max_nodes = 0;
        manifold_.clear();
        const int spent = answer.nodes_visited;
        answer = queryContacts(*field.field, Pose{}, *shell.shell, X_FS, request, workspace_, manifold_);
        answer.nodes_visited += spent;
        result.quality_overruled_budget = true;
    }
    result.signed_distance = answer.phi;
    result.quality = answer.quality;
    result.budget_reached = answer.budget_reached;
    result.beyond_proximity = !answer.found;
    result.nodes_visited = answer.nodes_visited;
    result.points_tested = answer.points_tested;

    const double cover = shell.shell->coverRadius() + shell.chord_error + field.field->sheetOffset();
    const double below = answer.phi - answer.lower_bound;
    if (answer.found) {
        result.closest = answer.closest_F;
        result.normal = answer.normal_W;
        const double above = field.field->errorBound(answer.closest_F, request_.mode);
        result.field_error_bound = std::max(below, above);
        result.error_bound = std::max(below, above) + cover;
    } else {
        result.field_error_bound = below;
        result.error_bound = below + cover;
    }
    model::ContactSpec contact;
    contact.variant = model::PenaltyVariant::AreaWeighted;
    contact.area_stiffness = request_.area_stiffness;
    result.wrench = penaltyWrench(contact, manifold_, X_FS.p);
    result.contacts = static_cast<int>(
        std::count_if(manifold_.begin(), manifold_.end(), [](const ContactPoint& c) { return c.phi < 0.0; }));
    return result;
}

PartQueryResult PartQuery::at(const Pose& X_FS) {
    PartQueryResult result = oneWay(field_, shell_, X_FS);
    if (!request_.two_way) return result;
    const Pose X_SF = X_FS.inverse();
    const PartQueryResult back = oneWay(shell_, field_, X_SF);
    // `back` is the wrench on FIELD about FIELD's origin in SHELL's axes: turn, move to SHELL's origin, change the
    // sign.
    const Vec3 force = -(X_FS.q * back.wrench.force);
    const Vec3 torque = -(X_FS.q * back.wrench.torque) + (-X_FS.p).cross(force);
    result.wrench = {0.5 * (result.wrench.force + force), 0.5 * (result.wrench.torque + torque)};
    result.contacts += back.contacts;
    result.nodes_visited += back.nodes_visited;
    result.points_tested += back.points_tested;
    result.quality = std::min(result.quality, back.quality);
    result.budget_reached = result.budget_reached || back.budget_reached;
    result.quality_overruled_budget = result.quality_overruled_budget || back.quality_overruled_budget;
    if (!back.beyond_proximity && back.signed_distance < result.signed_distance) {
        result.signed_distance = back.signed_distance;
        result.field_error_bound = back.field_error_bound;
        result.error_bound = back.error_bound;
        result.beyond_proximity = false;
        // The closest point of FIELD, carried to SHELL's surface along SHELL's own normal there.
        const Vec3 out_of_shell = X_FS.q * back.normal;
        result.closest = X_FS * back.closest - back.signed_distance * out_of_shell;
        result.normal = -out_of_shell;
    }
    return result;
}

}  // namespace passung::tick
