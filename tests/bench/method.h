#pragma once

#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/base/types.h"
#include "core/geometry/mesh.h"
#include "core/scene/part.h"

namespace passung::bench {

inline constexpr double kNotGiven = std::numeric_limits<double>::quiet_NaN();

/// What a method says about one pose; what it does not say is NaN.
struct Answer {
    double signed_distance = kNotGiven;  // [m]; negative: depth
    double error_bound = kNotGiven;      // of that, as the method states it [m]
    Wrench wrench{Vec3::Constant(kNotGiven), Vec3::Constant(kNotGiven)};
    double contacts = kNotGiven;
};

/// One way of asking how the tool lies to the bunny. Built once, then asked pose after pose.
class Method {
public:
    virtual ~Method() = default;
    /// `X_FS`: the tool in the bunny.
    virtual Answer at(const Pose& X_FS) = 0;
};

/// A method ready to be measured.
struct Candidate {
    std::string name;
    std::string settings = {};
    std::unique_ptr<Method> method = nullptr;
    double build_s = kNotGiven;       // one-off work, single figure
    double memory_bytes = kNotGiven;  // of what was built
    bool ours = false;
    bool two_way = false;  // compare with the truth of both ways
};

/// The peers. Each in its own translation unit, for their headers.
Candidate fclAllContacts(const geometry::TriangleMesh& field, const geometry::TriangleMesh& shell);
Candidate fclDistance(const geometry::TriangleMesh& field, const geometry::TriangleMesh& shell);
Candidate odeTrimesh(const geometry::TriangleMesh& field, const geometry::TriangleMesh& shell);
Candidate bulletGimpact(const geometry::TriangleMesh& field, const geometry::TriangleMesh& shell);
/// A level set of the field sampled at every point of a shell: brute force, no tree.
Candidate openvdbPoints(const geometry::TriangleMesh& field, double cell, std::span<const shell::SurfacePoint> points);

/// OpenVDB's level set alone, for sampling and building.
class LevelSet {
public:
    virtual ~LevelSet() = default;
    /// φ at X · p of every point, trilinear.
    virtual void sample(const Pose& X, std::span<const Vec3> points, std::span<double> phi) const = 0;
    virtual double memoryBytes() const = 0;
};
/// With a band of `band_cells` on each side.
std::unique_ptr<LevelSet> buildLevelSet(const geometry::TriangleMesh& mesh, double cell, double band_cells);

}  // namespace passung::bench
