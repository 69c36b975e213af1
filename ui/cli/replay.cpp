#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "core/replay/replayer.h"
#include "study/protocol/document.h"
#include "study/protocol/protocol_reader.h"
#include "study/store/digest.h"
#include "study/store/hex_text.h"
#include "study/store/store_reader.h"
#include "ui/app/auto_accuracy.h"
#include "ui/app/calibration.h"
#include "ui/app/disk_store.h"
#include "ui/app/run_study.h"
#include "ui/cli/commands.h"
#include "ui/cli/console.h"

namespace passung::cli {

namespace {

enum class Verdict { Same, Differs, NotProven };

/// Replays attempts of one database; parts and protocols are built once.
class Replays {
public:
    Replays(const store::StoreReader& reader, const std::string& meshes) : reader_(reader) {
        // Where the protocol's file was is not stored: a path of one machine means nothing on another.
        if (!meshes.empty()) {
            folders_ = {meshes};
        } else {
            folders_ = {"", std::filesystem::path(reader.path()).parent_path()};
        }
    }

    /// Prints one line per attempt.
    Result<Verdict> replay(const store::AttemptRow& attempt) {
        const auto records = reader_.records(attempt.attempt_id);
        if (!records) return records.errors();
        if (records->empty()) {
            fmt::print("{}: NOT PROVEN: no tick of it is recorded ({})\n", nameOf(attempt), attempt.outcome);
            return Verdict::NotProven;
        }
        auto plan = planOf(attempt.protocol_sha256);
        if (!plan) return plan.errors();
        const auto& conditions = (*plan)->conditions;
        const auto condition = std::find_if(conditions.begin(), conditions.end(),
                                            [&](const auto& c) { return c.name == attempt.condition; });
        if (condition == conditions.end()) {
            return Error{
                .message = "the stored protocol has no such condition", .key = "condition", .value = attempt.condition};
        }
        auto scene = model::buildScene(condition->scene, parts_);
        if (!scene) return scene.errors();
        return tell(attempt, replay::replay(*scene, *records));
    }

private:
    static std::string nameOf(const store::AttemptRow& attempt) {
        return fmt::format("attempt {} ({}, session {}, trial {}, {})", attempt.attempt_id, attempt.participant_id,
                           attempt.session_ordinal, attempt.trial_index + 1, attempt.condition);
    }

    static Verdict tell(const store::AttemptRow& attempt, const replay::ReplayReport& report) {
        const std::string name = nameOf(attempt);
        if (report.first_difference) {
            const auto& d = *report.first_difference;
            fmt::print("{}: DIFFERS at tick {} in {}: recorded {}, replayed {}\n", name, d.tick, d.column, d.recorded,
                       d.replayed);
            return Verdict::Differs;
        }
        const std::string hash = store::hexText(report.state_hash);
        if (attempt.state_hash.empty()) {
            fmt::print(
                "{}: NOT PROVEN: {} ticks, every recorded bit the same, but there is no state hash to compare "
                "({})\n",
                name, report.ticks, attempt.outcome);
            return Verdict::NotProven;
        }
        if (attempt.state_hash != hash) {
            fmt::print("{}: DIFFERS in the state hash: recorded {}, replayed {}\n", name, attempt.state_hash, hash);
            return Verdict::Differs;
        }
        fmt::print("{}: {} ticks, every recorded bit the same, state hash {}\n", name, report.ticks, hash);
        return Verdict::Same;
    }

    Result<const protocol::StudyPlan*> planOf(const std::string& sha256) {
        if (const auto known = plans_.find(sha256); known != plans_.end()) return &known->second;
        const auto rows = reader_.protocols();
        if (!rows) return rows.errors();
        for (const auto& row : *rows) {
            if (row.sha256 != sha256) continue;
            auto plan = readPlan(row);
            if (!plan) return plan.errors();
            return &plans_.emplace(sha256, std::move(*plan)).first->second;
        }
        return Error{.message = "is not in the database", .key = "protocol", .value = sha256};
    }

