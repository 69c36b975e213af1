#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/base/tick_record.h"
#include "core/scene/mesh_source.h"
#include "core/scene/scene_spec.h"
#include "study/plan/study_plan.h"
#include "ui/presenter/shaded_mesh.h"
#include "ui/presenter/task_marks.h"

namespace passung::presenter {

/// Where the scene is looked at from. The camera's own axes: x to the right, y up, looking along -z.
struct Camera {
    Pose X_WC;
    Vec3 centre = Vec3::Zero();    // that it looks at
    double opening = 0.5;          // vertical angle [rad]
    double near = 0.0, far = 1.0;  // [m]

    /// Metres of the plane through the centre that a pixel of a picture so many pixels high shows.
    double metresPerPixel(double height_px) const;
};

struct DrawnPart {
    std::shared_ptr<const ShadedMesh> mesh;      // shared_ptr: scenes of a study have parts in common
    Pose X_W;                                    // as it is drawn; of a part in a hand at the start
    bool held = false;                           // by the first hand
    std::optional<std::size_t> other_hand = {};  // that holds it, among the others
    bool pickable = false;
    Vec3 shown_offset = Vec3::Zero();  // drawn so far from where it is, world axes [m]
};

/// What a scene with parts that hands pick up needs beside its parts.
struct DrawnPicking {
    std::vector<Pose> X_WHands;                // where each hand starts
    scene::Registration registration;          // of the first hand
    scene::Pick pick;                          // with the steps of an assembly
    std::vector<std::string> step_names = {};  // of these; may be shorter
    bool hints = false;                        // goals of the steps that may be done next are drawn
    double hint_after = 0.0;                   // [s] without a step done until a hint comes up; 0: never
};

/// What a participant sees of a condition's scene.
struct DrawnScene {
    std::vector<DrawnPart> parts;
    std::size_t held = 0;                 // by the first hand from the start; kNothing: it begins empty
    std::optional<DrawnPicking> picking;  // none: every hand keeps what it holds
    Vec3 held_offset = Vec3::Zero();      // drawn so far from where it is, world axes [m]
    plan::ShownPose shown = plan::ShownPose::Proxy;
    bool hidden_in_trial = false;  // not drawn to the participant from the trial's start on
    plan::Cues cues;
    plan::View appearance;
    std::vector<Mark> marks;
    std::optional<std::size_t> target_hand;  // among the others: marks are where they are when its part starts
    double floor = 0.0;                      // height of the ground [m]
    double radius = 0.1;                     // of everything about the camera's centre [m]
    Camera camera;
    Vec3 light_from = Vec3::UnitZ();  // towards the light that casts shadows, length 1

    static constexpr std::size_t kNothing = ~std::size_t{0};
    /// Where the first hand starts, or its part as it is drawn.
    Pose startPose() const;
};

/// Where either pose of the held part is drawn in a tick.
Pose poseOf(const DrawnScene& scene, const TickRecord& record, plan::ShownPose which);
/// Where the part of another hand is drawn in a tick of that hand.
Pose shownPoseOfOther(const DrawnScene& scene, const TickRecord& record);
/// Where the held part is drawn in a tick.
Pose shownPose(const DrawnScene& scene, const TickRecord& record);

/// What a pointer moves, in a tick: the held part where the device asks it to be, or of a hand that picks parts up what
/// its registration puts into the handle, whichever part the hand holds.
Pose pointerPose(const DrawnScene& scene, const TickRecord& record);

/// Turns conditions into what is drawn; keeps the surfaces that it has made.
class SceneArtist {
public:
    /// `builds`, if there is one, reads the meshes; it outlives the artist.
    explicit SceneArtist(scene::BuildStore* builds = nullptr) : builds_(builds) {}
    /// Errors: a mesh that cannot be read.
    Result<std::shared_ptr<const DrawnScene>> draw(const plan::Condition& condition, const plan::View& appearance);

private:
    Result<std::shared_ptr<const ShadedMesh>> surfaceOf(const scene::PartSpec& part);
    std::shared_ptr<const ShadedMesh> ringAround(const ShadedMesh& held);
    std::vector<Mark> marksOf(const plan::Task& task, const Pose& X_WTarget, const DrawnScene& scene);

    scene::BuildStore* builds_;
    std::map<std::string, std::shared_ptr<const ShadedMesh>> surfaces_;  // by what they are made from
};

}  // namespace passung::presenter
