#include "core/closed_form/circle_samples.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace passung::closed_form {

namespace {

constexpr std::size_t kRoom = CircleSamples::kRoom;

using Row = CircleSamples::Row<double>;

/// Cosines and sines at the samples; those that fill the room up are the last one again.
struct Directions {
    alignas(64) Row cosine{}, sine{};

    Directions() noexcept {
        for (std::size_t i = 0; i < kRoom; ++i) {
            const double t = CircleSamples::parameter(std::min(i, CircleSamples::kPieces));
            cosine[i] = std::cos(t);
            sine[i] = std::sin(t);
        }
    }
};
const Directions kDirections;

/// Sums of three in the order of Eigen's.
PASSUNG_INLINE double sum(double a, double b, double c) noexcept { return (a + b) + c; }

PASSUNG_INLINE void place(const Curve& circle, CircleSamples& s) noexcept {
    const Vec3 &o = circle.centre, &e = circle.e1, &f = circle.e2;
    const double ox = o.x(), oy = o.y(), oz = o.z(), ex = e.x(), ey = e.y(), ez = e.z(), fx = f.x(), fy = f.y(),
                 fz = f.z();
    for (std::size_t i = 0; i < kRoom; ++i) {
        const double c = kDirections.cosine[i], d = kDirections.sine[i];
        s.x[i] = ox + c * ex + d * fx;
        s.y[i] = oy + c * ey + d * fy;
        s.z[i] = oz + c * ez + d * fz;
        s.way_x[i] = c * fx - d * ex;
        s.way_y[i] = c * fy - d * ey;
        s.way_z[i] = c * fz - d * ez;
    }
}

/// How many samples are on the face's axis.
template <Face::Kind kKind>
PASSUNG_INLINE std::int64_t takeFace(const Face& face, std::int64_t number, CircleSamples& s) noexcept {
    const double ox = face.origin.x(), oy = face.origin.y(), oz = face.origin.z();
    const double ax = face.axis.x(), ay = face.axis.y(), az = face.axis.z();
    const double radius = face.radius, along = face.along, out = face.out, sign = face.hollow ? -1.0 : 1.0;
    std::int64_t on_axis = 0;
    for (std::size_t i = 0; i < kRoom; ++i) {
        const double dx = s.x[i] - ox, dy = s.y[i] - oy, dz = s.z[i] - oz;
        const double height = sum(dx * ax, dy * ay, dz * az);
        double value = height, gx = ax, gy = ay, gz = az;
        if constexpr (kKind != Face::Kind::Plane) {
            const double wx = dx - height * ax, wy = dy - height * ay, wz = dz - height * az;
            const double r = std::sqrt(sum(wx * wx, wy * wy, wz * wz));
            on_axis += r <= kOnAxis ? 1 : 0;
            gx = wx / r;
            gy = wy / r;
            gz = wz / r;
            value = r - radius;
            if constexpr (kKind == Face::Kind::Cone) {
                value = out * value + along * height;
                gx = out * gx + along * ax;
                gy = out * gy + along * ay;
                gz = out * gz + along * az;
            }
            value = sign * value;
            gx = sign * gx;
            gy = sign * gy;
            gz = sign * gz;
        }
        const double slope = sum(gx * s.way_x[i], gy * s.way_y[i], gz * s.way_z[i]);
        const bool higher = number == 0 || value > s.value[i];
        s.value[i] = higher ? value : s.value[i];
        s.slope[i] = higher ? slope : s.slope[i];
        s.face[i] = higher ? number : s.face[i];
    }
    return on_axis;
}

PASSUNG_INLINE bool takeAll(const Curve& circle, std::span<const Face* const> faces, CircleSamples& s) noexcept {
    place(circle, s);
    std::int64_t on_axis = 0;
    for (std::size_t k = 0; k < faces.size(); ++k) {
        const Face& face = *faces[k];
        const auto number = static_cast<std::int64_t>(k);
        if (face.kind == Face::Kind::Plane)
            takeFace<Face::Kind::Plane>(face, number, s);
        else if (face.kind == Face::Kind::Cylinder)
            on_axis += takeFace<Face::Kind::Cylinder>(face, number, s);
        else if (face.kind == Face::Kind::Cone)
            on_axis += takeFace<Face::Kind::Cone>(face, number, s);
        else
            return false;
    }
    return on_axis == 0;
}

using TakeFunction = bool (*)(const Curve&, std::span<const Face* const>, CircleSamples&);

bool baseline(const Curve& circle, std::span<const Face* const> faces, CircleSamples& s) noexcept {
    return takeAll(circle, faces, s);
}
PASSUNG_V3 bool v3(const Curve& circle, std::span<const Face* const> faces, CircleSamples& s) noexcept {
    return takeAll(circle, faces, s);
}
PASSUNG_V4 bool v4(const Curve& circle, std::span<const Face* const> faces, CircleSamples& s) noexcept {
    return takeAll(circle, faces, s);
}

TakeFunction runWith(field::Instructions instructions) noexcept {
    return instructions == field::Instructions::V4 ? v4 : instructions == field::Instructions::V3 ? v3 : baseline;
}

const TakeFunction kBest = runWith(field::bestInstructions());

}  // namespace

double CircleSamples::parameter(std::size_t i) noexcept {
    return std::numbers::pi * (2.0 * static_cast<double>(i) / kPieces - 1.0);
}

bool CircleSamples::take(const Curve& circle, std::span<const Face* const> faces) noexcept {
    return kBest(circle, faces, *this);
}

bool CircleSamples::take(const Curve& circle, std::span<const Face* const> faces,
                         field::Instructions instructions) noexcept {
    return runWith(instructions)(circle, faces, *this);
}

}  // namespace passung::closed_form
