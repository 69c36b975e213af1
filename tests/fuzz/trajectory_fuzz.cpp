#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <fstream>

#include "devices/scripted/trajectory.h"
#include "tests/support/temp_folder.h"

/// libFuzzer: any file is a path with a pose at every tick, finite or all nan, or errors that say what is wrong.

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace passung;
    static const test::TempFolder kFolder;
    const std::string path = kFolder / "path.csv";
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
    const auto trajectory = scripted::Trajectory::read(path);
    if (!trajectory) {
        if (trajectory.errors().empty() || trajectory.errors()[0].message.empty()) std::abort();
        return 0;
    }
    const std::int64_t last = trajectory->lastTick();
    if (last < 0) std::abort();
    for (int i = 0; i <= 16; ++i) {
        const Pose pose = trajectory->at(static_cast<std::int64_t>(static_cast<double>(last) * i / 16.0));
        const bool turned = std::abs(pose.q.norm() - 1.0) < 1e-6;
        if (pose.p.allFinite() && pose.q.coeffs().allFinite() && !turned) std::abort();
    }
    return 0;
}
