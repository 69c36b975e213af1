#pragma once

#include "study/measures/cues.h"
#include "study/plan/study_plan.h"

namespace passung::session {

/// What commands a condition's cues have.
inline measures::CueSettings cueSettings(const plan::Cues& cues) {
    return {cues.visual,     cues.vibrotactile, cues.audio,        cues.full_depth,
            cues.full_speed, cues.sound_decay,  cues.masking_noise};
}

}  // namespace passung::session
