#include "core/scene/contact_geometry.h"

#include <gtest/gtest.h>

#include <array>
#include <tuple>

namespace passung::scene {
namespace {

PartSpec shaped(bool held, double friction = 0.0) {
    PartSpec part;
    part.name = held ? "held" : "still";
    part.geometry = shape::Shape(shape::Box{0.02, 0.02, 0.02});
    part.held = held;
    part.friction = friction;
    return part;
}

PartSpec meshed(bool held, double friction = 0.0) {
    PartSpec part = shaped(held, friction);
    part.geometry = MeshFile{.path = "part.off"};
    return part;
}

PartSpec sheet() {
    PartSpec part = shaped(false);
    part.geometry = shape::Shape(shape::Sheet{0.1, 0.1});
    return part;
}

SceneSpec sceneOf(std::vector<PartSpec> parts, ContactMethod method, double filter = 0.0) {
    SceneSpec scene;
    scene.parts = std::move(parts);
    scene.contact.method = method;
    scene.contact.proxy_filter = filter;
    return scene;
}

TEST(ContactGeometry, AutoIsTheTruestThatAllPairsCanHave) {
    // Truth: reference: the rule of contact.geometry = "auto" as protocols/KEYS.md states it, pair by pair.
    constexpr auto kPenalty = ContactMethod::Penalty;
    constexpr std::array kGodObjects{ContactMethod::GodObject, ContactMethod::GodObjectHeuristic};
    const auto of = [](const SceneSpec& scene) { return geometryOf(scene).geometry; };
    for (const ContactMethod method : kGodObjects) {
        EXPECT_EQ(of(sceneOf({shaped(true), shaped(false)}, method)), Geometry::ClosedForm);
        EXPECT_EQ(of(sceneOf({meshed(true), shaped(false)}, method)), Geometry::Surface);
        EXPECT_EQ(of(sceneOf({shaped(true), meshed(false)}, method)), Geometry::Surface);
        EXPECT_EQ(of(sceneOf({shaped(true), sheet()}, method)), Geometry::Surface);
        EXPECT_EQ(of(sceneOf({shaped(true), shaped(false), meshed(false)}, method)), Geometry::Surface);
        EXPECT_EQ(of(sceneOf({shaped(true, 0.3), shaped(false, 0.3)}, method)), Geometry::Surface);
        EXPECT_EQ(of(sceneOf({meshed(true, 0.3), meshed(false, 0.3)}, method)), Geometry::Surface);
        EXPECT_EQ(of(sceneOf({shaped(true, 0.3), shaped(false)}, method)), Geometry::ClosedForm)
            << "one part is smooth";
        EXPECT_EQ(of(sceneOf({shaped(true, 0.3), meshed(false), shaped(false, 0.3)}, method)), Geometry::Surface);
        EXPECT_EQ(of(sceneOf({shaped(true, 0.3), shaped(false, 0.3)}, method, 20.0)), Geometry::Field);
        EXPECT_EQ(of(sceneOf({meshed(true), meshed(false)}, method, 20.0)), Geometry::Field);
    }
    const auto part = [](bool held, const shape::Shape& shape) {
        PartSpec spec = shaped(held);
        spec.geometry = shape;
        return spec;
    };
    const shape::Shape bolt = shape::ThreadBolt{0.008, 0.00125, 0.02, 0.0},
                       nut = shape::ThreadNut{0.0081, 0.00125, 0.013, 0.0065, 0.0}, box = shape::Box{0.02, 0.02, 0.02};
    constexpr auto kGodObject = ContactMethod::GodObject;
    for (const auto& [held, still, geometry] :
         {std::tuple(bolt, nut, Geometry::ClosedForm), std::tuple(nut, bolt, Geometry::ClosedForm),
          std::tuple(bolt, bolt, Geometry::Surface), std::tuple(nut, nut, Geometry::Surface),
          std::tuple(bolt, box, Geometry::Surface), std::tuple(box, nut, Geometry::Surface)})
        EXPECT_EQ(of(sceneOf({part(true, held), part(false, still)}, kGodObject)), geometry)
            << shape::kindName(held) << " and " << shape::kindName(still);
    EXPECT_FALSE(geometryProblem(sceneOf({part(true, bolt), part(false, nut)}, kGodObject)));
    EXPECT_FALSE(geometryProblem(sceneOf({part(true, bolt), part(false, box)}, kGodObject)));
    EXPECT_TRUE(geometryProblem(sceneOf({part(true, bolt), part(false, nut)}, kPenalty))) << "no field of a thread";
    EXPECT_TRUE(geometryProblem(sceneOf({part(true, bolt), part(false, box)}, kGodObject, 20.0)));
    for (const PartSpec& still : {shaped(false), meshed(false), sheet()})
        EXPECT_EQ(of(sceneOf({shaped(true), still}, kPenalty)), Geometry::Field);
}

}  // namespace
}  // namespace passung::scene
