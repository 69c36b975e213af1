#include "tests/bench/ours.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "core/field/distance_field.h"
#include "core/scene/timed_store.h"
#include "core/tick/penalty.h"
#include "study/run/files/disk_store.h"
#include "tests/bench/contact_scene.h"
#include "tests/bench/stopwatch.h"

namespace passung::bench {

namespace {

constexpr double kDepth = 1.2e-3;  // [m]: the poses are 1 mm deep

class WholeQuery : public Method {
public:
    WholeQuery(const scene::Part& field, const scene::Part& shell, const query::PartQueryRequest& request)
        : query_(field, shell, request) {}

    Answer at(const Pose& X_FS) override {
        const query::PartQueryResult result = query_.at(X_FS);
        return {.signed_distance = result.signed_distance,
                .error_bound = result.error_bound,
                .wrench = result.wrench,
                .contacts = static_cast<double>(result.contacts)};
    }

private:
    query::PartQuery query_;
};

class PenaltyTick : public Method {
public:
    PenaltyTick(const scene::Part& field, const scene::Part& shell)
        : field_(*field.field), shell_(*shell.shell), workspace_(shell_.nodes().size()) {
        contact_.variant = scene::PenaltyVariant::AreaWeighted;
        contact_.area_stiffness = kAreaStiffness;
    }

    Answer at(const Pose& X_FS) override {
        const contact::QueryAnswer found = contact::queryContacts(
            field_, Pose{}, shell_, X_FS, tick::penaltyRequest(contact_.variant), workspace_, manifold_);
        return {.signed_distance = found.found ? found.phi : kNotGiven,
                .wrench = tick::weightedWrench(contact_, found.load),
                .contacts = static_cast<double>(found.contacts)};
    }

private:
    const field::DistanceField& field_;
    const shell::SphereTree& shell_;
    contact::QueryWorkspace workspace_;
    contact::ContactManifold manifold_;  // stays empty
    scene::ContactSpec contact_;
};

void writeOff(const geometry::TriangleMesh& mesh, const std::string& file) {
    std::ofstream out(file);
    out << "OFF\n" << mesh.vertices.size() << ' ' << mesh.triangles.size() << " 0\n";
    for (const Vec3& v : mesh.vertices) out << fmt::format("{} {} {}\n", v.x(), v.y(), v.z());
    for (const auto& t : mesh.triangles) out << "3 " << t[0] << ' ' << t[1] << ' ' << t[2] << '\n';
}

Candidate candidate(const char* name, const BuiltPart& field, const BuiltPart& shell, double tolerance, double spacing,
                    bool two_way) {
    return {.name = name,
            .settings = fmt::format("tolerance {:g} um (cell {:.3g} mm), spacing {:g} mm ({} points){}",
                                    1e6 * tolerance, 1e3 * field.part.field->cell(), 1e3 * spacing,
                                    shell.part.shell->points().size(), two_way ? ", two-way" : ""),
            .build_s = field.field_s + field.shell_s + shell.field_s + shell.shell_s,
            .memory_bytes = field.bytes() + shell.bytes(),
            .ours = true,
            .two_way = two_way};
}

}  // namespace

double BuiltPart::bytes() const {
    double sum = 0.0;
    if (part.field) sum += static_cast<double>(part.field->memoryBytes());
    if (part.shell) sum += static_cast<double>(part.shell->memoryBytes());
    return sum;
}

PartStore::PartStore(geometry::TriangleMesh mesh) : kept_(run::openDiskStore()) {
    static int count = 0;
    const auto name = fmt::format("passung_bench_{}_{}.off", getpid(), count++);
    file_ = (std::filesystem::temp_directory_path() / name).string();
    writeOff(mesh, file_);
}

PartStore::~PartStore() {
    std::error_code ignored;
    std::filesystem::remove(file_, ignored);
}

Result<scene::Part> PartStore::build(const scene::PartNeeds& needs, scene::BuildStore* store) const {
    scene::PartSpec spec;
    spec.name = "bench";
    spec.geometry = scene::MeshFile{file_, 1.0};
    return scene::buildPart(spec, needs, store);
}

Result<const BuiltPart*> PartStore::get(double tolerance, double spacing) {
    const auto found = parts_.find({tolerance, spacing});
    if (found != parts_.end()) return &found->second;
    BuiltPart built;
    scene::PartNeeds needs{.field = tolerance > 0.0, .shell = false};
    if (needs.field) needs.tolerance = tolerance;
    needs.depth = kDepth;
    scene::TimedStore field_time(kept_.get());
    auto part = build(needs, &field_time);
    if (!part) return part.errors();
    built.field_s = field_time.seconds();
    built.part = std::move(*part);
    if (spacing > 0.0) {
        scene::TimedStore shell_time(kept_.get());
        auto shell = build({.field = false, .shell = true, .spacing = spacing}, &shell_time);
        if (!shell) return shell.errors();
        built.shell_s = shell_time.seconds();
        built.part.shell = std::move(shell->shell);
    }
    return &parts_.insert_or_assign({tolerance, spacing}, std::move(built)).first->second;
}

Result<BuiltPart> PartStore::withCell(double cell) const {
    const WallClock import;
    if (auto mesh = build({}, nullptr); !mesh) return mesh.errors();
    const double import_s = import.seconds();
    const WallClock whole;
    auto part = build({.field = true, .cell = cell}, nullptr);
    if (!part) return part.errors();
    return BuiltPart{.part = std::move(*part), .field_s = std::max(0.0, whole.seconds() - import_s)};
}

Candidate ourQuery(const BuiltPart& field, const BuiltPart& shell, double tolerance, double spacing,
                   const query::PartQueryRequest& request) {
    Candidate result = candidate("passung query", field, shell, tolerance, spacing, request.two_way);
    result.method = std::make_unique<WholeQuery>(field.part, shell.part, request);
    return result;
}

Candidate ourTick(const BuiltPart& field, const BuiltPart& shell, double tolerance, double spacing) {
    Candidate result = candidate("passung tick", field, shell, tolerance, spacing, false);
    result.method = std::make_unique<PenaltyTick>(field.part, shell.part);
    return result;
}

}  // namespace passung::bench
