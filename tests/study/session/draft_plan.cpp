#include "study/session/session_setup.h"

// A session takes the plan as a database runs it; with FAULTS, the draft: draft_plan.cmake wants an error at each of
// these lines.

namespace passung::session {

inline SessionSetup setupOf(const protocol::FrozenPlan& plan) { return {plan, {}, "P001"}; }

#ifdef FAULTS
inline SessionSetup setupOf(const protocol::StudyPlan& draft) { return {draft, {}, "P001"}; }  // FAULT: takes a draft
inline void turn(protocol::FrozenPlan& it, const protocol::StudyPlan& draft) { it = draft; }   // FAULT: turns into it
inline void change(protocol::FrozenPlan& plan) { plan->seed = 1; }                             // FAULT: changes it
#endif

}  // namespace passung::session
