#pragma once

#include <string>
#include <vector>

#include "core/base/number_table.h"
#include "core/base/result.h"
#include "core/base/types.h"

namespace passung::cli {

/// The poses of a CSV whose first columns are x_m,y_m,z_m,qw,qx,qy,qz: all finite, quaternions of length 1 (± 1e-3),
/// normalised. `table`: the whole file. Errors: unreadable, a pose that is none.
Result<std::vector<Pose>> readPoses(const std::string& path, NumberTable& table);

}  // namespace passung::cli
