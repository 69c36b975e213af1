#pragma once

namespace passung::loop {

/// A virtual wall felt through a sampled loop, one degree of freedom: a handle of `mass` with viscous `damping`, a
/// force that is held between two ticks, and a wall whose spring and (backward difference) damper act `delay_ticks`
/// late. The hand is left out: an arm adds mass and damping, for which the published linear condition still holds.
/// Rotation uses the same numbers with inertia [kg·m²], [N·m·s/rad] and [N·m/rad].
struct SampledWall {
    double mass = 0.4;             // m [kg], > 0
    double damping = 1.0;          // b of the mechanism [N·s/m], ≥ 0
    double stiffness = 1000.0;     // K [N/m], ≥ 0
    double virtual_damping = 0.0;  // B [N·s/m], ≥ 0
    double period = 1e-3;          // T [s], > 0
    int delay_ticks = 0;           // d, 0 … kMaxDeviceDelayTicks
};

/// Longest delay of a device itself that the model covers [ticks]. What a scene adds has a limit of its own
/// (scene::kMaxDelayTicks).
inline constexpr int kMaxDeviceDelayTicks = 24;

/// True if every motion against the wall dies out (exact for the model; the border itself counts as unstable).
/// Values out of range, NaN included, are not stable.
bool isStable(const SampledWall& wall);

/// The stiffness up to which every smaller one is stable too, all else as in `wall` (its own stiffness is ignored)
/// [N/m]. 0 if already a very soft wall is unstable.
double stableStiffnessBorder(const SampledWall& wall);

/// The same wall felt through a tool: `wall`'s spring and damper are the coupling from handle to tool, and the tool, of
/// `tool_mass`, is pressed against a spring of its own (core/tick/penalty_tool.h, linear: a contact that also pulls).
struct SampledTool {
    SampledWall wall;
    double contact_stiffness = 10000.0;  // k between tool and wall [N/m], ≥ 0
    double tool_mass = 0.05;             // M [kg], ≥ 0; 0: the quasi-static coupling, whose tool feels no damper
};

/// As isStable() and stableStiffnessBorder() of a wall; the border is that of the coupling's stiffness, and infinite if
/// there is none below 100 m/T² (1 + b T/m): a contact that is soft enough is stable however it is coupled.
bool isStable(const SampledTool& tool);
double stableStiffnessBorder(const SampledTool& tool);

/// The least of these borders over contacts as stiff as `contact_stiffness` and softer (scanned by 5 %, down to where
/// none is left): it falls and rises with the contact's stiffness, and a contact is as soft as its place makes it.
double stableStiffnessBorderUpTo(const SampledTool& tool);

/// The border of the coupling's stiffness with a tool of whatever mass that nothing presses (core/tick/inertia.h): the
/// least over tools of 1/1000 to 1000 times the handle's mass, and no more than the wall's own. That both together stay
/// where they are put counts as stable. Without delay it is the wall's; with it down to 0.69 of that, with a tool about
/// as heavy as the handle.
double stableStiffnessBorderInAir(const SampledWall& wall);

/// The largest stiffness at which the wall can never give out energy [N/m]; 0 if there is none. Stricter than stable.
double passiveStiffness(const SampledWall& wall);

/// The same for a handle with dry friction `coulomb` f_c [N] whose encoder steps by `quantum` Δ [m]: at most 2 f_c/Δ as
/// well (Diolaiti and others 2006, Abbott and Okamura 2005), so that the friction takes more than a step of the spring
/// gives. 0 < Δ without friction leaves nothing; Δ = 0 asks for none.
double passiveStiffness(const SampledWall& wall, double coulomb, double quantum);

/// The rule of thumb K = (b + B)/(T/2 + t_d) [N/m]. The tangent of the exact border at the origin: optimistic as soon
/// as B outweighs b (by 5 % at BT/m = 0.05), so an upper estimate and no guarantee.
double linearStiffness(const SampledWall& wall);

}  // namespace passung::loop
