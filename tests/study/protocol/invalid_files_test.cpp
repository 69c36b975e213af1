#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "study/protocol/protocol_reader.h"
#include "tests/study/protocol/known_names.h"

namespace passung::protocol {
namespace {

std::vector<std::filesystem::path> invalidFiles() {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(PASSUNG_SOURCE_DIR "/tests/data/invalid"))
        if (entry.path().extension() == ".toml") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

std::string expectedLine(const std::filesystem::path& file) {
    std::ifstream stream(file);
    std::string line;
    std::getline(stream, line);
    const std::string start = "# expect: ";
    return line.starts_with(start) ? line.substr(start.size()) : "no line that begins with " + start;
}

TEST(InvalidFiles, EachGivesExactlyTheErrorThatItDocuments) {
    // Truth: closed form: line and column of the mistake in each file; the words are a regression.
    const auto devices = knownDevices();
    const auto measures = knownMeasures();
    for (const auto& file : invalidFiles()) {
        SCOPED_TRACE(file.filename().string());
        const auto plan = readProtocol(file.string(), devices, measures);
        ASSERT_FALSE(plan);
        std::string lines;
        for (const auto& error : plan.errors()) {
            EXPECT_EQ(error.file, file.string());
            if (!lines.empty()) lines += '\n';
            lines += toString(error).substr(file.string().size() + 1);
        }
        EXPECT_EQ(lines, expectedLine(file));
    }
}

TEST(InvalidFiles, AreAtLeastFourteen) {
    // Truth: invariant: an empty folder would make the other test pass.
    EXPECT_GE(invalidFiles().size(), 14u);
}

TEST(InvalidFiles, AStudyThatOnlyMayNotBeginCanStillBeReadOnceItBegan) {
    // Truth: invariant: a study of an earlier version of the program, whose conditions no longer may begin, is looked
    // at and goes on; what cannot be read stays an error.
    const auto begun = [](const char* name) {
        std::ifstream stream(std::string(PASSUNG_SOURCE_DIR "/tests/data/invalid/") + name);
        const std::string text(std::istreambuf_iterator<char>(stream), {});
        EXPECT_FALSE(readProtocolText(text, name, knownDevices(), knownMeasures())) << name;
        return readBegunProtocol(text, name, knownDevices(), knownMeasures());
    };
    for (const char* name : {"dead_cue_decay.toml", "dead_cue_depth.toml", "dead_shown_pose.toml", "long_name.toml",
                             "long_label.toml", "version_lines.toml"}) {
        const auto plan = begun(name);
        ASSERT_TRUE(plan) << toString(plan.errors().front());
        EXPECT_FALSE(plan->conditions.empty());
        EXPECT_FALSE(plan->expanded_json.empty());
    }
    EXPECT_FALSE(begun("unknown_key.toml"));
}

TEST(InvalidFiles, AreSoundApartFromTheirMistake) {
    // Truth: invariant: one mistake a file; with its line repaired, unknown_key.toml is a study.
    std::ifstream stream(PASSUNG_SOURCE_DIR "/tests/data/invalid/unknown_key.toml");
    std::string text(std::istreambuf_iterator<char>(stream), {});
    const std::string wrong = "stifness";
    const auto position = text.rfind(wrong);
    ASSERT_NE(position, std::string::npos);
    text.replace(position, wrong.size(), "stiffness");
    EXPECT_TRUE(readProtocolText(text, "repaired.toml", knownDevices(), knownMeasures()));
}

}  // namespace
}  // namespace passung::protocol
