#pragma once

#include "core/tick/energy_account.h"
#include "core/tick/grip.h"
#include "core/tick/hand_model.h"
#include "core/tick/input_guard.h"
#include "core/tick/proxy_state.h"
#include "core/tick/tick_frame.h"
#include "core/tick/weight.h"

namespace passung::tick {

inline constexpr int kGripTicks = 50;   // in which the wrench fades once the clutch is held
inline constexpr double kYield = 1e-9;  // [J] given out in a tick: less is rounding

/// How the device's space lies in the scene now.
struct Offset {
    bool moved = false;         // false: as the registration says, to the last bit
    double scale = 1.0;         // s
    Vec3 o = Vec3::Zero();      // device base axes [m]
    Quat Q = Quat::Identity();  // of the part in the handle
};

/// What the clutch holds.
struct Clutched {
    bool held = false;
    double grip = 1.0;            // share of the wrench that is left, 0 … 1
    bool noted = false;           // what follows is of the tick in which the clutch was taken
    Pose X_WH;                    // where the part was taken out of the hand
    Pose X_BI;                    // and the handle's image there
    Vec3 stretch = Vec3::Zero();  // of the coupling then [m]
    Vec3 twist = Vec3::Zero();    // likewise [rad]
};

/// The good sample before.
struct MappedSample {
    bool known = false;
    Pose X_BD, X_WH;
    double energy = 0.0;           // EnergyAccount::taken_in then [J]
    bool follows = false;          // `believed` is of it, and not of one before samples were lost
    Vec3 believed = Vec3::Zero();  // place of the handle within its encoder step (passivity.h) [m]
};

/// Owner: navigation. Read by the energy account, of the tick before.
struct HandMapping {
    Offset offset;
    Clutched clutch;
    MappedSample sample;
};

/// Owner: sign of contact. Read by navigation, of the tick before.
struct ContactSign {
    bool touching = false;
};

/// Navigation: clutch, second scale and drift, for scenes that are larger than the device's workspace.
/// Sources: the clutch is that of a mouse that is lifted; drift: Conti and Khatib (2005), Spanning large workspaces
/// using small haptic devices.
///
/// Symbols: B the device's base, D the handle, I its image in the scene, H the held part where the hand asks it to be,
/// x = p_BD; s, o, Q scale, offset and turn (Offset); X_WB the registration's, X_DH the part in the handle (grip.h).
///   X_BI = (R_BD Q, s x + o),   X_WH = X_WB · X_BI · X_DH                                      (1)
/// Q = 1, o = 0, s the registration's: registeredPose. Q is on the right, so that a turn of the hand turns the part
/// about the same axis whatever was clutched before, as a motion moves it along the same one: ω_H = R_WB ω_D and
/// ẋ_H = s R_WB ẋ + ω_H × (p_H - p_I). Its transpose, but for s, takes the wrench to the handle, with the lever
/// p_H - p_I = R_H R_DHᵀ p_DH: as without navigation (output_stage.h). Each effect changes o, Q or s so that H stays
/// where it is; k this good sample, k-1 the one before:
///   clutch   from the sample after that which shows the button down up to that which shows it up again: H_k = H_{k-1}
///            (and the coupling relaxes, below): Q, o from (1) at X_BD,k. From one to the other o changes by -s times
///            the hand's way. `orientation` false: I stays in place, R_H = R_WB R_BD Q R_DH goes on turning, Q stays.
///   scale    the other scale s': o += (s - s') x_{k-1}, so that H_k = H_{k-1} + s' R_WB (x_k - x_{k-1}).
///   drift    o += s σ |y_k - y_{k-1}| c,   c = m/max(|m|, r),   m = (y_k + y_{k-1})/2 - h
///            σ the share, r its radius, h the middle of the workspace, y the handle where it is believed to be within
///            an encoder step (passivity.h), so that a handle at rest whose reading flickers rests. H then moves by (1
///            ± σ) of the hand's way; who keeps H in sight brings the hand nearer to h. Along a line from h within r
///            the sum telescopes: σ s X²/(2 r) for the way out to X, as much for the way back.
/// What dampers, transients and measures see is H's motion, drift included; the handle's own port, its energy and the
/// passivity controller's damper (passivity.h) know of neither s nor o.
///
/// Energy at the handle. The coupling stores ½K e²/s there (F dx = K e de/s), e = p_G - p_H. So
///   - a scale that became smaller in contact would give back 1/s' of what 1/s paid; drift in contact would load the
///     spring at nobody's expense. Both wait while the contact's wrench is not zero (ContactSign, of the tick before):
///     in the tick of an impact drift has moved by at most σ of one tick's way. A virtual tool, whose mass pulls in the
///     air too: while it has contacts.
///   - the clutch: with H at rest a wrench that is held would be a force that the hand can walk along for ever. So it
///     fades: F is sent g-fold, g falls from 1 to 0 in kGripTicks, and H goes to where the coupling is relaxed,
///     H_c + (1 - g) e_c: nothing pushes the hand when it lets the button go. As soon as the account says that the
///     wrench gave energy out in the last tick, g = 0: the hand yields to it, and nobody needs the rest. So what a
///     clutch gives out at nobody's expense is the first tick's motion of a hand that begins to yield after it was
///     taken, none of one that yields already; a delay of the output adds its ticks. What the spring held is lost.
///     Released, the contact's wrench is whole at once; it begins with what is left of the stretch: nothing where there
///     is a proxy and g came to 0. Without a proxy (penalty at the hand) the part cannot be relaxed: the wrench comes
///     back, within the output's limit of rising force; what it gives was taken in before. `orientation` false: the
///     torque about the handle stays whole, as its motion does.
///   - weight fades with g, and comes back in kGripTicks: it has a potential of the handle's place alone
///     (liftEnergy), which the account books by the share that was sent.
///
/// When: only once the trial has begun (start gate), on new good samples; a held tick changes nothing, buttons
/// included. A hand that was lost and is found elsewhere is mapped as it is; a clutched part stays. Every trial, and
/// every scene of a sequence, begins with the registration.
/// Limit cases: no button pressed, σ = 0: registeredPose to the last bit. Hand at rest: nothing moves.
///
/// Stage, only if the scene names one of the effects; after the energy account, before whoever looks where the hand is.
void navigate(const HandModel& model, const Reading& device, const InputGuard& guard, const Engagement& gate,
              const Grip& grip, const EnergyAccounts& accounts, const Proxy& proxy, const Hang& hang,
              const ContactSign& sign, HandSample& hand, HandMapping& mapping, MappingRecord& record) noexcept;
inline constexpr StageOf kNavigation{
    navigate,
    {.name = "navigation",
     .parameters = "effects.clutch, effects.position_scale, effects.drift",
     .cost = "constant",
     .senses = true,
     .before_start = true,
     .needs = [](const HandModel& model) { return model.effects.navigation.any(); },
     .reason =
         [](const HandModel&) {
             return "effects.clutch, effects.position_scale or effects.drift is set: the hand's place in the scene "
                    "follows them";
         },
     .spared =
         [](const HandModel&) { return "none of effects.clutch, effects.position_scale and effects.drift is set"; }}};

/// Stage, after the contact's wrench, before effects add to it.
void noteContact(const HandModel& model, const ContactRecord& contacts, const HandWrench& wrench,
                 ContactSign& sign) noexcept;
inline constexpr StageOf kContactSign{
    noteContact,
    {.name = "sign of contact",
     .parameters = "effects.position_scale, effects.drift",
     .cost = "constant",
     .needs =
         [](const HandModel& model) {
             const scene::Navigation& navigation = model.effects.navigation;
             return navigation.second_scale.button > 0 || navigation.drift.share > 0.0;
         },
     .reason =
         [](const HandModel&) { return "effects.position_scale or effects.drift is set: both wait while parts touch"; },
     .spared = [](const HandModel&) { return "neither effects.position_scale nor effects.drift is set"; }}};

/// Stage, after all that is to be felt, before its delay: what the clutch leaves of the wrench.
void fadeWrench(const HandModel& model, const HandSample& hand, const Grip& grip, const HandMapping& mapping,
                Pushes& pushes, HandWrench& wrench) noexcept;
inline constexpr StageOf kClutchedWrench{
    fadeWrench,
    {.name = "clutched wrench",
     .parameters = "effects.clutch",
     .cost = "constant, and a little for each obstacle that pushes",
     .needs = [](const HandModel& model) { return model.effects.navigation.clutch.button > 0; },
     .reason = [](const HandModel&) { return "effects.clutch is set: the wrench fades while the clutch is held"; },
     .spared = [](const HandModel&) { return "effects.clutch is not set"; }}};

/// (1). rt-safe.
Pose mappedPose(const scene::Registration& registration, const Offset& offset, const Pose& X_BD,
                const Pose& X_DH) noexcept;

}  // namespace passung::tick
