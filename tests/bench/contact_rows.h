#pragma once

#include <functional>

#include "tests/bench/contact_scene.h"
#include "tests/bench/row.h"

namespace passung::bench {

inline constexpr const char* kPressedGroup = "pressed 1 mm";
inline constexpr const char* kApartGroup = "1 mm apart";

/// How much is measured.
struct Extent {
    int repetitions = 5;  // each pose's time is its fastest; one more, before, is discarded
    bool few_settings = false;
    std::function<bool(const std::string& group, const std::string& method)> wanted;
};

/// Asks `candidate` every pose and compares with the truth.
Row measure(const Candidate& candidate, const char* group, const std::vector<TruePose>& poses, double lever,
            int repetitions);

/// Ours and the peers at poses pressed together and apart. Errors: a part cannot be built.
Result<std::vector<Row>> contactRows(const ContactScene& scene, const Extent& extent);

}  // namespace passung::bench
