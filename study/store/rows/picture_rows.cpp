#include "study/store/rows/picture_rows.h"

#include "core/base/digest.h"
#include "core/base/regular_file.h"
#include "study/store/schema/named_columns.h"

namespace passung::store {

Result<std::vector<PictureContent>> readPictures(const plan::StudyPlan& plan) {
    std::vector<PictureContent> pictures;
    for (const plan::PictureSource& picture : plan.pictures) {
        const auto bytes = readFile(picture.path);
        if (!bytes) return bytes.errors();
        pictures.push_back({picture.name, sha256Hex(*bytes), static_cast<std::int64_t>(bytes->size())});
    }
    return pictures;
}

void insertPictures(const Database& database, const std::string& protocol_sha256,
                    const std::vector<PictureContent>& pictures) {
    for (const PictureContent& picture : pictures)
        insertRow(database, "picture_file", Named{"protocol_sha256", protocol_sha256},
                  Named{"picture", picture.picture}, Named{"sha256", picture.sha256}, Named{"bytes", picture.bytes});
}

void requirePictures(const Database& database, const std::string& protocol_sha256,
                     const std::vector<PictureContent>& pictures) {
    Statement find = database.prepare("SELECT sha256 FROM picture_file WHERE protocol_sha256=? AND picture=?");
    for (const PictureContent& picture : pictures) {
        if (find.bind(protocol_sha256, picture.picture).step() && find.text(0) == picture.sha256) continue;
        throw std::runtime_error("the picture " + picture.picture +
                                 " has changed since this protocol was stored: restore it, or give the protocol a new "
                                 "version");
    }
}

}  // namespace passung::store
