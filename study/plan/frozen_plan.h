#pragma once

#include <memory>
#include <utility>

#include "study/plan/study_plan.h"

namespace passung::plan {

/// A plan as one database runs it: with the stable stiffness and the accuracy that it keeps, the seed of its sessions
/// and the questionnaires in a session's language. A StudyPlan is its draft; run::freeze() makes this of it, and
/// nothing else but tests.
class FrozenPlan {
public:
    explicit FrozenPlan(StudyPlan plan) : plan_(std::make_shared<const StudyPlan>(std::move(plan))) {}

    const StudyPlan& operator*() const { return *plan_; }
    const StudyPlan* operator->() const { return plan_.get(); }

private:
    std::shared_ptr<const StudyPlan> plan_;  // shared_ptr: large, const, and kept by whoever runs it
};

}  // namespace passung::plan
