#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/types.h"
#include "core/geometry/mesh.h"
#include "core/shell/sphere_tree.h"

namespace passung::shell {

/// The sharp edges of a surface that stand out of it, and its borders, as curves; part frame, metres. Samples alone do
/// not keep two edges apart: crossing at an angle they pass each other between the samples, by as much as those are
/// apart; and a rim of radius r sags by gap²/(8 r) between two of its own.
///   A curve runs through the mesh's own vertices from corner to corner, or once round. On it lie stations, at most the
/// spacing asked for apart; a stretch is some of them that follow each other. Inner edges (of a groove) are left out:
/// what touches them touches a face beside them.
class EdgeCurves {
public:
    static constexpr std::uint32_t kStretchStations = 16;  // at most, of one stretch; those beside it not counted

    EdgeCurves(const geometry::TriangleMesh& mesh, double spacing);

    /// Of all curves, one after the other; a curve that runs round repeats its first stations at its end.
    std::span<const Vec3> vertices() const { return vertices_; }
    /// The vertex of each station. Between two stations of a curve lie the vertices between these.
    std::span<const std::uint32_t> stations() const { return stations_; }
    /// Positions of the stations.
    const FloatPositions& positions() const { return positions_; }
    /// Length of the curve from each station to the next of its curve [m], rounded up.
    std::span<const float> gaps() const { return gaps_; }

    struct Stretch {
        std::uint32_t first, count;  // its stations
        bool begins, ends;           // no station of the curve comes before, after them: a corner
    };
    std::span<const Stretch> stretches() const { return stretches_; }
    /// Spheres around the stretches, as far as to the stations beside them; radii rounded up.
    const FloatPositions& centres() const { return centres_; }
    std::span<const float> radii() const { return radii_; }

private:
    void addCurve(std::vector<Vec3> line, bool closed, double spacing);
    void addStretches(std::uint32_t first, std::uint32_t count, bool closed);

    std::vector<Vec3> vertices_;
    std::vector<std::uint32_t> stations_;
    FloatPositions positions_, centres_;
    std::vector<float> gaps_, radii_;
    std::vector<Stretch> stretches_;
};

}  // namespace passung::shell
