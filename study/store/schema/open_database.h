#pragma once

#include <memory>
#include <string>
#include <vector>

#include "study/store/schema/open_options.h"
#include "study/store/schema/sqlite.h"

namespace passung::store {

/// A checked, current database ready for writing, or why there is none.
struct OpenedDatabase {
    OpenOutcome outcome = OpenOutcome::Failed;
    std::unique_ptr<Database> database;
    RecoveryReport recovery;
    Errors errors;
};

/// The steps of Store::open() after its lock is taken: open, inspect, check, upgrade, mark what crashed.
OpenedDatabase openForWriting(const std::string& path, const OpenOptions& options);

/// What becomes of a file of an older program that is only read: an upgraded copy of it is, which nobody else sees;
/// nothing, where what is read has to be what lies in the file.
enum class OlderFile { UpgradeCopy, Refuse };

/// How far a file has to be sound to be opened: pages and rows; pages, whatever rows hold; no more than its beginning.
enum class ReadCheck { Pages, Structure, None };

/// Tells whether the file's pages are sound. Faults of single rows and of indices are not of them.
bool pagesAreSound(const Database& database);

/// Rows of `table` that belong to no row of `parent`: told once a pair.
struct BrokenReference {
    std::string table, parent;
};
std::vector<BrokenReference> brokenReferences(const Database& database);

/// An index that does not fit its table is made anew; where even that is refused, a row is still damaged.
void rebuildIndices(const Database& database);

/// Opens an existing Passung file that this program can read, without changing a byte of it (see openUntouched()).
/// Where pages need not be sound, damage in the schema's text is mended in a private copy and told in `mended`; with
/// `indices` that of indices is looked for on the same walk through the file, and told there.
Result<std::unique_ptr<Database>> openForReading(const std::string& path, OlderFile older = OlderFile::UpgradeCopy,
                                                 ReadCheck check = ReadCheck::Pages,
                                                 std::vector<std::string>* mended = nullptr,
                                                 std::vector<std::string>* indices = nullptr);

}  // namespace passung::store
