#pragma once

#include <array>

#include "core/surface/nearest_faces.h"
#include "core/tick/hand_model.h"
#include "core/tick/proxy_state.h"
#include "core/tick/tick_frame.h"

namespace passung::tick {

/// Keeping apart: parts in two hands push each other away before they touch.
///
/// Symbols: H the held part where the hand asks it to be, O one in another hand; d the distance of their surfaces, p
/// the point of H that is nearest to O, n the unit vector to it from O's nearest point; r the range, k the stiffness.
///   F = Σ k (r - d) n,   T = Σ (p - o_H) × k (r - d) n,   over the parts in other hands with d < r
/// Derivation: the gradient of U = ½ k (r - d)², by ∂d = n · ∂p. d is that of the triangles, face by face, of what
/// drawn surfaces are made of (a shape's are 1 µm off it at most).
/// Limit cases: d ≥ r → zero. Touching → k r. Where H reaches into O: k r along the last n that was known.
/// Continuous in size. n turns from the one to the other where two places are equally near, and so does T: between
/// faces that are parallel by the way from one end to the other. Of convex parts that do not turn n is continuous.
/// Energy: what a part takes in on the way to another that rests it gives back.
/// Stability: k is a spring to the world beside the coupling's; `check` counts them together.
/// Cost: the pair of faces that was nearest is asked first; of others those that may be nearer, kMostFacePairs at most.
inline constexpr int kMostFacePairs = 300;

/// Owner: keeping apart.
struct NearPairs {
    struct Other {
        std::size_t body = kNoBody;
        surface::FacePair faces = {};
        Vec3 n = Vec3::Zero();
    };
    std::array<Other, scene::kMostHands - 1> other;
};

/// Stage, only if the scene names it, of each hand that holds a part which no other hand moves.
void keepApart(const HandModel& model, const HandSample& hand, const ObstaclePoses& obstacles, NearPairs& near,
               KeepApartShare& added) noexcept;
inline constexpr StageOf kKeepApart{
    keepApart,
    {.name = "keeping apart",
     .parameters = "effects.keep_apart",
     .cost = "a search of the nearest faces for each part in another hand; bound: 300 pairs of faces",
     .needs = [](const HandModel& model) { return model.keepsApart(); },
     .reason =
         [](const HandModel&) {
             return "effects.keep_apart is set: parts in two hands push each other away before they touch";
         },
     .spared =
         [](const HandModel& model) {
             return model.effects.keep_apart.any() ? "the hand holds nothing, or another hand moves it"
                                                   : "effects.keep_apart is not set, or its stiffness is 0";
         }}};

}  // namespace passung::tick
