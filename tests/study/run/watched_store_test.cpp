#include "study/run/files/watched_store.h"

#include <gtest/gtest.h>

#include <map>
#include <vector>

namespace passung::run {
namespace {

class Memory final : public scene::BuildStore {
public:
    std::map<std::string, std::string> kept;
    std::optional<std::string> load(const std::string& name) override {
        const auto found = kept.find(name);
        return found == kept.end() ? std::nullopt : std::optional(found->second);
    }
    void keep(const std::string& name, std::string_view bytes) override { kept[name] = bytes; }
};

TEST(WatchedStore, TellsHowMuchIsDoneWheneverSomethingIsBuilt) {
    // Truth: closed form. Of four pieces one is there.
    Memory memory;
    memory.kept["there"] = "x";
    WatchedStore store(&memory);
    std::vector<double> shares;
    store.begin(4, [&](double share) {
        shares.push_back(share);
        return true;
    });
    EXPECT_EQ(store.load("there"), "x");
    EXPECT_TRUE(shares.empty()) << "it took no time";
    for (const char* name : {"a", "b", "c"}) {
        EXPECT_FALSE(store.load(name));
        store.keep(name, name);
    }
    EXPECT_EQ(shares, (std::vector<double>{0.25, 0.5, 0.5, 0.75, 0.75, 1.0}));
    EXPECT_EQ(memory.kept.size(), 4u);
}

TEST(WatchedStore, ABuildThatIsGivenUpLosesNothingThatWasBuilt) {
    // Truth: invariant.
    Memory memory;
    WatchedStore store(&memory);
    bool goes_on = true;
    store.begin(2, [&](double) { return goes_on; });
    EXPECT_FALSE(store.load("a"));
    goes_on = false;
    EXPECT_THROW(store.keep("a", "x"), BuildCancelled);
    EXPECT_EQ(memory.kept["a"], "x");
    EXPECT_EQ(store.load("a"), "x") << "what is there needs no building";
    EXPECT_THROW(store.load("b"), BuildCancelled);
}

}  // namespace
}  // namespace passung::run
