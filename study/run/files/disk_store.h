#pragma once

#include <filesystem>
#include <memory>

#include "core/scene/build_store.h"

namespace passung::run {

/// Keeps builds in a folder, a file each. A file is written under a name of its own, synced, then renamed: a killed
/// program or a full disk leaves no half file under a name that is read. Where nothing can be written, nothing is kept.
class DiskStore : public scene::BuildStore {
public:
    explicit DiskStore(std::filesystem::path folder) : folder_(std::move(folder)) {}
    std::optional<std::string> load(const std::string& name) override;
    void keep(const std::string& name, std::string_view bytes) override;

private:
    std::filesystem::path folder_;
};

/// Store in $XDG_CACHE_HOME/passung, or ~/.cache/passung; nothing if neither variable names a folder, or if the
/// variable PASSUNG_NO_CACHE is set and not empty.
std::unique_ptr<DiskStore> openDiskStore();

}  // namespace passung::run
