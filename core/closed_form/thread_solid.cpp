#include "core/closed_form/thread_solid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/closed_form/solid_parts.h"
#include "core/shape/thread.h"

namespace passung::closed_form {

namespace {

using shape::ThreadForm;

constexpr double kNearAxis = 0.7506;  // of a pitch times a flank's cosine, inside a nut's crests: flanks cease to count

constexpr double kSame = 1e-12;  // [m]

struct Span {
    double low, high;

    Span within(const Span& other) const { return {std::max(low, other.low), std::min(high, other.high)}; }
    bool isEmpty() const { return !(high > low); }
    /// Where base + slope x lies in this; of a constant all x or none.
    Span where(double base, double slope) const {
        constexpr double kAll = std::numeric_limits<double>::infinity();
        if (slope == 0.0) return base >= low - kSame && base <= high + kSame ? Span{-kAll, kAll} : Span{0.0, 0.0};
        const double a = (low - base) / slope, b = (high - base) / slope;
        return {std::min(a, b), std::max(a, b)};
    }
};

Curve spiral(const Span& t, double radius, double widening, double z, double climb) {
    Curve curve;
    curve.kind = Curve::Kind::Spiral;
    curve.centre = {0.0, 0.0, z};
    curve.e1 = Vec3::UnitX();
    curve.e2 = Vec3::UnitY();
    curve.e3 = Vec3::UnitZ();
    curve.begin = t.low;
    curve.end = t.high;
    curve.radius = radius;
    curve.widening = widening;
    curve.climb = climb;
    return curve;
}

Curve circle(double radius, double z) {
    Curve curve;
    curve.kind = Curve::Kind::Circle;
    curve.centre = {0.0, 0.0, z};
    curve.e1 = radius * Vec3::UnitX();
    curve.e2 = radius * Vec3::UnitY();
    curve.end = std::numbers::pi;
    return curve;
}

/// Edges of a threaded face with the profile r(ζ), ζ = z - lead t.
class ThreadEdges {
public:
    ThreadEdges(const ThreadForm& form, SmoothSolid& solid) : form_(form), lead_(form.lead()), solid_(solid) {}

    /// Along both edges of the crests, which are at ±half, at a radius.
    void alongCrests(double radius, double half, const Span& z) {
        for (const double zeta : {-half, half})
            add(spiral({(z.low - zeta) / lead_, (z.high - zeta) / lead_}, radius, 0.0, zeta, lead_));
    }
    /// Where the plane at z cuts the profile between two radii.
    void acrossPlane(double z, const Span& r) {
        if (r.low > r.high) return;
        for (const ThreadForm::Line& line : form_.lines()) {
            const Span zeta = Span{line.begin, line.end}.within(r.where(line.at_zero, line.slope));
            // r = at_zero + slope (z - lead t)
            if (!zeta.isEmpty())
                add(spiral({(z - zeta.high) / lead_, (z - zeta.low) / lead_}, line.at_zero + line.slope * z,
                           -line.slope * lead_, z, 0.0));
        }
    }
    /// Where the cone r = base + slope z cuts the profile between two heights.
    void acrossCone(double base, double slope, const Span& z) {
        for (const ThreadForm::Line& line : form_.lines()) {
            // at_zero + line.slope (z - lead t) = base + slope z
            const double at_zero = (line.at_zero - base) / (slope - line.slope);
            const double climb = -line.slope * lead_ / (slope - line.slope);
            const Span t = z.where(at_zero, climb).within(Span{line.begin, line.end}.where(at_zero, climb - lead_));
            if (!t.isEmpty()) add(spiral(t, base + slope * at_zero, slope * climb, at_zero, climb));
        }
    }
    /// The circle where a chamfer ends in a plane, as far as it lies on the side of the profile that is named.
    void chamferEnd(double radius, double z, bool within) {
        const bool all = within ? radius <= form_.inner : radius >= form_.outer;
        const bool none = within ? radius >= form_.outer : radius <= form_.inner;
        if (none) return;
        if (all) {
            add(circle(radius, z));
            return;
        }
        const double half = form_.halfRidge(radius);
        const Span zeta = within ? Span{-half, half} : Span{half, form_.pitch - half};
        add(spiral({(z - zeta.high) / lead_, (z - zeta.low) / lead_}, radius, 0.0, z, 0.0));
    }

private:
    void add(const Curve& curve) { solid_.edges.push_back(curve); }

