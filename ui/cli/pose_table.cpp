#include "ui/cli/pose_table.h"

#include <utility>

namespace passung::cli {

Result<std::vector<Pose>> readPoses(const std::string& path, NumberTable& table) {
    auto numbers = readNumbers(path, {"x_m", "y_m", "z_m", "qw", "qx", "qy", "qz"});
    if (!numbers) return numbers.errors();
    std::vector<Pose> poses;
    Errors errors;
    for (std::size_t i = 0; i < numbers->rows.size(); ++i) {
        const auto& v = numbers->rows[i];
        Pose pose{Quat(v[3], v[4], v[5], v[6]), Vec3(v[0], v[1], v[2])};
        if (!isRigid(pose)) {
            errors.push_back({.message = "a pose must be finite with a quaternion of length 1 ± 0.001",
                              .file = path,
                              .line = numbers->lines[i],
                              .column = 1});
        }
        pose.q.normalize();
        poses.push_back(pose);
    }
    if (!errors.empty()) return firstFaults(std::move(errors));
    table = std::move(*numbers);
    return poses;
}

}  // namespace passung::cli
