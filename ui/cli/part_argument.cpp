#include "ui/cli/part_argument.h"

#include "study/protocol/scene_reader.h"

namespace passung::cli {

namespace {

/// One of `unit` in metres.
Result<double> metresPerUnit(const std::string& unit) {
    if (unit == "m") return 1.0;
    if (unit == "cm") return 1e-2;
    if (unit == "mm") return 1e-3;
    if (unit == "um") return 1e-6;
    if (unit == "in") return 0.0254;
    return Error{.message = "must be m, cm, mm, um or in", .key = "--unit", .value = unit};
}

}  // namespace

Result<scene::PartSpec> partArgument(const std::string& path, const std::string& unit) {
    const auto metres = metresPerUnit(unit);
    if (!metres) return metres.errors();
    if (path.ends_with(".toml")) return protocol::readPart(path, *metres);
    scene::PartSpec spec;
    spec.name = path;
    spec.geometry = scene::MeshFile{path, *metres};
    return spec;
}

}  // namespace passung::cli
