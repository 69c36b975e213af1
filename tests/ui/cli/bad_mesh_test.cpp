#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <bit>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "core/base/sanitizer.h"
#include "tests/ui/cli/program.h"

namespace passung::test {
namespace {

std::string little(std::uint32_t value) {
    std::string bytes;
    for (int i = 0; i < 4; ++i) bytes.push_back(static_cast<char>(value >> (8 * i)));
    return bytes;
}

/// A binary STL of `count` equal triangles that says it has `stated`.
std::string binaryStl(std::size_t count, std::uint32_t stated, float first_coordinate) {
    std::string bytes = std::string(80, ' ') + little(stated);
    for (std::size_t i = 0; i < count; ++i) {
        for (int k = 0; k < 12; ++k)
            bytes += little(std::bit_cast<std::uint32_t>(k == 3 ? first_coordinate : static_cast<float>(k * k)));
        bytes += std::string(2, '\0');
    }
    return bytes;
}

const std::string kOff = "OFF\n4 4 0\n0 0 0\n10 0 0\n0 10 0\n0 0 10\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
const std::string kObj = "v 0 0 0\nv 10 0 0\nv 0 10 0\nv 0 0 10\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
const std::string kPlyHead =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 4\nproperty list uchar int vertex_indices\nend_header\n";
const std::string kPly = kPlyHead + "0 0 0\n10 0 0\n0 10 0\n0 0 10\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
}

struct BadFile {
    std::string name, content, place, requirement;  // `place` follows the name
};

std::vector<BadFile> badFiles() {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    return {
        {"empty.stl", "", " error: ", "is empty"},
        {"empty.ply", "", " error: ", "is empty"},
        {"empty.off", "", " error: ", "is empty"},
        {"empty.obj", "", " error: ", "is empty"},
        {"empty.gltf", "", " error: ", "is empty"},
        {"empty.glb", "", " error: ", "is empty"},
        {"empty.3mf", "", " error: ", "is empty"},
        {"cut.stl", binaryStl(12, 12, 0.0f).substr(0, 600), " error: ", "12 triangles has 684 bytes, this one 600"},
        {"head.stl", binaryStl(1, 1, 0.0f).substr(0, 60), " error: ", "84 bytes of a binary STL file, has 60 bytes"},
        {"huge.stl", binaryStl(2, 4000000000u, 0.0f), " error: ", "4000000000 triangles has 200000000084 bytes"},
        {"none.stl", binaryStl(0, 0, 0.0f), " error: ", "must have triangles"},
        {"nan.stl", binaryStl(3, 3, nan), " error: triangle 1: ", "must be finite"},
        {"line.stl", replaced(binaryStl(1, 1, 0.0f), binaryStl(1, 1, 0.0f).substr(84), std::string(50, '\0')),
         " error: ", "triangles with area"},
        {"picture.stl", "\x89PNG\r\n\x1a\n" + std::string(500, '\x55'), " error: ", "must be an STL file"},
        {"text.stl", "solid cow\nmoo\n", "2:1: error: moo: ", "must be one of solid, facet"},
        {"half.stl", "solid a\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\n", "4:1: error: ", "ends within a facet"},
        {"cut.stl",
         "solid a\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n",
         "8:1: error: ", "ends within a solid"},
        {"huge.stl", "solid a\nfacet normal 0 0 0\nouter loop\nvertex 1" + std::string(400, '0') + "e-5 0 0\n",
         "4:1: error: ", "finite numbers"},
        {"word.stl", "solid a\nfacet normal 0 0 0\nouter loop\nvertex 0 1 x\n", "4:1: error: x: ", "finite numbers"},
        {"cut.off", kOff.substr(0, 37), "6:1: error: ", "after 0 of 4 faces"},
        {"range.off", replaced(kOff, "3 1 2 3", "3 1 2 9"), "10:1: error: 9: ", "0 to 3"},
        {"minus.off", replaced(kOff, "3 1 2 3", "3 1 2 -3"), "10:1: error: -3: ", "0 to 3"},
        {"huge.off", "OFF\n4000000000 1 0\n0 0 0\n", "3:1: error: ", "after 1 of 4000000000 vertices"},
        {"none.off", "OFF\n0 1000000000 0\n", "2:1: error: ", "after 0 of 1000000000 faces"},
        {"nan.off", replaced(kOff, "10 0 0", "nan 0 0"), "4:1: error: nan: ", "three finite numbers"},
        {"inf.off", replaced(kOff, "10 0 0", "1e999 0 0"), "4:1: error: 1e999: ", "three finite numbers"},
        {"far.off", replaced(kOff, "10 0 0", "100000000000 0 0"), " error: vertex 1: 1e+08 m: ", "within 100 km"},
        {"range.obj", replaced(kObj, "f 2 3 4", "f 2 3 9"), "8:1: error: 9: ", "1 to 4"},
        {"zero.obj", replaced(kObj, "f 2 3 4", "f 0 3 4"), "8:1: error: 0: ", "1 to 4"},
        {"large.obj", replaced(kObj, "f 2 3 4", "f 2 3 99999999999999999999"), "8:1: error: 9999", "1 to 4"},
        {"cut.obj", kObj.substr(0, kObj.size() - 3), "8:1: error: ", "three vertices or more"},
        {"points.obj", kObj.substr(0, 26), " error: ", "must have triangles"},
        {"cut.ply", kPly.substr(0, kPly.size() - 20), "15:1: error: face 1: ", "its head promises 4"},
        {"range.ply", replaced(kPly, "3 1 2 3", "3 1 2 9"), "17:1: error: face 3: ", "must name vertices"},
        {"huge.ply", replaced(kPly, "vertex 4", "vertex 4000000000"),
         "17:1: error: vertex 9: ", "its head promises 4000000000"},
        {"cut_binary.ply", replaced(kPlyHead, "ascii", "binary_little_endian") + std::string(36, '\0'),
         " error: vertex 3: ", "the file ends here; its head promises 4"},
        {"huge_binary.ply",
         replaced(replaced(kPlyHead, "ascii", "binary_big_endian"), "vertex 4", "vertex 2000000000") +
             std::string(36, '\0'),
         " error: vertex 3: ", "the file ends here; its head promises 2000000000"},
        {"none.ply", replaced(kPlyHead, "vertex 4", "vertex 0"), "9:1: error: face 0: ", "its head promises 4"},
        {"cut.gltf", "{\"asset\":{\"version\":\"2.0\"}", " error: ", "must be a mesh that can be read"},
        {"cut.glb", std::string("glTF\x02\0\0\0\xff\xff\xff\x7f", 12), " error: ", "must be a mesh that can be read"},
        {"noise.3mf", "no package", " error: ", "3MF package"},
        {"table.xyz", "1 2 3\n", " error: ", "must end in .stl, .obj, .ply, .off, .gltf, .glb or .3mf"},
    };
}

/// One line that begins so and holds that; exit code 1; nothing on the standard output.
void expectOneLine(const Ended& ended, const std::string& begin, const std::string& requirement) {
    EXPECT_EQ(ended.exit_code, 1) << begin << " " << ended.err;
    const auto lines = linesOf(ended.err);
    ASSERT_EQ(lines.size(), 1u) << ended.err;
    EXPECT_EQ(lines[0].substr(0, begin.size()), begin);
    EXPECT_NE(lines[0].find(requirement), std::string::npos) << lines[0];
    EXPECT_EQ(ended.out, "");
}

class BadMesh : public testing::Test {
protected:
    // What a child may take; it inherits the limit: a file's header must not make it ask for more.
    void SetUp() override {
        getrlimit(RLIMIT_AS, &before_);
        const rlimit little{kAddresses, before_.rlim_max};
        if (!kSanitized) setrlimit(RLIMIT_AS, &little);
    }
    void TearDown() override { setrlimit(RLIMIT_AS, &before_); }

