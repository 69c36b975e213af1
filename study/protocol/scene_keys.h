#pragma once

#include <array>

#include "core/scene/scene_spec.h"
#include "study/protocol/key_ranges.h"
#include "study/protocol/key_table.h"

namespace passung::protocol::scene_rows {

using enum KeyType;
using namespace ranges;

// Rows of the key table for scenes: parts, shapes, contact, device, registration, start gate, effects; calibrations.
// clang-format off
inline constexpr std::array kSceneKeys{
    Key{"scene", "unit", Choice, kAny, "um|mm|cm|m|in", "mm", "Unit of lengths without one in their key: shapes, positions, meshes that do not say theirs."},
    Key{"scene", "part", Tables, kAny, "", "!", "Parts of the scene; each hand holds exactly one."},
    Key{"scene", "hand", Tables, kAny, "", "(one hand)", "Further hands, at most three, each with a device of its own. The first hand has no table: it is on `device`."},
    Key{"scene", "contact", Table, kAny, "", "(its defaults)", "Method, coupling and accuracy of contact."},
    Key{"scene", "device", Table, kAny, "", "(no preset)", "Haptic device and its limits; a study needs a preset."},
    Key{"scene", "registration", Table, kAny, "", "(its defaults)", "Pose and scale of the device's space in the scene."},
    Key{"scene", "start_gate", Table, kAny, "", "(no gate)", "Start of a trial: the hand holds the start pose first."},
    Key{"scene", "effects", Table, kAny, "", "(none)", "Further effects, a table each."},

    Key{"hand", "name", Name, kAny, "", "!", "Name of the hand, unique; `hand` of a part, records and exports use it."},
    Key{"hand", "device", Table, kAny, "", "(the first hand's)", "As `[device]`."},
    Key{"hand", "registration", Table, kAny, "", "(its defaults)", "As `[registration]`."},
    Key{"hand", "effects", Table, kAny, "", "(those of `[effects]`)", "The hand's own `clutch`, `position_scale` and `drift`, in place of those of `[effects]`; buttons are those of its own device."},
    Key{"hand", "start_gate", Table, kAny, "", "(no gate)", "As `[start_gate]`: contact starts for each hand when it holds its own start pose."},

    Key{"part_file", "unit", Choice, kAny, "um|mm|cm|m|in", "(the caller's)", "Unit of lengths without one in their key."},
    Key{"part_file", "part", Tables, kAny, "", "!", "Exactly one part."},

    Key{"station_file", "station", Table, kAny, "", "!", "What this station has."},

    Key{"station", "device", Table, kAny, "", "!", "Table of each hand that has a real device, by its name: `right` for the first hand, for a further one that of its `[[hand]]`."},

    Key{"station_device", "kind", Text, kAny, "", "!", "Kind that the device serves, as protocols name it."},
    Key{"station_device", "backend", Text, kAny, "", "!", "Way to it: one of those that `passung doctor` lists, or \"simulated\"."},
    Key{"station_device", "serial", Text, kAny, "", "(the only one)", "Serial number of the unit, as `passung doctor` shows it; needed where there are two."},
    Key{"station_device", "address", Text, kAny, "", "(the usual one)", "Where the program listens that serves it, or the library lies: for spacenavd the path of its socket, for haply HOST:PORT or HOST:PORT:EVENTPORT, for vrpn NAME@HOST:PORT#SENSOR, for dhd and hd the file of the vendor's library, libdhd.so or libHD.so; for hd also FILE#NAME, with the device's name in the vendor's set-up."},
    Key{"station_device", "axes", Text, kAny, "", "(the backend's)", "Axes of the device along x, y and z of its base, as in \"x -z y\"; not those of haply."},
    Key{"station_device", "heartbeat_ms", Integer, from(2, 50), "", "5", "How long a wrench holds without the next, if the program or its loop stops [ms]."},

    Key{"calibration", "device", Text, kAny, "", "!", "Name of the device."},
    Key{"calibration", "stable_stiffness_N_per_m", Number, atLeast(0), "", "!", "Stable maximum, for which \"max\" stands."},
    Key{"calibration", "stable_rotational_stiffness_Nm_per_rad", Number, atLeast(0), "", "!", "Stable maximum for rotations; 0 = torque is not actuated."},
    Key{"calibration", "calm_stiffness_N_per_m", Number, atLeast(0), "", "!", "Largest stiffness at which the device came to rest."},
    Key{"calibration", "calm_rotational_stiffness_Nm_per_rad", Number, atLeast(0), "", "!", "Largest rotational stiffness at which the device came to rest."},
    Key{"calibration", "damping_Ns_per_m", Number, atLeast(0), "", "!", "Damping of the wall with which the maximum was found; the recommended one."},
    Key{"calibration", "rotational_damping_Nms_per_rad", Number, atLeast(0), "", "!", "Rotational damping of that wall."},

    Key{"part", "name", Name, kAny, "", "!", "Name of the part, unique; factors address the part by this name."},
    Key{"part", "mesh", Text, kAny, "", "(a shape)", "Mesh file, relative to the file that names it. The data hold its SHA-256, not its content: keep it beside the study; a replay refuses another."},
    Key{"part", "shape", Table, kAny, "", "(a mesh)", "Parametric shape."},
    Key{"part", "pose", Table, kAny, "", "(identity)", "Part to world at the start."},
    Key{"part", "held", Boolean, kAny, "", "false", "True for a part in a hand from the start; each hand holds one, or with effects.pick none."},
    Key{"part", "pickable", Boolean, kAny, "", "false", "True for a part that hands may pick up, and let go if held; needs effects.pick."},
    Key{"part", "hand", Name, kAny, "", "(the first)", "Name of the hand that holds the part, one of `[[hand]]`; needs held = true."},
    Key{"part", "friction", Number, from(0, 10), "", "0", "Coefficient at rest. Two parts rub with the geometric mean of theirs: 0 on either side is none. God objects only."},
    Key{"part", "sliding_friction", Number, from(0, 10), "", "(as `friction`)", "Coefficient while sliding; at most `friction`."},
    Key{"part", "density_kg_per_m3", Number, from(0, 30000), "", "0", "Density of the part, all through: with effects.weight the held part weighs its volume times this. 0: nothing. The part has to enclose a volume: no sheet, no mesh with holes."},
    Key{"part", "shown_offset", LengthVector, kAny, "", "(zero)", "Distance from where the part is touched to where the part is drawn, along the world's axes; not for the held part."},
    Key{"part", "unit", Choice, kAny, "um|mm|cm|m|in", "(the scene's)", "Unit of this part's lengths."},

    Key{"pose", "position", LengthVector, kAny, "", "(zero)", "Origin of the part in the world."},
    Key{"pose", "rotation_deg", Vector, kAny, "", "(zero)", "Angles about the world's x, then y, then z axis: R = Rz Ry Rx."},

    Key{"shape", "kind", Choice, kAny, "sphere|box|cylinder|torus|sheet|peg|square_peg|keyed_peg|bore_plate|square_bore_plate|keyed_bore_plate|thread_bolt|thread_nut", "!", "Kind of shape; its own keys follow."},
    Key{"shape.sphere", "diameter", Length, above(0), "", "!", "Origin at the centre."},
    Key{"shape.box", "width", Length, above(0), "", "!", "Extent along x; origin at the centre."},
    Key{"shape.box", "depth", Length, above(0), "", "!", "Extent along y."},
    Key{"shape.box", "height", Length, above(0), "", "!", "Extent along z."},
    Key{"shape.cylinder", "diameter", Length, above(0), "", "!", "Axis z; origin at the centre."},
    Key{"shape.cylinder", "length", Length, above(0), "", "!", "Extent along z."},
    Key{"shape.torus", "diameter", Length, above(0), "", "!", "Diameter of the ring's circle, the middle of the tube; axis z, origin at the centre."},
    Key{"shape.torus", "tube_diameter", Length, above(0), "", "!", "Diameter of the tube; less than that of the ring."},
    Key{"shape.sheet", "width", Length, above(0), "", "!", "Extent along x; zero thickness in the plane z = 0, open."},
    Key{"shape.sheet", "depth", Length, above(0), "", "!", "Extent along y."},
    Key{"shape.peg", "diameter", Length, above(0), "", "(by the fit)", "Axis z; origin at the centre of the tip face, body along +z."},
    Key{"shape.peg", "length", Length, above(0), "", "!", "Extent along z."},
    Key{"shape.peg", "chamfer", Length, atLeast(0), "", "0", "45 degree chamfer at the tip; 0 = sharp."},
    Key{"shape.square_peg", "width", Length, above(0), "", "!", "Extent along x; origin at the centre of the tip face, body along +z."},
    Key{"shape.square_peg", "depth", Length, above(0), "", "!", "Extent along y."},
    Key{"shape.square_peg", "length", Length, above(0), "", "!", "Extent along z."},
    Key{"shape.square_peg", "chamfer", Length, atLeast(0), "", "0", "45 degree chamfer along the tip's edges; 0 = sharp."},
    Key{"shape.keyed_peg", "diameter", Length, above(0), "", "(by the fit)", "Diameter of the round body; axis z, origin at its centre in the tip face, body along +z."},
    Key{"shape.keyed_peg", "length", Length, above(0), "", "!", "Extent along z."},
    Key{"shape.keyed_peg", "key_width", Length, above(0), "", "!", "Width of the key along y; less than the diameter. The key is as long as the peg."},
    Key{"shape.keyed_peg", "key_height", Length, above(0), "", "!", "Height of the key above the round body, on the side of +x: the top is at x = diameter / 2 + key_height."},
    Key{"shape.keyed_peg", "chamfer", Length, atLeast(0), "", "0", "45 degree chamfer at the tip of body and key; 0 = sharp."},
    Key{"shape.bore_plate", "width", Length, above(0), "", "!", "Extent along x; origin at the centre of the bore's mouth, body below z = 0."},
    Key{"shape.bore_plate", "depth", Length, above(0), "", "!", "Extent along y."},
    Key{"shape.bore_plate", "height", Length, above(0), "", "!", "Extent along z."},
    Key{"shape.bore_plate", "bore_diameter", Length, above(0), "", "(by the fit)", "Diameter of the bore."},
    Key{"shape.bore_plate", "bore_depth", Depth, above(0), "", "!", "Depth of the bore: a length or \"through\"; the plate's height or more goes through."},
    Key{"shape.bore_plate", "chamfer", Length, atLeast(0), "", "0", "45 degree chamfer at the mouth; 0 = sharp."},
    Key{"shape.square_bore_plate", "width", Length, above(0), "", "!", "Extent along x; origin at the centre of the pocket's mouth, body below z = 0."},
    Key{"shape.square_bore_plate", "depth", Length, above(0), "", "!", "Extent along y."},
    Key{"shape.square_bore_plate", "height", Length, above(0), "", "!", "Extent along z."},
    Key{"shape.square_bore_plate", "pocket_width", Length, above(0), "", "!", "Width of the pocket along x; to fit the peg's `width`."},
    Key{"shape.square_bore_plate", "pocket_depth", Length, above(0), "", "!", "Depth of the pocket along y; to fit the peg's `depth`."},
    Key{"shape.square_bore_plate", "bore_depth", Depth, above(0), "", "!", "Depth of the pocket along z: a length or \"through\"; the plate's height or more goes through."},
    Key{"shape.square_bore_plate", "chamfer", Length, atLeast(0), "", "0", "45 degree chamfer along the mouth's edges; 0 = sharp."},
    Key{"shape.keyed_bore_plate", "width", Length, above(0), "", "!", "Extent along x; origin at the centre of the bore's mouth, body below z = 0."},
    Key{"shape.keyed_bore_plate", "depth", Length, above(0), "", "!", "Extent along y."},
    Key{"shape.keyed_bore_plate", "height", Length, above(0), "", "!", "Extent along z."},
    Key{"shape.keyed_bore_plate", "bore_diameter", Length, above(0), "", "(by the fit)", "Diameter of the bore."},
    Key{"shape.keyed_bore_plate", "key_width", Length, above(0), "", "!", "Width of the keyway along y; less than the bore's diameter."},
    Key{"shape.keyed_bore_plate", "key_height", Length, above(0), "", "!", "Height of the keyway, on the side of +x: its bottom is at x = bore_diameter / 2 + key_height."},
    Key{"shape.keyed_bore_plate", "bore_depth", Depth, above(0), "", "!", "Depth of bore and keyway: a length or \"through\"; the plate's height or more goes through."},
    Key{"shape.keyed_bore_plate", "chamfer", Length, atLeast(0), "", "0", "45 degree chamfer at the mouth of bore and keyway; 0 = sharp."},
    Key{"shape.thread_bolt", "nominal_diameter", Length, above(0), "", "!", "Diameter over the crests, without clearance; axis z, origin at the centre of the tip face, body along +z. The thread starts at +x."},
    Key{"shape.thread_bolt", "pitch", Length, above(0), "", "!", "Way along the axis from one turn to the next; at most a quarter of the diameter."},
    Key{"shape.thread_bolt", "length", Length, above(0), "", "!", "Extent along z, 1 to 100 pitches."},
    Key{"shape.thread_bolt", "flank_angle_deg", Number, from(2, 60), "", "60", "Angle between the flanks of a ridge: 60 of ISO 68-1, 30 of a trapezoidal thread, 2 of a square one, whose flanks are 1 degree off."},
    Key{"shape.thread_bolt", "flank_height", Length, above(0), "", "(0.541 pitch)", "Height of the flanks from root to crest, at most 3/4 of the pitch; by default that of ISO 68-1. Ridge and groove are equally wide at 3/5 of it below a bolt's crest."},
    Key{"shape.thread_bolt", "clearance", Length, atLeast(0), "", "0", "Distance by which crests and roots lie nearer to the axis than the nominal ones; flanks by half of it. Less than a quarter of the pitch."},
    Key{"shape.thread_bolt", "chamfer", Length, atLeast(0), "", "0", "45 degree chamfer at the tip; 0 = sharp."},
    Key{"shape.thread_nut", "nominal_diameter", Length, above(0), "", "!", "Diameter over the roots, without clearance; origin at the centre of the thread's mouth, body below z = 0."},
    Key{"shape.thread_nut", "pitch", Length, above(0), "", "!", "Way along the axis from one turn to the next; at most a quarter of the diameter."},
    Key{"shape.thread_nut", "height", Length, above(0), "", "!", "Extent along z, 1 to 12 pitches."},
    Key{"shape.thread_nut", "outer_diameter", Length, above(0), "", "!", "Diameter of the outside."},
    Key{"shape.thread_nut", "flank_angle_deg", Number, from(2, 60), "", "60", "Angle between the flanks of a ridge: 60 of ISO 68-1, 30 of a trapezoidal thread, 2 of a square one, whose flanks are 1 degree off."},
    Key{"shape.thread_nut", "flank_height", Length, above(0), "", "(0.541 pitch)", "As of a thread_bolt."},
    Key{"shape.thread_nut", "clearance", Length, atLeast(0), "", "0", "Distance by which crests and roots lie farther from the axis than the nominal ones; flanks by half of it. Less than a quarter of the pitch."},
    Key{"shape.thread_nut", "chamfer", Length, atLeast(0), "", "0", "45 degree chamfer at both mouths, from the crests on; 0 = sharp."},
    Key{"shape.fit", "fit", Text, kAny, "", "(none: the diameter is given)", "Hole and shaft by ISO 286, such as \"H7/g6\": a peg takes the shaft, a plate the hole. Holes D, E, F, G, H, JS, K, M, N, P; shafts d, e, f, g, h, js, k, m, n, p, r, s; grades 01, 0, 1 to 18."},
    Key{"shape.fit", "nominal_diameter", Length, above(0), "", "(none)", "Nominal diameter of the fit, at most 500 mm."},
    Key{"shape.fit", "deviation", Choice, kAny, "mean|min|max", "mean", "Choice among the pairs that the fit allows: mean, least or most clearance."},

    Key{"contact", "method", Choice, kAny, "penalty|god_object_heuristic|god_object", "god_object_heuristic", "Method that turns penetration into force. penalty: springs in every contact. God objects: a proxy that stays outside is coupled to the hand; god_object keeps the proxy farther out, by the constraints alone."},
    Key{"contact", "geometry", Choice, kAny, "auto|closed_form|surface|field", "auto", "What contact is computed from. closed_form: the shapes' own faces, edges and curvature; exact, for god objects and parametric shapes other than sheets, without friction but for threads; a thread_bolt and a thread_nut have it with each other only. surface: the parts' triangles, which never meet; for god objects without proxy_filter_hz. field: distance fields and point shells, which accuracy, tolerance_um, cell_mm, spacing_mm, mode, budget_nodes and two_way are of and have no say elsewhere. auto: for god objects closed_form where it can be had, else surface where the proxy has no low-pass; field for all else, and with accuracy = \"auto\". `passung explain` says which, and why; a study keeps the one with which its database began."},
    Key{"contact", "variant", Choice, kAny, "max_normalised|area_weighted|raw", "max_normalised", "Weighting of the penalty; unused by other methods. Only max_normalised keeps to the stiffness: raw adds it up over all points, area_weighted has area_stiffness_N_per_m3 instead; with direct coupling neither is held below the device's stable maximum, and `check` warns of them."},
    Key{"contact", "stiffness_N_per_m", Stiffness, above(0), "", "(\"max\"; without a device preset 1000)", "Number, or fraction of the device's stable maximum: \"max\", \"0.5 max\"; never above it, unless `allow_unstable`. The maximum is what was found on this machine's device (`passung doctor --device NAME --find-stiffness`), else the preset's below; a study keeps the one with which it began. The maximum is known only for the recommended damping and no added delay; with a scale s of the registration both are 1/s of the device's."},
    Key{"contact", "rotational_stiffness_Nm_per_rad", Stiffness, atLeast(0), "", "(the same fraction of the device's maximum as the stiffness; without a device preset 1)", "Stiffness for rotations, given like the stiffness."},
    Key{"contact", "allow_unstable", Boolean, kAny, "", "false", "True lifts the rules that keep a stiffness where the device is known to be stable: the stable maximum as an upper limit, the recommended damping, no added delay, and the border of a coupled penalty through its tool."},
    Key{"contact", "damping_Ns_per_m", Number, atLeast(0), "", "(1/scale times the device's recommended damping; without a device preset 0)", "Damping of the coupling between hand and scene; with a device preset only what it recommends."},
    Key{"contact", "rotational_damping_Nms_per_rad", Number, atLeast(0), "", "(1 times the device's recommended damping; without a device preset 0)", "Damping for rotations, given like the damping."},
    Key{"contact", "coupling", Choice, kAny, "direct|quasi_static|virtual", "direct", "Coupling of the penalty to the hand. direct: the overlap at the hand's own pose makes the force. Else the penalty acts on a tool that stiffness and damping couple to the hand, which then feels at most the stiffness, whatever the variant: quasi_static, a tool without mass where both balance; virtual, a tool with mass, whose inertia is felt in free motion too. A god object has a coupling of its own."},
    Key{"contact", "penalty_stiffness_N_per_m", Number, above(0), "", "(10 times the stiffness)", "Stiffness of the contacts of a coupled penalty: a plane is felt with both in series, 10/11 of the stiffness by default; area_weighted has area_stiffness_N_per_m3 instead."},
    Key{"contact", "tool_mass_kg", Number, above(0), "", "(a tenth of the device's apparent mass; where that is not known 0.05)", "Mass of the virtual coupling's tool."},
    Key{"contact", "tool_inertia_kg_m2", Number, above(0), "", "(a tenth of the device's apparent inertia; where that is not known 5e-5)", "Inertia of that tool about every axis."},
    Key{"contact", "area_stiffness_N_per_m3", Number, above(0), "", "1e9", "Pressure per depth of the area-weighted penalty."},
    Key{"contact", "accuracy", Choice, kAny, "chosen|auto", "chosen", "chosen: tolerance_um, cell_mm, spacing_mm, mode, budget_nodes and two_way say it. auto (studies only): in their place the program measures, when the study first runs, what tolerances, spacings and node budgets cost and how much they err, and takes the most accurate whose query fits accuracy_budget_us; kept in the database for the whole study."},
    Key{"contact", "accuracy_budget_us", Number, above(0), "", "(only with accuracy = \"auto\", and needed there)", "Longest time that a query of the held part against all others may take, 99th percentile over poses along contact paths."},
    Key{"contact", "tolerance_um", Number, from(0.0001, 100000), "", "(1/2500 of the held part, at most 1/20 of the smallest feature that needs it, rounded to 1, 2 or 5 times a power of ten: 20 for a part of 36 to 70 mm)", "Accuracy that the distance fields keep near surfaces. A pin, fin or wall of an obstacle whose inscribed ball is not larger is an error."},
    Key{"contact", "cell_mm", Number, from(0.00001, 10000), "", "(from the tolerance)", "Edge of a distance field's cells near surfaces, the same everywhere; tolerance_um has no say then. A pin, fin or wall of an obstacle thinner than 1.73 cells is an error: interpolation smooths it away."},
    Key{"contact", "spacing_mm", Number, from(0.00001, 10000), "", "(1/50 of the held part, at most the smallest feature that needs it, rounded to 1, 2 or 5 times a power of ten: 1 for a part of 36 to 70 mm)", "Distance between the points of the point shells; the held part may have about two million, by default about 40 000."},
    Key{"contact", "mode", Choice, kAny, "layered|surface_point|linear|trilinear|cubic", "trilinear",
        "Interpolation in the distance field, from coarse to smooth."},
    Key{"contact", "budget_nodes", Integer, from(0, 1000000), "", "0", "Largest number of tree nodes that a query visits, of a god object in one tick: its query goes on in the next; 0 = no budget."},
    Key{"contact", "quality", Number, from(0, 1), "", "0", "Least share of the held part's surface that a query under budget_nodes looks at or rules out: it wins over the budget. Penalty only. Samples have the share that was reached, `quality`."},
    Key{"contact", "two_way", Boolean, kAny, "", "(true where a pin, fin, wall, acute edge or relief of an obstacle would slip between the held part's points)", "True where points of the obstacles are held against the held part as well: finds edges between the held part's points, and takes about twice as long. With false, what would slip through is an error."},
    Key{"contact", "proxy_filter_hz", Number, from(0, 500), "", "0", "Corner of the proxy's low-pass while in contact; 0 = no filter. God objects only."},

    Key{"device", "kind", Text, kAny, "", "(none)", "Kind of device, one of those below: its limits, degrees and workspace. A station file says which unit serves it, the simulated one if it says nothing. \"any\": whatever unit does what the `least_` keys say; a stiffness then is a number."},
    Key{"device", "preset", Text, kAny, "", "(none)", "Earlier name of `kind`."},
    Key{"device", "least_force_N", Number, from(0, 100), "", "(only with kind = \"any\")", "Force that the unit pushes with at least, and the most that is asked of it; 0: it need not push."},
    Key{"device", "least_torque_Nm", Number, from(0, 10), "", "0", "Torque likewise; 0: it need not turn. Only with kind = \"any\"."},
    Key{"device", "least_degrees", Integer, from(3, 6), "", "6", "Degrees that the unit measures at least: 6, or 3 where nothing has to be turned. Only with kind = \"any\"."},
    Key{"device", "max_force_N", Number, above(0), "", "(the device's)", "Limit of the output, tighter than the device's."},
    Key{"device", "max_torque_Nm", Number, atLeast(0), "", "(the device's)", "Limit of the output, tighter than the device's."},
    Key{"device", "max_force_rate_N_per_s", Number, above(0), "", "(the device's)", "Limit of rising force, tighter than the device's."},
    Key{"device", "delay_ticks", Integer, from(0, scene::kMaxDelayTicks), "", "0", "Milliseconds added between command and effect, beside the device's own delay; with a device preset only 0."},

    Key{"registration", "position", LengthVector, kAny, "", "(zero)", "Origin of the device's base in the world."},
    Key{"registration", "rotation_deg", Vector, kAny, "", "(zero)", "Rotation of the device's base, as in a pose."},
    Key{"registration", "scale", Number, from(0.001, 1000), "", "1", "Metres in the scene per metre of the device. The hand feels the stiffness times this: so much less is the stable maximum."},
    Key{"registration", "handle_position", LengthVector, kAny, "", "(zero)", "Origin of the held part in the device's handle."},
    Key{"registration", "handle_rotation_deg", Vector, kAny, "", "(zero)", "Rotation of the held part in the handle."},

    Key{"start_gate", "position_tolerance_mm", Number, from(0, 1000), "", "0", "Largest distance from the held part's start; 0 = not asked."},
    Key{"start_gate", "angle_tolerance_deg", Number, from(0, 180), "", "0", "Largest angle from the held part's start; 0 = not asked."},
    Key{"start_gate", "pose", Table, kAny, "", "(the held part's)", "Start pose of a hand that begins with nothing; of no other."},
    Key{"start_gate", "hold_ms", Number, from(0, 10000), "", "0", "Time for which the part stays within these tolerances."},

    Key{"effects", "passivity_controller", Table, kAny, "", "(none)", "A damper that takes energy back where the controller gave more than it took in; the account itself is always recorded."},
    Key{"effects", "transients", Table, kAny, "", "(none)", "Event-based transients: a decaying vibration in proportion to the speed, added at every impact, as a tap on something hard gives."},

    Key{"effects", "weight", Table, kAny, "", "(none)", "Weight of the held part, by its density_kg_per_m3: felt in the air, not where the part lies. The part hangs from the hand by its weight over the stiffness: `explain` says how far. Its inertia is an effect of its own."},

    Key{"effects", "viscosity", Table, kAny, "", "(none)", "A damper on the held part's motion, in the air and in contact: it moves as in a fluid."},
    Key{"effects", "guidance", Table, kAny, "", "(none)", "Shared control: a guide goes along a way before the first hand and draws it after itself by a spring, with the share that is asked for. It goes with one part: not with `effects.pick`; and it gives energy out: not with a passivity controller."},
    Key{"effects", "snap", Table, kAny, "", "(none)", "Near a place of its own the held part is drawn into it, as by a magnet: with `effects.pick` into the goals of the task's steps, else into the poses `at`. What it gives on the way in it takes on the way out: not with a passivity controller."},
    Key{"effects", "inertia", Table, kAny, "", "(none)", "Inertia of the held part, by its density_kg_per_m3: what it takes to shake and to turn it, and that it goes on where nothing stops it. A god object's proxy is then a mass on the coupling's spring."},
    Key{"effects", "keep_apart", Table, kAny, "", "(none)", "Parts in two hands push each other away before they touch, by the distance of their surfaces. What one hand puts in the other one may get: not with a passivity controller."},
    Key{"effects", "record", Boolean, kAny, "", "false", "True: what each of transients, weight, viscosity, guidance, snap, inertia and keep_apart adds to the wrench is recorded in every tick, and exported with the samples."},

    Key{"effects", "pick", Table, kAny, "", "(none)", "Hands pick parts up and let them go, by a button: a hand closes on the nearest pickable part, and the coupling holds it where the hand's point was."},
    Key{"effects", "clutch", Table, kAny, "", "(none)", "While its button is held the hand moves and the part stays, as a mouse that is lifted; let go, the part goes on from there without a jump. The wrench fades within 50 ms, at once where the hand yields to it, and a coupling relaxes, so that no energy is given out."},
    Key{"effects", "position_scale", Table, kAny, "", "(none)", "Another scale than the registration's while its button is held. Changes only while nothing touches: in contact a smaller scale would give back more energy than was put in."},
    Key{"effects", "drift", Table, kAny, "", "(none)", "Workspace drift control (Conti and Khatib 2005): while the hand moves, and nothing touches, the scene moves under it by a share of its speed, away from the middle of the device's workspace on the hand's side: who keeps the part in sight brings the hand back to the middle."},

    Key{"hand_effects", "clutch", Table, kAny, "", "(none)", "As in `[effects]`."},
    Key{"hand_effects", "position_scale", Table, kAny, "", "(none)", "As in `[effects]`."},
    Key{"hand_effects", "drift", Table, kAny, "", "(none)", "As in `[effects]`."},

    Key{"effects.clutch", "button", Integer, from(1, scene::kButtons), "", "!", "Number of the device's button, from 1. No other effect and no answer of the task may have it."},
    Key{"effects.clutch", "orientation", Boolean, kAny, "", "true", "True: the part keeps its orientation as well, and the hand may turn to a better one. False: the part goes on turning with the hand, about the handle."},

    Key{"effects.position_scale", "button", Integer, from(1, scene::kButtons), "", "!", "As `button` of the clutch."},
    Key{"effects.position_scale", "scale", Number, from(0.001, 1000), "", "!", "Metres in the scene per metre of the device while the button is held. The hand feels the stiffness times the larger of this and the registration's: so much less is the stable maximum."},

    Key{"effects.drift", "share", Number, from(0, scene::kMostDrift), "", "!", "Speed of the drift per speed of the hand, as a part of it; 0: none."},
    Key{"effects.drift", "radius_mm", Number, from(1, 10000), "", "(the device's workspace; without a device preset 100)", "Distance of the handle from the middle of the workspace from which on the drift has its whole share; nearer, in proportion."},

    Key{"effects.passivity_controller", "max_damping_Ns_per_m", Number, above(0), "", "!", "Largest damping; a mass m cannot bear more than about m / (1 ms)."},

    Key{"effects.transients", "amplitude_Ns_per_m", Number, above(0), "", "!", "Force of the vibration per speed of the impact. The device's limits hold for contact and vibration together."},
    Key{"effects.transients", "frequency_hz", Number, aboveUpTo(0, 400), "", "!", "Frequency of the vibration."},
    Key{"effects.transients", "decay_ms", Number, aboveUpTo(0, 1000), "", "!", "Time in which the vibration falls to 37 %."},

    Key{"effects.viscosity", "damping_Ns_per_m", Number, from(0, 100), "", "!", "Force per speed of the held part's origin. A device of mass m bears about m / (3 ms) without trembling."},
    Key{"effects.viscosity", "rotational_damping_Nms_per_rad", Number, from(0, 1), "", "0", "Torque per speed of its turning."},

    Key{"effects.guidance", "share", Number, from(0, 1), "", "!", "Share of the guide's force that the hand feels. 0: no guide at all, to the last bit; 1: the guide leads. Made to be a factor's key."},
    Key{"effects.guidance", "way", Tables, kAny, "", "!", "Poses of the held part in the world, one after the other, at most 64: the way goes from where the part starts straight to the first, from there to the next, turning evenly. Each has a `position` and `rotation_deg`."},
    Key{"effects.guidance", "speed_mm_per_s", Number, aboveUpTo(0, 1000), "", "30", "Speed of the guide along its way. It waits for a hand that stays behind, and never turns back."},
    Key{"effects.guidance", "lead_mm", Number, aboveUpTo(0, 100), "", "10", "How far the guide goes before the hand; its spring pulls with no more than this times its stiffness."},
    Key{"effects.guidance", "stiffness_N_per_m", Number, from(0, 10000), "", "500", "Stiffness of the guide's spring at a share of 1. With the coupling's it stays below the device's stable maximum."},
    Key{"effects.guidance", "rotational_stiffness_Nm_per_rad", Number, from(0, 100), "", "0.2", "The same of turning."},

    Key{"effects.snap", "stiffness_N_per_m", Number, from(0, 10000), "", "!", "Stiffness in the place. 0: no snap at all, to the last bit. The force is largest, 0.286 times this times the range, where 0.45 of the range is left. With the coupling's, and a guide's, it stays within the device's stable maximum, which is what contact.stiffness_N_per_m is where it is not set. Against turning it is this times rotational_stiffness over stiffness of the contact. Where it is above 0, `contacts` > 0 alone tells contact to all measures."},
    Key{"effects.snap", "range_mm", Number, aboveUpTo(0, 1000), "", "5", "Distance at which the part begins to be drawn: of the point that the hand holds from where it would be in the place, the part not turned against it. A turn of 1 rad counts as the square root of rotational_stiffness over stiffness of the contact."},
    Key{"effects.snap", "at", Tables, kAny, "", "(the goals of the steps)", "Places of the first hand's part as poses in the world, at most 64; only without `effects.pick`, and then one at least; their ranges do not meet. Each has a `position` and `rotation_deg`."},

    Key{"effects.inertia", "scale", Number, from(0, 100), "", "1", "Times the part's own mass and moments of inertia. 0: none at all, to the last bit. Made to be a factor's key."},

    Key{"effects.keep_apart", "stiffness_N_per_m", Number, from(0, 10000), "", "!", "Force per length by which the parts are nearer than the range. 0: none at all, to the last bit. With the coupling's it stays below the device's stable maximum."},
    Key{"effects.keep_apart", "range_mm", Number, aboveUpTo(0, 1000), "", "20", "Distance of the two parts' surfaces from which on they push each other away."},

    Key{"effects.pick", "reach_mm", Number, aboveUpTo(0, 1000), "", "!", "Largest distance of a part's surface from the hand's point, the origin of what the registration puts into the handle."},
    Key{"effects.pick", "button", Integer, from(1, scene::kButtons), "", "1", "Number of the device's button, from 1. No other effect may have it."},
    Key{"effects.pick", "closed", Choice, kAny, "while_down|on_press", "while_down", "while_down: the hand is closed while the button is down. on_press: a press closes it, the next one opens it."},
    Key{"effects.pick", "let_go", Choice, kAny, "leave|lock", "leave", "leave: a part stays where it is let go, and can be picked up again. lock: it stays there for good."},

    Key{"effects.weight", "gravity_m_per_s2", Vector, kAny, "", "([0, 0, -9.80665])", "Gravity along the world's axes, at most 100 long; zero: no weight."},
};
// clang-format on

}  // namespace passung::protocol::scene_rows
