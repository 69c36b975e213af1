#pragma once

#include <numbers>
#include <string>
#include <variant>
#include <vector>

#include "core/base/result.h"
#include "core/base/types.h"
#include "core/geometry/mesh.h"

namespace passung::shape {

/// Parametric shapes, lengths in metres. The closed form of each is the truth for what is built from it.
/// Frames: pegs and bolts: origin on the tip face at the centre of its circle or rectangle, body along +z; plates with
/// a bore or pocket and nuts: origin at the centre of its mouth on the top face z = 0, body below; the others: origin
/// at the centre.
struct Sphere {
    double diameter;
};
struct Box {
    double width, depth, height;
};  // x, y, z
struct Cylinder {
    double diameter, length;
};  // axis z
struct Torus {
    double diameter;       // of the ring's circle
    double tube_diameter;  // less than the diameter
};                         // axis z
struct Sheet {
    double width, depth;
};  // zero thickness, open, plane z = 0
struct Peg {
    double diameter, length, chamfer;
};  // 45° chamfer at the tip; 0 = sharp
struct BorePlate {
    double width, depth, height;  // x, y, z
    double bore_diameter;
    double bore_depth;  // = height or more: a through bore
    double chamfer;     // 45° at the mouth; 0 = sharp
};
struct SquarePeg {
    double width, depth, length;  // x, y, z
    double chamfer;               // 45° along the tip's four edges, meeting at the corners
};
/// A round peg with a parallel key along its whole length, on the side of +x.
struct KeyedPeg {
    double diameter, length;
    double key_width;   // along y, less than the diameter
    double key_height;  // the key's top is the plane x = diameter / 2 + key_height
    double chamfer;     // 45° at the tip, of the round body and of the key
};
struct SquareBorePlate {
    double width, depth, height;        // x, y, z
    double pocket_width, pocket_depth;  // x, y
    double bore_depth;                  // along z; = height or more: through
    double chamfer;                     // 45° along the mouth's four edges
};
/// A bore with a keyway along its whole depth, on the side of +x.
struct KeyedBorePlate {
    double width, depth, height;  // x, y, z
    double bore_diameter;
    double key_width, key_height;  // of the keyway, as of KeyedPeg
    double bore_depth;             // = height or more: through
    double chamfer;                // 45° at the mouth, of the bore and of the keyway
};
inline constexpr double kIsoFlankAngle = std::numbers::pi / 3.0;  // between a ridge's flanks [rad]

/// A bar with a thread along its whole length: see thread.h. In the plane y = 0, x > 0 a ridge's middle is at z = 0.
struct ThreadBolt {
    double nominal_diameter;  // over the crests, without clearance
    double pitch, length;
    double chamfer;          // 45° at the tip; 0 = sharp
    double clearance = 0.0;  // by which crests and roots lie within the nominal ones, flanks by half of it
    double flank_angle = kIsoFlankAngle;
    double flank_height = 0.0;  // from root to crest; 0 = as ISO 68-1 has it
};
/// A ring with a threaded hole right through, along z: see thread.h. In the plane y = 0, x > 0 a groove's middle is at
/// z = 0, so that a bolt fits in it at the same pose.
struct ThreadNut {
    double nominal_diameter;  // over the roots, without clearance
    double pitch;
    double outer_diameter;
    double height;           // along z
    double chamfer;          // 45° at both mouths, from the crests on; 0 = sharp
    double clearance = 0.0;  // by which crests and roots lie outside of the nominal ones, flanks by half of it
    double flank_angle = kIsoFlankAngle;
    double flank_height = 0.0;  // as of ThreadBolt
};

using Shape = std::variant<Sphere, Box, Cylinder, Torus, Sheet, Peg, SquarePeg, KeyedPeg, BorePlate, SquareBorePlate,
                           KeyedBorePlate, ThreadBolt, ThreadNut>;

/// The kind's name in scene files ("bore_plate").
const char* kindName(const Shape& shape);

/// True if it looks the same however it is turned about its z axis; a thread does to the eye.
bool isRound(const Shape& shape);

/// One dimension: its key in scene files and its value [m], [rad].
struct Dimension {
    const char* key;
    double value;
};

/// The dimensions in the order of the struct's members.
std::vector<Dimension> namedDimensions(const Shape& shape);

/// Their values alone.
std::vector<double> dimensions(const Shape& shape);

/// Every value that is out of range: keys named as in a scene file, values in metres.
std::vector<Error> validate(const Shape& shape);

/// Exact signed distance [m] of `point` (part frame, [m]): positive outside. A sheet has no inside: unsigned.
double signedDistance(const Shape& shape, const Vec3& point);

/// Triangles of the shape, watertight except for the sheet, outward orientation. Vertices on round faces lie on the
/// true surface; the faces between them are within `chord_error` [m] of it, unless that would take more than 2048
/// segments a turn: chordError() says what is reached.
geometry::TriangleMesh tessellate(const Shape& shape, double chord_error);

/// The chord error that tessellate(shape, asked) reaches [m]: no point of the triangles is farther from the true
/// surface and no point of that farther from the triangles.
double chordError(const Shape& shape, double asked);

}  // namespace passung::shape
