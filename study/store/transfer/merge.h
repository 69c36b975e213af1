#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "study/store/schema/open_options.h"

namespace passung::store {

/// What a merge did.
struct MergeReport {
    std::int64_t sessions = 0;  // added
    std::int64_t replaced = 0;  // went on, or got notes or invalidations, since an earlier merge
    std::int64_t known = 0;     // there already
    std::vector<std::string>
        unfinished;  // left out: still running, or killed and not opened since: "B.db: P001, session 1"
    std::vector<std::string> moved_places;  // participants whose slot another one had as well
    std::vector<std::string> erased;        // who was erased in one of the files and is in another
    std::vector<std::string> damaged;  // sessions and people that were left out, and what stays damaged in the result
    std::vector<std::string> healed;   // what was damaged in the result and intact in a source
    std::vector<std::string> held;  // of mergeDamaged(): what is damaged in the source and was the same in the result
    std::vector<std::string> conflicts;  // what two files say differently, and which of it stays
};

/// Adds everything of `sources` that `out` does not hold yet; `out` is made if it is not there, and appears or changes
/// as a whole or not at all. Merging the same again changes nothing, and nothing said about a session is lost: notes
/// and events of both are kept, and an attempt that does not count in one file does not count. The audits come along;
/// whoever was erased from the result is left out. Sessions and people that are damaged in a source are left out, and
/// what is damaged in the result and intact in a source is healed. Refused: a study whose own rows are damaged, another
/// study, one version of a protocol with two texts, seeds, meshes or picks of accuracy, and one code for two people.
Result<MergeReport> mergeDatabases(const std::vector<std::string>& sources, const std::string& out,
                                   const OpenOptions& options);

/// The same for one source whose pages are damaged, as far as it can be read: what cannot be is told as damaged. `file`
/// is a copy of the source, and `out` is nobody else's. Fails where something else than damage is in the way.
Result<MergeReport> mergeDamaged(const std::string& source, const std::string& file, const std::string& out,
                                 const OpenOptions& options);

}  // namespace passung::store
