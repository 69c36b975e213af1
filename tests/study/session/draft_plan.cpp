#include "study/session/session_setup.h"

// A session takes the plan as a database runs it; with FAULTS, the draft: draft_plan.cmake wants an error at each of
// these lines.

namespace passung::session {

inline SessionSetup setupOf(const plan::FrozenPlan& plan) { return {plan, {}, "P001"}; }

#ifdef FAULTS
inline SessionSetup setupOf(const plan::StudyPlan& draft) { return {draft, {}, "P001"}; }  // FAULT: takes a draft
inline void turn(plan::FrozenPlan& it, const plan::StudyPlan& draft) { it = draft; }       // FAULT: turns into it
inline void change(plan::FrozenPlan& plan) { plan->seed = 1; }                             // FAULT: changes it
#endif

}  // namespace passung::session
