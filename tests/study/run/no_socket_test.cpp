#include <gtest/gtest.h>

#include <chrono>

#include "study/protocol/protocol_reader.h"
#include "study/run/command_socket.h"
#include "study/run/files/known_names.h"
#include "study/run/run_study.h"
#include "tests/support/temp_folder.h"
#include "tests/ui/cli/small_study.h"

namespace passung::test {
namespace {

using Clock = std::chrono::steady_clock;

TEST(NoSocket, ASessionThatWaitsWithoutOneDoesNotSpin) {
    // Truth: closed form. Between two looks for a command lies at least the time that a socket would be waited for. The
    // database's name leaves no room for one beside it.
    const auto plan = protocol::readProtocolText(smallStudy(), "study.toml", run::knownDevices(), run::knownMeasures());
    ASSERT_TRUE(plan);
    const TempFolder folder;
    std::vector<Clock::time_point> looks;
    std::vector<std::string> warnings;
    run::RunOptions options;
    options.database = folder / (std::string(100, 'd') + ".db");
    options.backup = false;
    options.wait = true;
    options.interrupted = [&] {
        looks.push_back(Clock::now());
        return looks.size() > 20;
    };
    options.warns = true;
    const auto listener = [&](const session::SessionEvent& event) {
        if (const auto* warned = std::get_if<session::Warned>(&event)) warnings.push_back(warned->text);
    };
    const auto end = run::runStudy(*plan, options, listener);
    ASSERT_TRUE(end);
    ASSERT_EQ(warnings.size(), 1u) << "there was a socket after all";
    EXPECT_GE(looks.back() - looks.front(), (looks.size() - 1) * run::CommandSocket::kServeWait);
}

}  // namespace
}  // namespace passung::test