    static constexpr rlim_t kAddresses = rlim_t{512} << 20;  // [bytes]; the program itself takes 100 MB
    rlimit before_{};
    TempFolder folder_;
};

TEST_F(BadMesh, IsRefusedInOneLineThatNamesFilePlaceAndRequirement) {
    // Truth: closed form. One row per way in which a file may be bad.
    for (const BadFile& bad : badFiles()) {
        writeText(folder_ / bad.name, bad.content);
        expectOneLine(runProgram(folder_.path(), {"mesh", bad.name}), bad.name + ":" + bad.place, bad.requirement);
    }
}

TEST_F(BadMesh, ThatIsAbsentAFolderOrUnreadableIsRefused) {
    // Truth: closed form.
    expectOneLine(runProgram(folder_.path(), {"mesh", "absent.stl"}), "absent.stl: error: ", "does not exist");
    std::filesystem::create_directory(folder_.path() / "folder.stl");
    expectOneLine(runProgram(folder_.path(), {"mesh", "folder.stl"}), "folder.stl: error: ", "may be read");
    if (geteuid() == 0) return;  // root may read everything
    writeText(folder_ / "closed.stl", binaryStl(2, 2, 0.0f));
    chmod((folder_ / "closed.stl").c_str(), 0);
    expectOneLine(runProgram(folder_.path(), {"mesh", "closed.stl"}), "closed.stl: error: ", "may be read");
}

TEST_F(BadMesh, LeavesTheSoundFilesOfTheseTestsReadable) {
    // Truth: closed form (a tetrahedron of 10 mm: volume 1000/6 mm³).
    for (const auto& [name, content] :
         std::vector<std::pair<std::string, std::string>>{{"a.off", kOff}, {"a.obj", kObj}, {"a.ply", kPly}}) {
        writeText(folder_ / name, content);
        const Ended ended = runProgram(folder_.path(), {"mesh", name});
        EXPECT_EQ(ended.exit_code, 0) << ended.err;
        EXPECT_NE(ended.out.find("166.667 mm³"), std::string::npos) << ended.out;
    }
}

}  // namespace
}  // namespace passung::test
