#include "tests/hard/relaid.h"

#include <fmt/format.h>

#include "core/base/random.h"
#include "core/import/mesh_import.h"
#include "tests/support/off_file.h"
#include "tests/support/temp_folder.h"

namespace passung::hard {

namespace {

Result<geometry::TriangleMesh> meshOf(const scene::PartSpec& part, double chord_error) {
    if (const auto* shape = std::get_if<shape::Shape>(&part.geometry)) return shape::tessellate(*shape, chord_error);
    const auto& file = std::get<scene::MeshFile>(part.geometry);
    auto imported = importer::importMesh(file.path, file.metres_per_unit);
    if (!imported) return imported.errors();
    return std::move(imported->mesh);
}

}  // namespace

Result<Relaid> relaid(const scene::SceneSpec& spec, std::uint64_t seed, double chord_error) {
    static const test::TempFolder folder;  // parts are built from it as long as the program runs
    static int files = 0;
    Random random(streamSeed("hard", "", "", "relaid", seed));
    const auto three = [&] { return Vec3(random.normal(), random.normal(), random.normal()); };
    Relaid result{spec, Pose{}};
    for (scene::PartSpec& part : result.spec.parts) {
        auto mesh = meshOf(part, chord_error);
        if (!mesh) return mesh.errors();
        const Pose X_PN{Quat(random.normal(), random.normal(), random.normal(), random.normal()).normalized(),
                        1e-3 * three().normalized()};
        for (Vec3& v : mesh->vertices) v = X_PN.inverse() * v;
        const std::string path = folder / fmt::format("{}.off", files++);
        test::writeOff(path, *mesh);
        part.geometry = scene::MeshFile{path, 1.0};
        part.X_WP = part.X_WP * X_PN;
        if (part.held) result.X_HN = X_PN;
    }
    result.spec.registration.X_DH = result.spec.registration.X_DH * result.X_HN;
    return result;
}

}  // namespace passung::hard
