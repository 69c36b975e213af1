#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/base/result.h"
#include "tests/hard/run.h"

namespace passung::hard {

/// What a run says about its case.
struct Judgement {
    double value = 0.0;       // in the case's unit; least is best
    std::string broken = {};  // what else had to hold and did not; empty: nothing
};

struct Case;

/// Over all seeds.
struct Measured {
    Judgement judgement;
    std::vector<double> us;                                                    // processor time of every tick
    std::uint32_t nodes = 0, points = 0, iterations = 0, rows = 0, turns = 0;  // most of a tick
    double p999_us() const;
    bool met(const Case& c) const;
};

/// A scene file, a device path and one number to hold. `passung simulate` runs the same scene and path.
struct Case {
    const char* name;
    const char* scene;   // in tests/hard/scenes, without its ending
    const char* figure;  // what the number is
    const char* unit;
    double mark;  // met if value ≤ mark
    int seeds, full_seeds;
    double seconds, full_seconds;  // of a run
    Drive (*drive)(const scene::SceneSpec&, std::uint64_t seed);
    Judgement (*judge)(const Run&);
    void (*vary)(scene::SceneSpec&, std::uint64_t seed) = nullptr;  // seed 0 leaves the scene as its file says
    unsigned methods = 0b110;                                       // by ContactMethod: who has to hold the mark
    bool adds = false;                                       // the seeds' numbers are summed up; else the worst counts
    scene::SceneSpec (*solids)(scene::SceneSpec) = nullptr;  // Run::solids, of a scene with meshes
    // Of a case that is no run of a scene: gives its number; what has to do with scenes is then left out.
    Result<Measured> (*compute)() = nullptr;
    // Of seeds above 0: the parts as meshes that lie otherwise in their frames (relaid.h), shapes with this chord error
    // [m]. 0: not so.
    double relaid_chord = 0.0;
    scene::Geometry geometry = scene::Geometry::Field;  // whatever the file says
};

/// The whole table; the order is that of the printed one.
std::span<const Case> cases();
const Case* findCase(const std::string& name);

/// Runs a case with `method`, by default in a reduced size, and judges it. Errors: the scene cannot be read or built.
Result<Measured> measure(const Case& c, scene::ContactMethod method, bool full);

/// What every run has to hold, whatever its number: each tick is finite, within the device's limits of force and torque
/// and below the hard caps of nodes, points and iterations, and the proxy follows the device (follow.h). Returns the
/// first rule that is broken; empty: none is.
std::string brokenRule(const Run& run);

/// The case's own number; besides, no rule may be broken.
Judgement judgeRun(const Case& c, const Run& run);

/// One seed. @pre the case runs a scene.
Result<Run> runCase(const Case& c, scene::ContactMethod method, std::uint64_t seed, bool full);

/// True if PASSUNG_HARD_FULL is in the environment.
bool fullSize();

/// The methods of the table and their names in scene files.
std::span<const std::pair<scene::ContactMethod, const char*>> methods();
inline bool applies(const Case& c, scene::ContactMethod method) { return (c.methods >> static_cast<int>(method)) & 1u; }

/// One line: met or MISSED, name, method, value beside mark, cost.
std::string describe(const Case& c, const char* method, const Measured& measured);

}  // namespace passung::hard
