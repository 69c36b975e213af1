#pragma once

#include <string>
#include <variant>
#include <vector>

#include "core/base/result.h"
#include "core/base/types.h"
#include "core/model/mesh.h"

namespace passung::model {

/// Parametric shapes, lengths in metres. The closed form of each is the truth for what is built from it.
/// Frames: peg: origin at the centre of the tip face, body along +z; bore plate: origin at the centre of the bore's
/// mouth on the top face z = 0, body below; the others: origin at the centre.
struct Sphere {
    double diameter;
};
struct Box {
    double width, depth, height;
};  // x, y, z
struct Cylinder {
    double diameter, length;
};  // axis z
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

using Shape = std::variant<Sphere, Box, Cylinder, Sheet, Peg, BorePlate>;

/// The kind's name in scene files ("bore_plate").
const char* kindName(const Shape& shape);

/// The dimensions in the order of the struct's members [m].
std::vector<double> dimensions(const Shape& shape);

/// Every value that is out of range: keys named as in a scene file, values in metres.
std::vector<Error> validate(const Shape& shape);

/// Exact signed distance [m] of `point` (part frame, [m]): positive outside. A sheet has no inside: unsigned.
double signedDistance(const Shape& shape, const Vec3& point);

/// Triangles of the shape, watertight except for the sheet, outward orientation. Vertices on round faces lie on the
/// true surface; the faces between them are within `chord_error` [m] of it, unless that would take more than 2048
/// segments a turn: chordError() says what is reached.
TriangleMesh tessellate(const Shape& shape, double chord_error);

/// The chord error that tessellate(shape, asked) reaches [m]: no point of the triangles is farther from the true
/// surface and no point of that farther from the triangles.
double chordError(const Shape& shape, double asked);

}  // namespace passung::model
