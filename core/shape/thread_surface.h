#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "core/shape/thread.h"

namespace passung::shape {

/// The threaded face of a bolt or nut with its chamfers: in each half plane a line r(z) from `low` to `high`, whose
/// straight pieces move with the angle.
struct ThreadSurface {
    /// A 45° chamfer: r = base + slope z.
    struct Cone {
        double base, slope;
    };
    /// An end of a straight piece, and where it goes as φ grows.
    struct Knot {
        double z, r;
        double z_by_phi, r_by_phi;  // [m/rad]
    };

    ThreadForm form;
    double low, high;      // of z [m]
    bool hole;             // the least radius of the profile and the cones counts of a bolt, the largest of a hole
    double chamfer = 0.0;  // no cone counts farther from an end
    double around = 0.0;   // radius of the outside of what has the hole
    std::array<ThreadForm::Line, 4> lines = form.lines();
    std::array<Cone, 2> cones{};
    std::size_t cone_count = 0;

    double radiusAt(double z, double phi) const {
        double r = form.radiusAt(z - form.lead() * phi);
        for (std::size_t i = 0; i < cone_count; ++i) {
            const double cone = cones[i].base + cones[i].slope * z;
            r = hole ? std::max(r, cone) : std::min(r, cone);
        }
        return r;
    }

    /// Calls f(from, to) for the straight pieces between two heights, upwards.
    template <class F>
    void eachPiece(double phi, double from, double to, const F& f) const {
        from = std::max(from, low);
        to = std::min(to, high);
        const double lead = form.lead(), climb = lead * phi;
        for (double turn = std::floor((from - climb) / form.pitch - 0.625);
             turn * form.pitch + climb < to + 0.375 * form.pitch; turn += 1.0) {
            const double middle = climb + turn * form.pitch;  // of a ridge
            for (const ThreadForm::Line& line : lines) {
                if (middle + line.end <= from || middle + line.begin >= to) continue;
                const Straight straight{line.at_zero - line.slope * middle, line.slope, -line.slope * lead};
                split({middle + line.begin, lead}, {middle + line.end, lead}, straight, from, to, 0, f);
            }
        }
    }

private:
    /// r = base + slope z at one angle, and how the base changes with that.
    struct Straight {
        double base, slope, base_by_phi;
    };
    struct Height {
        double z, by_phi;
    };

    Knot knot(const Height& at, const Straight& line) const {
        return {at.z, line.base + line.slope * at.z, at.by_phi, line.base_by_phi + line.slope * at.by_phi};
    }

    /// The piece of `line` between two heights, where it meets the cones from number `first` on.
    template <class F>
    void split(Height begin, Height end, const Straight& line, double from, double to, std::size_t first,
               const F& f) const {
        if (begin.z < from) begin = {from, 0.0};
        if (end.z > to) end = {to, 0.0};
        if (!(end.z > begin.z)) return;
        if (first == cone_count) {
            f(knot(begin, line), knot(end, line));
            return;
        }
        const Straight cone{cones[first].base, cones[first].slope, 0.0};
        const double turned = hole ? -1.0 : 1.0;
        const auto beyond = [&](double z) { return turned * (line.base - cone.base + (line.slope - cone.slope) * z); };
        const double b = beyond(begin.z), e = beyond(end.z);  // > 0: the cone counts
        if (b <= 0.0 && e <= 0.0) return split(begin, end, line, from, to, first + 1, f);
        if (b >= 0.0 && e >= 0.0) return split(begin, end, cone, from, to, first + 1, f);
        const double apart = cone.slope - line.slope;
        const Height cross{(line.base - cone.base) / apart, line.base_by_phi / apart};
        split(begin, cross, b > 0.0 ? cone : line, from, to, first + 1, f);
        split(cross, end, e > 0.0 ? cone : line, from, to, first + 1, f);
    }
};

ThreadSurface surfaceOf(const ThreadBolt& bolt);
ThreadSurface surfaceOf(const ThreadNut& nut);

double distanceTo(const ThreadBolt& bolt, const Vec3& p);
double distanceTo(const ThreadNut& nut, const Vec3& p);

geometry::TriangleMesh tessellateShape(const ThreadBolt& bolt, double chord_error);
geometry::TriangleMesh tessellateShape(const ThreadNut& nut, double chord_error);
double reachedError(const ThreadBolt& bolt, double asked);
double reachedError(const ThreadNut& nut, double asked);

}  // namespace passung::shape