    /// The stored protocol with the mesh files of the first folder that has them all.
    Result<protocol::StudyPlan> readPlan(const store::ProtocolRow& row) {
        const auto stable = reader_.stableStiffness(row.sha256);
        if (!stable) return stable.errors();
        const auto devices = app::devicesAsKept(*stable);
        Errors errors;
        for (const std::filesystem::path& folder : folders_) {
            auto plan = protocol::readProtocolText(row.source_text, (folder / (row.name + ".toml")).string(), devices,
                                                   app::knownMeasures());
            if (!plan) {
                if (errors.empty()) errors = plan.errors();
                continue;
            }
            if (const auto same = compareMeshes(row.sha256, *plan); !same) return same.errors();
            const auto accuracy = reader_.accuracy();
            if (!accuracy) return accuracy.errors();
            if (const auto applied = app::applyAccuracy(row.sha256, *accuracy, *plan); !applied)
                return applied.errors();
            return plan;
        }
        errors.push_back({.message =
                              "the stored protocol cannot be read here; its mesh paths start from this folder or "
                              "the database's: --meshes names another",
                          .file = reader_.path()});
        return errors;
    }

    /// A replay with another geometry would prove nothing.
    Result<Done> compareMeshes(const std::string& sha256, const protocol::StudyPlan& plan) const {
        const auto rows = reader_.meshes();
        if (!rows) return rows.errors();
        Errors errors;
        for (const protocol::MeshSource& mesh : plan.meshes) {
            const auto stored = std::find_if(rows->begin(), rows->end(), [&](const store::MeshRow& row) {
                return row.protocol_sha256 == sha256 && row.mesh == mesh.name;
            });
            const auto bytes = protocol::readFile(mesh.path);
            if (!bytes) return bytes.errors();
            if (stored == rows->end()) {
                errors.push_back({.message = "the database does not know this mesh file", .file = mesh.path});
            } else if (const std::string found = store::sha256Hex(*bytes); found != stored->sha256) {
                errors.push_back(
                    {.message = "is not the mesh file of the recorded trials, whose SHA-256 is " + stored->sha256,
                     .file = mesh.path,
                     .key = "SHA-256",
                     .value = found});
            }
        }
        if (!errors.empty()) return errors;
        return Done{};
    }

    const store::StoreReader& reader_;
    std::vector<std::filesystem::path> folders_;
    std::unique_ptr<app::DiskStore> store_ = app::openDiskStore();
    model::PartCache parts_{store_.get()};
    std::map<std::string, protocol::StudyPlan> plans_;
};

}  // namespace

int replay(const ReplayOptions& options) {
    const auto reader = store::StoreReader::open(options.database);
    if (!reader) return fail(reader.errors());
    std::vector<store::AttemptRow> attempts;
    if (options.attempt != 0) {
        auto attempt = reader->attempt(options.attempt);
        if (!attempt) return fail(attempt.errors());
        attempts.push_back(std::move(*attempt));
    } else {
        auto all = reader->attempts();
        if (!all) return fail(all.errors());
        attempts = std::move(*all);
        if (attempts.empty()) return fail({{.message = "holds no attempts", .file = options.database}});
    }
    Replays replays(*reader, options.meshes);
    std::size_t different = 0, unproven = 0;
    for (const auto& attempt : attempts) {
        const auto verdict = replays.replay(attempt);
        if (!verdict) return fail(verdict.errors());
        different += *verdict == Verdict::Differs ? 1 : 0;
        unproven += *verdict == Verdict::NotProven ? 1 : 0;
    }
    if (attempts.size() > 1) {
        fmt::print("{} attempts replayed, {} differ{}\n", attempts.size(), different,
                   unproven == 0 ? "" : fmt::format(", {} could not be proven", unproven));
    }
    return different + unproven == 0 ? 0 : 1;
}

}  // namespace passung::cli
