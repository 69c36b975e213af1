#include "study/store/rows/protocol_rows.h"

#include <algorithm>
#include <stdexcept>

#include "core/base/digest.h"
#include "core/base/json.h"
#include "core/base/regular_file.h"
#include "study/measures/measures.h"
#include "study/plan/participant.h"
#include "study/plan/plan_contents.h"
#include "study/store/rows/consent_rows.h"
#include "study/store/rows/questionnaire_rows.h"
#include "study/store/rows/slots.h"
#include "study/store/schema/named_columns.h"
#include "study/store/schema/revisions.h"
#include "study/store/schema/study_views.h"

namespace passung::store {
namespace {

std::string levelsJson(const plan::Factor& factor) {
    std::vector<std::string> labels;
    for (const plan::Level& level : factor.levels) labels.push_back(jsonText(level.label));
    return jsonList(labels);
}

/// Rows of the counterbalancing that the plan's orders take turns with.
std::int64_t sequenceCount(const plan::StudyPlan& plan) {
    return static_cast<std::int64_t>(design::sequencesOf(plan::designOf(plan)));
}

void insertFactors(const Database& database, const std::string& sha256, const plan::StudyPlan& plan) {
    std::int64_t position = 0;
    for (const plan::Factor& factor : plan.factors) {
        const auto unit = factor.unit.empty() ? std::nullopt : std::optional(factor.unit);
        const std::string levels = levelsJson(factor);
        insertRow(database, "factor", Named{"protocol_sha256", sha256}, Named{"factor", factor.name},
                  Named{"kind", plan::factorKindName(factor.kind)}, Named{"data_type", "text"}, Named{"unit", unit},
                  Named{"label", factor.name}, Named{"position", position++}, Named{"levels_json", levels});
    }
}

void insertConditions(const Database& database, const std::string& sha256, const plan::StudyPlan& plan) {
    Statement insert =
        database.prepare("INSERT INTO condition(protocol_sha256, condition, levels_json, position) VALUES(?, ?, ?, ?)");
    std::int64_t position = 0;
    for (const plan::Condition& condition : plan.conditions) {
        insert.bind(sha256, condition.name, condition.levels_json, position++).run();
    }
}

void declareMeasures(const Database& database, const std::string& sha256, const plan::StudyPlan& plan) {
    for (const measures::MeasureDefinition& definition : measures::definitions()) {
        const bool declared = plan.measures.empty() || std::find(plan.measures.begin(), plan.measures.end(),
                                                                 definition.name) != plan.measures.end();
        if (declared)
            insertRow(database, "protocol_measure", Named{"protocol_sha256", sha256},
                      Named{"measure", definition.name});
    }
}

/// The plan's JSON must say the seed in force, which may be another than the protocol's own.
void storeSeed(const Database& database, const std::string& sha256, std::uint64_t seed) {
    database
        .prepare(
            "UPDATE protocol_version SET expanded_json=json_replace(expanded_json, '$.seed', json(?2)) "
            "WHERE protocol_sha256=?1 AND json_extract(expanded_json, '$.seed')<>?3")
        .bind(sha256, std::to_string(seed), seed)
        .run();
}

/// The text of a protocol stands for its meshes too: data of one protocol must be of one geometry.
void requireMeshes(const Database& database, const std::string& sha256, const std::vector<MeshContent>& meshes) {
    Statement find = database.prepare("SELECT sha256 FROM mesh_file WHERE protocol_sha256=? AND mesh=?");
    for (const MeshContent& mesh : meshes) {
        if (find.bind(sha256, mesh.mesh).step() && find.text(0) == mesh.sha256) continue;
        throw std::runtime_error("the mesh file " + mesh.mesh +
                                 " has changed since this protocol was stored: restore it, or give the protocol a new "
                                 "version");
    }
}

/// One file holds one study, and a version of it is one text: else rows of two designs could not be told apart.
void requireSameStudy(const Database& database, const plan::StudyPlan& plan) {
    Statement other = database.prepare("SELECT name FROM protocol_version WHERE name<>? LIMIT 1");
    if (other.bind(plan.name).step()) {
        throw std::runtime_error("holds the study " + other.text(0) + ", not " + plan.name +
                                 ": one database per study, name another with --db");
    }
    Statement same = database.prepare("SELECT 1 FROM protocol_version WHERE name=? AND version=? LIMIT 1");
    if (same.bind(plan.name, plan.version).step()) {
        throw std::runtime_error("the protocol has changed since version " + plan.version +
                                 " of it was stored here: restore its text, or give the protocol a new version");
    }
}

}  // namespace

Result<std::vector<MeshContent>> readMeshes(const plan::StudyPlan& plan) {
    std::vector<MeshContent> meshes;
    for (const plan::NamedMesh& mesh : plan.meshes) {
        const auto bytes = readRegularFile(mesh.path, kMostMeshBytes);
        if (!bytes) return bytes.errors();
        meshes.push_back({mesh.name, sha256Hex(*bytes), static_cast<std::int64_t>(bytes->size())});
    }
    return meshes;
}

void requireSeed(const Database& database, const std::string& sha256, std::uint64_t seed) {
    Statement find = database.prepare("SELECT seed FROM session WHERE protocol_sha256=? AND seed<>? LIMIT 1");
    if (!find.bind(sha256, seed).step()) return;
    throw std::runtime_error("the sessions of this protocol in this database have seed " +
                             std::to_string(static_cast<std::uint64_t>(find.integer(0))) + ", not " +
                             std::to_string(seed) + ": use that seed or another database");
}

void insertMeasures(const Database& database, std::size_t hands) {
    Statement find = database.prepare("SELECT formula_version FROM measure WHERE measure=?");
    std::int64_t position = 0;
    for (const measures::MeasureDefinition& definition : measures::definitions()) {
        if (!find.bind(definition.name).step()) {
            insertRow(database, "measure", Named{"measure", definition.name}, Named{"label", definition.label},
                      Named{"unit", definition.unit}, Named{"data_type", "number"},
                      Named{"formula", measures::formulaOf(definition, hands)},
                      Named{"formula_version", measures::versionOf(definition, hands)}, Named{"position", position});
        } else if (find.integer(0) != measures::versionOf(definition, hands)) {
            throw std::runtime_error("the database holds the measure " + definition.name + " by version " +
                                     find.text(0) + " of its formula, this program computes version " +
                                     std::to_string(measures::versionOf(definition, hands)) + ": use a new database");
        }
        ++position;
    }
}

std::string importPlan(const Database& database, const plan::StudyPlan& plan, const plan::RunChoice& choice,
                       const std::vector<MeshContent>& meshes, const std::vector<PictureContent>& pictures,
                       const OpenOptions& options, bool keep) {
    const std::string sha256 = sha256Hex(plan.source_text);
    const std::uint64_t seed = choice.seedOf(plan);
    Transaction transaction(database);
    if (database.prepare("SELECT 1 FROM protocol_version WHERE protocol_sha256=?").bind(sha256).step()) {
        requireSeed(database, sha256, seed);
        requireMeshes(database, sha256, meshes);
        requirePictures(database, sha256, pictures);
        requireQuestionnaires(database, sha256, plan);
        storeSeed(database, sha256, seed);
        insertMeasures(database, plan::mostHands(plan));
        makeStudyViews(database);  // in another order of measures, where a program knows more of them
        if (keep) transaction.commit();
        return sha256;
    }
    requireSameStudy(database, plan);
    insertRow(database, "protocol_version", Named{"protocol_sha256", sha256}, Named{"name", plan.name},
              Named{"version", plan.version}, Named{"source_text", plan.source_text},
              Named{"expanded_json", plan.expanded_json}, Named{"schema_version", schemaNumber()},
              Named{"app_version", options.app_version}, Named{"imported_utc", options.now_utc},
              Named{"title", plan.title}, Named{"sequences", sequenceCount(plan)});
    storeSeed(database, sha256, seed);
    for (const MeshContent& mesh : meshes)
        insertRow(database, "mesh_file", Named{"protocol_sha256", sha256}, Named{"mesh", mesh.mesh},
                  Named{"sha256", mesh.sha256}, Named{"bytes", mesh.bytes});
    insertPictures(database, sha256, pictures);
    insertFactors(database, sha256, plan);
    insertConditions(database, sha256, plan);
    if (!choice.trials_only) insertQuestionnaires(database, plan);
    insertMeasures(database, plan::mostHands(plan));
    declareMeasures(database, sha256, plan);
    for (const plan::StableStiffness& stable : plan.stable_stiffness)
        insertRow(database, "stable_stiffness", Named{"protocol_sha256", sha256}, Named{"device", stable.device},
                  Named{"stable_stiffness_N_per_m", stable.linear},
                  Named{"stable_rotational_stiffness_Nm_per_rad", stable.rotational}, Named{"origin", stable.origin});
    if (!choice.trials_only) insertConsentClauses(database, sha256, plan.consent);
    while (slotCount(database, sha256) < plan.participants)
        insertSlots(database, sha256, plan::participantKindName(plan::ParticipantKind::Real));
    makeStudyViews(database);
    if (keep) transaction.commit();
    return sha256;
}

}  // namespace passung::store
