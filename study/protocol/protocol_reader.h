#pragma once

#include <span>
#include <string>

#include "core/base/device_description.h"
#include "core/base/result.h"
#include "core/scene/build_store.h"
#include "study/plan/study_plan.h"

namespace passung::protocol {

/// Reads a study file: checks everything and expands it to conditions that are ready to run. `devices` are the known
/// presets, `known_measures` the names that `measures` may list. All problems are collected, each with its place.
/// `builds` reads the meshes whose size and features are judged if it is a scene::MeshSource; else this process does.
Result<plan::StudyPlan> readProtocol(const std::string& path, std::span<const DeviceDescription> devices,
                                     std::span<const std::string> known_measures, scene::BuildStore* builds = nullptr);

/// The same with what could be read of a study that is not sound.
struct Examined {
    plan::StudyPlan plan;  // complete if there are no errors; else conditions as far as they go, for their files
    Errors errors;
    Errors for_people;  // what keeps people, but not simulated participants, from taking part
};
Examined examineProtocol(const std::string& path, std::span<const DeviceDescription> devices,
                         std::span<const std::string> known_measures, scene::BuildStore* builds = nullptr);

/// The same as readProtocol() for a text that stands for the file `path` (names in messages and the base of other
/// paths). The files of questionnaires are not opened: see loadQuestionnaires().
Result<plan::StudyPlan> readProtocolText(const std::string& text, const std::string& path,
                                         std::span<const DeviceDescription> devices,
                                         std::span<const std::string> known_measures,
                                         scene::BuildStore* builds = nullptr);

/// The same for a study that began, maybe under an earlier version of this program: what no longer may begin, because a
/// person could not do it, feel it or tell conditions apart, or for the length of a name, may still go on and be looked
/// at. `automatic`: what a geometry of contact that the text leaves to the program stands for.
Result<plan::StudyPlan> readBegunProtocol(const std::string& text, const std::string& path,
                                          std::span<const DeviceDescription> devices,
                                          std::span<const std::string> known_measures,
                                          scene::BuildStore* builds = nullptr,
                                          scene::Geometry automatic = scene::Geometry::Auto);

}  // namespace passung::protocol
