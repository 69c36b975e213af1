#include "core/base/regular_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "tests/support/temp_folder.h"

namespace passung {
namespace {

TEST(RegularFile, IsReadWholeUpToItsLimit) {
    // Truth: closed form.
    const test::TempFolder folder;
    const std::string content("a\0b\n\xff", 5);
    std::ofstream(folder / "a", std::ios::binary) << content;
    std::ofstream(folder / "empty", std::ios::binary) << "";
    const auto read = readFile(folder / "a");
    ASSERT_TRUE(read);
    EXPECT_EQ(*read, content);
    EXPECT_EQ(*readRegularFile(folder / "a", 5), content);
    EXPECT_FALSE(readRegularFile(folder / "a", 4));
    EXPECT_EQ(*readFile(folder / "empty"), "");
    EXPECT_FALSE(readRegularFile("/proc/self/maps", 10)) << "states no size";
    EXPECT_TRUE(readFile("/proc/self/status"));
}

TEST(RegularFile, IsNoPipeNoDeviceNoFolder) {
    // Truth: invariant (none of them is waited for: the test ends).
    const test::TempFolder folder;
    ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
    std::filesystem::create_symlink("pipe", folder.path() / "link");
    for (const std::string& path :
         {folder / "pipe", folder / "link", std::string("/dev/zero"), folder.path().string()}) {
        const auto read = readFile(path);
        ASSERT_FALSE(read) << path;
        EXPECT_NE(read.errors()[0].message.find("regular file"), std::string::npos) << path;
        EXPECT_TRUE(whyNoRegularFile(path));
    }
    EXPECT_FALSE(readFile(folder / "absent"));
    EXPECT_FALSE(whyNoRegularFile(folder / "absent"));
}

TEST(RegularFile, IsNoCircleOfLinks) {
    // Truth: invariant: two links that name each other lead nowhere.
    const test::TempFolder folder;
    std::filesystem::create_symlink("there", folder.path() / "here");
    std::filesystem::create_symlink("here", folder.path() / "there");
    const auto read = readFile(folder / "here");
    ASSERT_FALSE(read);
    EXPECT_NE(read.errors()[0].message.find("in a circle"), std::string::npos) << read.errors()[0].message;
}

}  // namespace
}  // namespace passung
