#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"
#include "study/plan/study_plan.h"
#include "study/store/schema/sqlite.h"

namespace passung::store {

// Pictures of a study's instructions: not their content is stored but its SHA-256. For this room only.

struct PictureContent {
    std::string picture, sha256;
    std::int64_t bytes = 0;
};

Result<std::vector<PictureContent>> readPictures(const plan::StudyPlan& plan);

void insertPictures(const Database& database, const std::string& protocol_sha256,
                    const std::vector<PictureContent>& pictures);

/// Throws if one has another content than when the protocol was stored: participants would have read another page.
void requirePictures(const Database& database, const std::string& protocol_sha256,
                     const std::vector<PictureContent>& pictures);

}  // namespace passung::store
