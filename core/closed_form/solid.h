#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "core/closed_form/face.h"
#include "core/shape/shape.h"

namespace passung::closed_form {

/// An edge at a place of it: its direction, the gradients of its two sides, and how these turn about it.
struct EdgeFrame {
    Vec3 way, a, b;
    double turn = 0.0;
};

/// A place on a line, of a circle and a spiral with what all that lies there is computed from.
struct LinePlace {
    double t = 0.0;
    double cosine = 0.0, sine = 0.0;  // of t
};

/// A line of a solid: a straight piece, a circle or an arc of one, a spiral, or a point. P(t), t from -end to end, is
/// centre + cos t e1 + sin t e2, t in radians, of a circle; centre + t e1 of a straight piece; of a spiral, t from
/// begin to end, centre + (radius + widening t) (cos t e1 + sin t e2) + climb t e3: on a cylinder, in a plane, on a
/// cone. Frame of the part.
struct Curve {
    enum class Kind { Point, Straight, Circle, Spiral };

    Kind kind = Kind::Point;
    Vec3 centre = Vec3::Zero();
    Vec3 e1 = Vec3::Zero(), e2 = Vec3::Zero();                // [m]; of a straight piece e1 alone
    double end = 1.0;                                         // of t; π: a whole circle
    double thickness = 0.0;                                   // of the material around it [m]; 0: an edge
    std::optional<std::array<Face, 2>> sides = std::nullopt;  // of an edge: the faces that meet there
    std::array<std::optional<Face>, 2> caps = {};             // and the one at which it ends, at -end and at end
    // Of a spiral: [m], [m/rad], unit vectors.
    double begin = 0.0, radius = 0.0, widening = 0.0, climb = 0.0;
    Vec3 e3 = Vec3::Zero();
    std::vector<EdgeFrame> fixed = {};  // of a circle with sides: at fixedPlace(0), fixedPlace(1), ...

    /// No point of it is farther from the centre [m]; of no spiral.
    double extent() const noexcept { return kind == Kind::Point ? 0.0 : e1.norm(); }
    bool isClosed() const noexcept { return kind == Kind::Circle && end > 3.14159; }
};

/// A part of a line that is searched at once: all of it, or of a spiral at most a turn.
struct LinePiece {
    double begin = 0.0, end = 0.0;  // of t
    Vec3 middle = Vec3::Zero();     // [m]
    double extent = 0.0;            // no point of it is farther from the middle [m]
    double speed = 0.0;             // |dP/dt| is no more [m]
};
std::size_t piecesOf(const Curve& line) noexcept;
/// @pre i < piecesOf(line). rt-safe.
LinePiece pieceOf(const Curve& line, std::size_t i) noexcept;

inline constexpr std::size_t kMostFaces = 16;  // of a lump

/// Material where all of its faces' functions are below 0.
struct Lump {
    std::vector<Face> faces;
};

/// The union of its lumps, with its lines. Edges: where two faces of a lump meet; every convex edge of the part is one,
/// further ones run through material. A thread's ridges are two lumps, one above their middles with the upper flank,
/// one below. Cores: the points, lines and circles about which a sphere's, a cylinder's and a torus' face lie, which
/// touch where no edge is.
struct SmoothSolid {
    std::vector<Lump> lumps;
    std::vector<Curve> edges;
    std::vector<Curve> cores;
};

/// Nothing for a sheet, which has no inside.
std::optional<SmoothSolid> solidOf(const shape::Shape& shape);

// rt-safe.
LinePlace placeAt(const Curve& curve, double t) noexcept;
Vec3 pointOf(const Curve& curve, const LinePlace& at) noexcept;
Vec3 slopeOf(const Curve& curve, const LinePlace& at) noexcept;  // dP/dt
Vec3 bendOf(const Curve& curve, const LinePlace& at) noexcept;   // d²P/dt²
inline Vec3 pointOf(const Curve& curve, double t) noexcept { return pointOf(curve, placeAt(curve, t)); }
inline Vec3 slopeOf(const Curve& curve, double t) noexcept { return slopeOf(curve, placeAt(curve, t)); }

inline constexpr int kCirclePieces = 24;  // between samples of a circle or an arc
inline constexpr int kFixedEvery = 3;     // of those: where a point is looked at wherever the circle lies
/// Parameter of the i-th place of a circle or an arc that is looked at wherever it lies.
double fixedPlace(const Curve& circle, std::size_t i) noexcept;
/// Of an edge with sides.
EdgeFrame frameOf(const Curve& edge, const LinePlace& at) noexcept;

/// Rows of contacts farther away than this are not needed, because a look goes less far, and would be those of a
/// thread's other flank [m]; infinite if it has no thread.
double sightOf(const SmoothSolid& solid) noexcept;

/// It has a thread's flank.
bool isThread(const SmoothSolid& solid) noexcept;

/// How far two places of the line are apart, by t; round a whole circle the shorter way.
inline double apartOn(const Curve& curve, double s, double t) noexcept {
    const double d = std::abs(s - t);
    return curve.isClosed() ? std::min(d, 2.0 * std::numbers::pi - d) : d;
}

/// The largest function of the lump's faces: how far the point is outside, exact beside a face, too small beside an
/// edge.
double valueOf(const Lump& lump, const Vec3& p) noexcept;

/// The same of all lumps: the least.
double valueOf(const SmoothSolid& solid, const Vec3& p) noexcept;

/// No point of the solid is farther from its frame's origin [m].
double reachOf(const SmoothSolid& solid) noexcept;

/// The least distance of two faces of one lump whose material lies between them [m]; infinite if there are none.
double thicknessOf(const SmoothSolid& solid) noexcept;

}  // namespace passung::closed_form
