#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/geometry/mass_properties.h"
#include "core/geometry/triangle_tree.h"
#include "core/scene/build_store.h"
#include "core/scene/scene_spec.h"
#include "core/shape/thin_features.h"

namespace passung::protocol {

/// A part as geometry alone, part frame.
struct PartSurface {
    Vec3 size = Vec3::Zero();  // [m]
    double area = 0.0;         // of the surface, of shapes roughly: without bores, chamfers, keys [m²]
    bool sheet = false;        // has no inside
    std::string not_closed;    // why it encloses no volume; empty: it does
    std::shared_ptr<const geometry::TriangleTree> tree;  // of a mesh; shared by the parts of one file
    std::shared_ptr<const geometry::TriangleMesh> mesh;  // likewise
    double longest() const { return size.maxCoeff(); }
};

/// The same text for the same geometry.
std::string geometryKey(const scene::PartSpec& part);

/// What a part's shape, or the file of its mesh, is like: each looked at once for all conditions of a study.
class PartGeometries {
public:
    /// `builds` reads meshes if it is a scene::MeshSource; else this process does. It must outlive this.
    explicit PartGeometries(scene::BuildStore* builds = nullptr) : builds_(builds) {}

    /// nullptr if the mesh cannot be read: problems() says why.
    const PartSurface* of(const scene::PartSpec& part);
    Errors problems(const scene::PartSpec& part);

    /// See shape::thinFeatures; one shape::SearchLimit for all questions about one geometry; nothing of a mesh that
    /// cannot be read.
    const std::vector<shape::ThinFeature>& thin(const scene::PartSpec& part, double radius, shape::ThinIn where);

    /// Tells whether a search of thin() ended before it had come to all places.
    bool halfSearched(const scene::PartSpec& part) const { return half_searched_.count(geometryKey(part)) > 0; }

    /// By the part's density; nothing if it encloses no volume, of which notClosed() tells why.
    std::optional<geometry::MassProperties> massOf(const scene::PartSpec& part);
    std::string notClosed(const scene::PartSpec& part);

    /// Signed distance of `p` (part frame) from the part [m], positive outside; of a sheet unsigned. @pre of(part)
    double signedDistance(const scene::PartSpec& part, const Vec3& p);

    /// Part frame [m]. @pre of(part)
    geometry::Bounds boundsOf(const scene::PartSpec& part);

    /// A ball within the part, part frame [m]; a radius below 0 says that there is none.
    struct Ball {
        Vec3 centre = Vec3::Zero();
        double radius = -1.0;
    };
    /// The largest about the part's origin, if that is not outside.
    Ball ballAtOrigin(const scene::PartSpec& part);
    /// The largest that a search of a coarse grid finds.
    Ball largestBall(const scene::PartSpec& part);

    /// A number that takes long to reckon, by whatever tells the question from others; `reckon` is asked once.
    double remembered(const std::string& question, const std::function<double()>& reckon);

private:
    scene::BuildStore* builds_;
    std::map<std::string, std::unique_ptr<PartSurface>> geometries_;
    std::map<std::string, Errors> problems_;  // of those that are null
    std::map<std::string, std::vector<shape::ThinFeature>> thin_;
    std::map<std::string, std::size_t> work_left_;  // for thin()
    std::set<std::string> half_searched_;
    std::map<std::string, double> remembered_;
    std::map<std::string, Ball> balls_;
    std::map<std::string, std::optional<geometry::MassProperties>> unit_masses_;  // of density 1
};

}  // namespace passung::protocol
