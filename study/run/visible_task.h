#pragma once

#include "devices/simulated/hand_params.h"
#include "study/plan/study_plan.h"
#include "study/run/files/built_scenes.h"

namespace passung::run {

/// What the display shows of a condition's task to the first hand: parts where they are drawn, and what is asked for.
/// `parts`: of its scene, so that no file is read again; without them a mesh that is picked up is taken at its origin.
simulated::VisibleTask visibleTask(const plan::Condition& condition, BuiltParts parts = {});

/// What another hand than the first does meanwhile: it holds its part where that starts, or does its steps of an
/// assembly. @pre `hand` from 1 is one of the scene's
simulated::VisibleTask otherTask(const plan::Condition& condition, std::size_t hand, BuiltParts parts = {});

}  // namespace passung::run
