#pragma once

#include <array>
#include <string>

namespace passung::store {

// Who may open what holds people's data: nobody but the owner (mode 0600), or, where stations share a study, the
// owner's group as well (0660). What lies beside a database has its mode and its group.

/// Behind a database's name: the log of what ran on it (study/run/log), the newest part first.
inline constexpr std::array kLogFiles = {".log", ".1.log", ".2.log"};

/// The file that a link stands for; any other name as it is.
std::string behindLink(const std::string& path);

/// Makes an empty file that nobody else may open, unless there is a file of this name; throws if it cannot be made.
void makePrivate(const std::string& path);

/// Takes the database and what lies beside it from everybody but the owner. A file that others but the group are kept
/// from stays as somebody decided it; `group` shares it with the group, and throws if it is another user's.
void keepPrivate(const std::string& database_path, bool group);

/// Gives a file beside the database its mode and its group, as far as this user may.
void shareLike(const std::string& database_path, const std::string& file);

}  // namespace passung::store