    const ThreadForm& form_;
    double lead_;
    SmoothSolid& solid_;
};

/// Two lumps with the faces of `ridge` and a flank each.
void addRidges(const ThreadForm& form, double middle, bool hollow, const Lump& ridge, SmoothSolid& solid) {
    const double least = form.inner - kNearAxis * form.pitch / std::sqrt(1.0 + form.run * form.run);
    for (const bool above : {true, false}) {
        Lump& lump = solid.lumps.emplace_back(ridge);
        lump.faces.push_back(flank(form.pitch, form.evenRadius(), form.run, middle, above, hollow, least));
    }
}

/// Its outside, with both rims.
void addRing(const shape::ThreadNut& nut, Lump& lump, SmoothSolid& solid) {
    const double radius = 0.5 * nut.outer_diameter;
    lump.faces.push_back(cylinder(Vec3::Zero(), Vec3::UnitZ(), radius));
    for (const double end : {0.0, -nut.height}) solid.edges.push_back(circle(radius, end));
}

}  // namespace

SmoothSolid threadSolid(const shape::ThreadBolt& bolt) {
    const ThreadForm form = shape::threadOf(bolt);
    SmoothSolid solid;
    Lump ends;
    addEnds(0.0, bolt.length, ends);
    const double tip = form.outer - bolt.chamfer;
    if (bolt.chamfer > 0.0) ends.faces.push_back(cone(Vec3::Zero(), Vec3::UnitZ(), tip, 1.0));
    Lump core = ends, ridge = ends;
    core.faces.push_back(cylinder(Vec3::Zero(), Vec3::UnitZ(), form.inner));
    ridge.faces.push_back(cylinder(Vec3::Zero(), Vec3::UnitZ(), form.outer));
    solid.lumps.push_back(core);
    addRidges(form, 0.0, false, ridge, solid);

    ThreadEdges edges(form, solid);
    edges.alongCrests(form.outer, form.crest(), {bolt.chamfer, bolt.length});
    edges.acrossPlane(bolt.length, {0.0, form.outer});
    edges.acrossPlane(0.0, {0.0, tip});
    if (bolt.chamfer > 0.0) {
        edges.chamferEnd(tip, 0.0, true);
        edges.acrossCone(tip, 1.0, {0.0, bolt.chamfer});
    }
    return solid;
}

SmoothSolid threadSolid(const shape::ThreadNut& nut) {
    const ThreadForm form = shape::threadOf(nut);
    SmoothSolid solid;
    Lump around;
    addEnds(-nut.height, 0.0, around);
    addRing(nut, around, solid);
    const double mouth = form.inner + nut.chamfer;
    if (nut.chamfer > 0.0) {
        around.faces.push_back(cone(Vec3::Zero(), Vec3::UnitZ(), mouth, 1.0, true));
        around.faces.push_back(cone({0, 0, -nut.height}, Vec3::UnitZ(), mouth, -1.0, true));
    }
    Lump wall = around, ridge = around;
    wall.faces.push_back(cylinder(Vec3::Zero(), Vec3::UnitZ(), form.outer, true));
    ridge.faces.push_back(cylinder(Vec3::Zero(), Vec3::UnitZ(), form.inner, true));
    solid.lumps.push_back(wall);
    addRidges(form, 0.5 * form.pitch, true, ridge, solid);

    ThreadEdges edges(form, solid);
    edges.alongCrests(form.inner, form.root(), {nut.chamfer - nut.height, -nut.chamfer});
    for (const double end : {0.0, -nut.height}) {
        edges.acrossPlane(end, {mouth, form.outer});
        if (!(nut.chamfer > 0.0)) continue;
        edges.chamferEnd(mouth, end, false);
        if (end == 0.0)
            edges.acrossCone(mouth, 1.0, {-nut.chamfer, 0.0});
        else
            edges.acrossCone(mouth - nut.height, -1.0, {-nut.height, nut.chamfer - nut.height});
    }
    return solid;
}

}  // namespace passung::closed_form
