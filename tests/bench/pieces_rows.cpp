#include "tests/bench/pieces_rows.h"

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <limits>

#include "analysis/truth/exact_mesh.h"
#include "core/contact/contact_query.h"
#include "core/field/distance_field.h"
#include "core/shell/point_shell.h"
#include "tests/bench/ours.h"

namespace passung::bench {

namespace {

constexpr double kTolerance = 20e-6, kSpacing = 1e-3;
constexpr double kSeconds = 0.5, kQuickSeconds = 0.01;  // that each piece runs at least
constexpr double kNear = 1e-3;                          // of the surface, where errors are told [m]
constexpr std::size_t kMostJudged = 3000;

/// One thing to time. `run` does it once and says how many items that were: points, nodes, builds.
struct Piece {
    std::string name, settings;
    std::function<std::size_t()> run;
    bool build = false;  // seconds a build, not nanoseconds an item
    Times error_um = {};
};

/// Turns what Google Benchmark measured into rows instead of printing it.
class RowReporter : public benchmark::BenchmarkReporter {
public:
    RowReporter(const std::vector<Piece>& pieces, std::vector<Row>& rows) : pieces_(pieces), rows_(rows) {}
    bool ReportContext(const Context&) override { return true; }
    void ReportRuns(const std::vector<Run>& runs) override {
        for (const Run& run : runs) {
            const Piece& piece = pieces_[rows_.size()];
            Row row{.group = kPiecesGroup, .method = piece.name, .settings = piece.settings, .ours = true};
            row.samples = static_cast<std::size_t>(run.iterations);
            row.distance_error_um = piece.error_um;
            const double seconds = run.cpu_accumulated_time / static_cast<double>(run.iterations);
            if (piece.build)
                row.build_s = run.real_accumulated_time / static_cast<double>(run.iterations);
            else
                row.ns_per_point = 1e9 * seconds / static_cast<double>(run.counters.at("items").value);
            rows_.push_back(row);
        }
    }

private:
    const std::vector<Piece>& pieces_;
    std::vector<Row>& rows_;
};

void timePiece(benchmark::State& state, const Piece& piece) {
    std::size_t items = 0;
    for (auto _ : state) items += piece.run();
    state.counters["items"] = static_cast<double>(items) / static_cast<double>(state.iterations());
}

/// A point of the tool with the normal into the tool, in the bunny's frame.
struct Asked {
    Vec3 p, inward;
};

/// All points of the tool at all poses: as a query meets them, a shell after the other.
std::vector<Asked> pointsMet(const ContactScene& scene, const shell::SphereTree& shell) {
    std::vector<Asked> points;
    for (const TruePose& pose : scene.pressed)
        for (const shell::SurfacePoint& point : shell.points())
            points.push_back({pose.X_FS * point.position, -(pose.X_FS.q * point.normal)});
    return points;
}

/// Points met near the bunny's surface, with their true distances.
struct Judged {
    std::vector<Asked> points;
    std::vector<double> truth;

    Judged(const ContactScene& scene, const field::DistanceField& field, const std::vector<Asked>& all) {
        const truth::ExactMesh exact(scene.bunny);
        for (const Asked& met : all) {
            if (std::abs(field.sample(met.p, field::FieldMode::Trilinear).phi) > kNear) continue;
            points.push_back(met);
            truth.push_back(exact.signedDistance(met.p));
            if (points.size() == kMostJudged) break;
        }
    }
    Times errors(const field::DistanceField& field, field::FieldMode mode) const {
        std::vector<double> errors;
        for (std::size_t i = 0; i < points.size(); ++i)
            errors.push_back(kUm * std::abs(field.sample(points[i].p, mode, points[i].inward).phi - truth[i]));
        return errors.empty() ? Times{} : summarise(std::move(errors));
    }
};

}  // namespace

Result<std::vector<Row>> piecesRows(const ContactScene& scene, const Extent& extent) {
    std::vector<Row> rows;
    if (!extent.wanted(kPiecesGroup, "")) return rows;
    PartStore bunny(scene.bunny), tool(scene.tool);
    const auto field_part = bunny.get(kTolerance, 0.0);
    if (!field_part) return field_part.errors();
    const auto shell_part = tool.get(0.0, kSpacing);
    if (!shell_part) return shell_part.errors();
    const field::DistanceField& field = *(*field_part)->part.field;
    const shell::SphereTree& shell = *(*shell_part)->part.shell;
    const std::vector<Asked> points = pointsMet(scene, shell);
    const Judged judged(scene, field, points);
    contact::QueryWorkspace workspace(shell.nodes().size());
    contact::ContactManifold manifold(shell.nodes().size() + shell.points().size());

    const auto sampling = [&](field::FieldMode mode) {
        return [&field, &points, mode] {
            for (const Asked& met : points) benchmark::DoNotOptimize(field.sample(met.p, mode, met.inward).phi);
            return points.size();
        };
    };
    const auto visits = [&](bool prove) {
        return [&, prove] {
            std::size_t nodes = 0;
            for (const TruePose& pose : scene.pressed) {
                manifold.clear();
                const contact::QueryRequest request{.search_below = std::numeric_limits<double>::infinity(),
                                                    .prove = prove};
                nodes += static_cast<std::size_t>(
                    contact::queryContacts(field, Pose{}, shell, pose.X_FS, request, workspace, manifold)
                        .nodes_visited);
            }
            return nodes;
        };
    };
    const std::string at = fmt::format("bunny's field, tolerance {:g} um, tool's {} points, {} pressed poses",
                                       1e6 * kTolerance, shell.points().size(), scene.pressed.size());
    const std::string tool_at = fmt::format("torus tool, spacing {:g} mm", 1e3 * kSpacing);
    shell::PointShell sampled = shell::samplePoints(scene.tool, kSpacing);
    std::vector<Piece> pieces;
    for (const field::FieldMode mode : field::kFieldModes)
        pieces.push_back({.name = fmt::format("value and gradient, {}", modeName(mode)),
                          .settings = at + "; a point",
                          .run = sampling(mode),
                          .error_um = judged.errors(field, mode)});
    const std::vector<Piece> others{
        {"proven lower bound", at + "; a point",
         [&] {
             for (const Asked& met : points) benchmark::DoNotOptimize(field.lowerBound(met.p));
             return points.size();
         }},
        {"tree visit", at + "; a node with its points", visits(false)},
        {"tree visit with proof", at + "; a node with its points", visits(true)},
        {"build: points", tool_at, [&] { return shell::samplePoints(scene.tool, kSpacing).points.size(); }, true},
        {"build: sphere tree", fmt::format("{} points", sampled.points.size()),
         [&] { return shell::SphereTree(sampled).nodes().size(); }, true}};
    pieces.insert(pieces.end(), others.begin(), others.end());
    benchmark::ClearRegisteredBenchmarks();
    for (const Piece& piece : pieces)
        benchmark::RegisterBenchmark(piece.name.c_str(), [&piece](benchmark::State& state) {
            timePiece(state, piece);
        })->MinTime(extent.few_settings ? kQuickSeconds : kSeconds);
    RowReporter reporter(pieces, rows);
    benchmark::RunSpecifiedBenchmarks(&reporter, ".");
    return rows;
}

}  // namespace passung::bench
