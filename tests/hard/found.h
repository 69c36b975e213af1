#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/geometry/mesh.h"
#include "tests/hard/run.h"

/// What was found to be wrong with contact at points (issue 19): scenes and hands' paths on the program's own choice of
/// geometry, each with its figures then and now.
namespace passung::hard {

/// A number beside its mark.
struct Figure {
    std::string name, unit;
    double value = 0.0, mark = 0.0;  // met if value ≤ mark
    bool holds = false;              // a test asserts it; what is missed of the others is printed as missed
    std::string was = {};            // the figure of contact at points, where it was found
    bool met() const { return value <= mark; }
};

/// A scene, a hand and, of meshes, the triangles that were written into its files.
struct FoundScene {
    scene::SceneSpec spec;
    std::function<Pose(double)> hand;                 // X_WH of the time [s]
    geometry::TriangleMesh held = {}, obstacle = {};  // empty: the parts are shapes; the obstacle's in the world
};

/// What was measured, over all seeds.
struct FoundMeasured {
    std::vector<Figure> figures;
    std::vector<double> us;  // processor time of every tick, the least of its runs
    std::size_t poses = 0;   // that geometry judged
};

/// Texts of the issue; empty where it has none.
struct Was {
    const char* overlap = "";
    const char* step = "";
    const char* time = "";
};

struct Found {
    const char* name;
    Result<FoundScene> (*make)(std::uint64_t seed);  // null: `compute` is asked
    Was was = {};
    unsigned methods = 0b100;  // by ContactMethod; on triangles both god objects make the same steps
    double seconds = 1.2, full_seconds = 20.0;
    int full_seeds = 5;
    double most_step = 0.1;         // of the spring's force from tick to tick, beyond the hand's own [N]
    double most_us = 800.0;         // of a tick at p99.9
    double most_axial = 0.0;        // of a tilted peg: force along its bore [N]; 0: not asked
    double most_off = 0.0;          // of the force from force_reference.h [N]; 0: not asked
    std::size_t way_every = 1;      // ticks whose way is judged, in the short version
    bool snaps = false;             // over edges: how deep the way between accepted poses goes is told, not asserted
    bool may_be_suspended = false;  // threads of meshes: the lag behind the hand is stated, no mark on it
    bool outruns = false;           // the hand is faster than any proxy may be: that it comes after late is no fault
    Result<FoundMeasured> (*compute)(scene::ContactMethod, bool full) = nullptr;
};

/// The whole table; the order is that of the printed one.
std::span<const Found> foundCases();

/// Of scene files with shapes (found_shapes.cpp), of meshes (found_meshes.cpp), and of starts and budgets
/// (found_others.cpp).
std::vector<Found> foundShapes();
std::vector<Found> foundMeshes();
std::vector<Found> foundOthers();

/// Judges one case with one method; a tick's time is the least of so many `runs` of the same motion. By default in a
/// short version. Errors: its scene cannot be read or built.
Result<FoundMeasured> measureFound(const Found& found, scene::ContactMethod method, bool full, int runs);

/// Of a scene's seed and that of its first path: seed 0 is that one.
inline std::uint64_t pathSeed(std::uint64_t first, std::uint64_t seed) { return first + 100 * seed; }

/// A scene file's shapes, led by `hand` from where the held part starts.
Result<FoundScene> foundScene(const std::string& file, const std::function<Pose(const Pose& start, double t)>& hand);

/// Two meshes, written into files that last as long as the program; `name` stands for them.
FoundScene meshScene(const std::string& name, const geometry::TriangleMesh& held,
                     const geometry::TriangleMesh& obstacle, const std::function<Pose(double)>& hand);

/// Its path, for runScene.
Drive driveOf(const FoundScene& scene);

/// Lines: met or MISSED, case, method, figure beside mark, and what it was.
std::string describe(const Found& found, const char* method, const FoundMeasured& measured);

}  // namespace passung::hard
