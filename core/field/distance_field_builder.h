#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/field/distance_field.h"
#include "core/field/interpolation.h"
#include "core/field/surface_block.h"

/// What builds a DistanceField: distance_field_build.cpp samples and refines, distance_field_errors.cpp says where.
namespace passung::field {

/// Exact φ without the sheet's offset.
struct ExactDistance {
    static constexpr double kLimitSlack = 1.0 + 1e-9;  // for the rounding of a limit d(q) + |p - q|

    const DistanceSource& source;

    /// The unsigned distance, or at least `limit` if it is more.
    double unsignedWithin(const Vec3& p, double limit) const {
        return source.nearest_within ? source.nearest_within(p, limit * kLimitSlack).distance : source.distance(p);
    }

    /// φ at `p`, `way` from a place where it is `known`.
    double from(const Vec3& p, double known, double way) const {
        return signedAt(p, unsignedWithin(p, std::abs(known) + way), known, way);
    }

    /// As `from`; `nearest` is the surface's nearest point there, then here: seldom much farther away than need be.
    double along(const Vec3& p, double known, double way, Vec3& nearest) const {
        if (!source.nearest_within) return from(p, known, way);
        const double limit = std::min(std::abs(known) + way, (p - nearest).norm());
        const DistanceSource::Nearest found = source.nearest_within(p, limit * kLimitSlack);
        if (found.distance < limit * kLimitSlack) nearest = found.point;
        return signedAt(p, found.distance, known, way);
    }

    double signedAt(const Vec3& p, double d, double known, double way) const {
        if (source.open_sheet) return d;
        // On closed geometry a point farther from the surface than from its neighbour lies on the neighbour's side.
        const bool inside = source.closed && std::abs(known) > way ? known < 0.0 : source.inside(p);
        return inside ? -d : d;
    }

    double at(const Vec3& p) const {
        const double d = source.distance(p);
        return !source.open_sheet && source.inside(p) ? -d : d;
    }
};

/// Builds a field: the coarse grid, bricks in the band, then level by level those that replace octants.
struct DistanceField::Builder {
    using Nodes = std::array<double, kBrickSamples>;

    /// An octant that errs too much.
    struct Request {
        std::int32_t brick;
        unsigned octant;
        double depth;  // |φ| where that was seen
    };

    DistanceField& field;
    const ExactDistance exact;
    const FieldAccuracy& accuracy;
    const double band;
    std::vector<Vec3> low{};  // corner of each brick
    std::size_t first = 0;    // brick of the level that was built last
    int level = 0;            // that level
    double cell = 0.0;        // of it
    /// For each octant of each brick of the level: |φ| where it must be refined, or infinity.
    std::vector<std::array<double, 8>> wrong{};

    static std::size_t node(int x, int y, int z) {
        return static_cast<std::size_t>((z * kBrickNodes + y) * kBrickNodes + x);
    }

    void sampleCoarse();
    void placeBricks();
    void sampleLevel();
    void sampleBrick(std::size_t brick);
    double allowed(double phi) const;
    SurfaceBlock blockAt(const Vec3& corner) const;
    Nodes store(std::size_t brick, const Nodes& phi);
    double distanceIn(const CornerValues& values, std::span<const std::uint32_t> triangles, const Vec3& origin,
                      const Vec3& u) const;
    static Nodes bends(const Nodes& nodes);
    double errorOf(const CornerValues& values, const Vec3& u, double distance) const;
    double wrongDepth(const Nodes& nodes, const Nodes& bends, const SurfaceBlock& block, const Vec3& corner, int x,
                      int y, int z) const;
    std::array<double, 8> measure(const Nodes& nodes, const SurfaceBlock& block, const Vec3& corner) const;
    std::array<double, 8> inBand(const Vec3& corner) const;
    void measureLandmarks();
    bool refine();
};

}  // namespace passung::field
