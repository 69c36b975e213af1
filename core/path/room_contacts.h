#pragma once

#include <memory>
#include <vector>

#include "core/closed_form/pose_solver.h"
#include "core/closed_form/solid.h"
#include "core/path/free_room.h"

namespace passung::path {

/// What a FreeRoom finds contacts with. Memory of earlier questions changes the time of an answer, not the answer.
class FreeRoom::Contacts {
public:
    virtual ~Contacts() = default;
    /// As FreeRoom::clearanceAt.
    virtual Nearness clearanceAt(const Pose& X, double within) = 0;
    /// The part is put at `X`.
    virtual void begin(const Pose& X) = 0;
    /// The hand goes on to `X_WH`, and the part after it; the poses that it goes through are added to `way`, whose last
    /// one is where it is.
    virtual void pull(const Pose& X_WH, std::vector<Pose>& way) = 0;
};

/// @pre all parts are shapes with a solid (inClosedForm).
std::unique_ptr<FreeRoom::Contacts> closedFormContacts(const scene::Part& moving,
                                                       const std::vector<RestingPart>& standing,
                                                       const motion::Metric& metric);
/// @pre all parts have clusters.
std::unique_ptr<FreeRoom::Contacts> surfaceContacts(const scene::Part& moving, const std::vector<RestingPart>& standing,
                                                    const motion::Metric& metric);

}  // namespace passung::path
