#include "core/scene/timed_store.h"

#include <gtest/gtest.h>

#include <map>

namespace passung::scene {
namespace {

struct MemoryStore : BuildStore {
    std::map<std::string, std::string> files;
    std::optional<std::string> load(const std::string& name) override {
        const auto file = files.find(name);
        return file == files.end() ? std::nullopt : std::optional(file->second);
    }
    void keep(const std::string& name, std::string_view bytes) override { files[name] = bytes; }
};

TEST(TimedStore, TellsLaterWhatTheBuildTookThen) {
    // Truth: invariant. The same number, to the bit, from another object on the same store; sums over what it was
    // asked.
    MemoryStore store;
    TimedStore building(&store);
    EXPECT_FALSE(building.load("field"));
    building.keep("field", "bytes");
    EXPECT_GT(building.seconds(), 0.0);
    TimedStore later(&store);
    EXPECT_EQ(later.load("field"), "bytes");
    EXPECT_EQ(later.seconds(), building.seconds());
    EXPECT_FALSE(later.load("shell"));
    later.keep("shell", "more");
    EXPECT_GT(later.seconds(), building.seconds());
}

TEST(TimedStore, TakesNothingWhoseTimeIsNotKnown) {
    // Truth: invariant. Kept by somebody who does not time, or with a time that is damaged.
    MemoryStore store;
    store.keep("field", "bytes");
    EXPECT_FALSE(TimedStore(&store).load("field"));
    TimedStore(&store).keep("field", "bytes");
    EXPECT_TRUE(TimedStore(&store).load("field"));
    for (auto& [name, bytes] : store.files)
        if (name != "field") bytes.back() ^= 1;
    TimedStore asked(&store);
    EXPECT_FALSE(asked.load("field"));
    EXPECT_EQ(asked.seconds(), 0.0);
}

TEST(TimedStore, TimesWithoutAStoreToo) {
    // Truth: invariant
    TimedStore timed(nullptr);
    EXPECT_FALSE(timed.load("field"));
    timed.keep("field", "bytes");
    EXPECT_GT(timed.seconds(), 0.0);
    EXPECT_FALSE(timed.load("field"));
}

}  // namespace
}  // namespace passung::scene
