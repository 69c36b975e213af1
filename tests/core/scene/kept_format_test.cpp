#include <gtest/gtest.h>

#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/digest.h"
#include "core/scene/part.h"

namespace passung::scene {
namespace {

/// Keeps nothing; everything that it is given goes into one digest, with its name.
struct DigestStore : BuildStore {
    Sha256 digest;
    int kept = 0;
    std::optional<std::string> load(const std::string&) override { return std::nullopt; }
    void keep(const std::string& name, std::string_view bytes) override {
        ++kept;
        digest.update(name);
        digest.update(bytes);
    }
};

/// A tetrahedron whose vertices lie on no grid, in millimetres.
MeshFile tetrahedron() {
    const std::string path = testing::TempDir() + "kept_format.off";
    std::ofstream(path) << "OFF\n4 4 0\n0 0 0\n11.3 0 0\n2.1 9.7 0\n3.7 3.1 8.3\n"
                           "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";
    MeshFile file;
    file.path = path;
    return file;
}

TEST(KeptFormat, HoldsTheBitsOfItsNumber) {
    // Truth: the digest of what the program of the commit that introduced this number built. Where it differs, users'
    // stores hold other bits under the same key: raise kKeptFormat, then write the new digest.
    ASSERT_EQ(kKeptFormat, 2);
    DigestStore store;
    const PartNeeds adaptive{.field = true, .shell = true, .tolerance = 50e-6, .spacing = 2e-3};
    const PartNeeds uniform{.field = true, .shell = true, .cell = 0.7e-3, .spacing = 1.5e-3};
    const shape::BorePlate plate{0.02, 0.02, 0.008, 0.01, 0.006, 0.0};
    const std::vector<std::pair<decltype(PartSpec::geometry), PartNeeds>> builds = {
        {shape::Shape(plate), adaptive},
        {shape::Shape(plate), uniform},
        {shape::Shape(shape::Sheet{0.02, 0.01}), adaptive},
        {tetrahedron(), adaptive}};
    for (const auto& [geometry, needs] : builds) {
        PartSpec spec;
        spec.name = "part";
        spec.geometry = geometry;
        ASSERT_TRUE(buildPart(spec, needs, &store));
    }
    EXPECT_EQ(store.kept, 8);
    EXPECT_EQ(store.digest.hex(), "58dc29880b7e22bcd699491036fd51e8164e9fab389a4fe283d96d76de2eaabf");
}

}  // namespace
}  // namespace passung::scene
