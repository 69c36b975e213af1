#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/base/tick_record.h"
#include "study/plan/participant.h"
#include "study/plan/study_plan.h"
#include "study/store/rows/rows.h"
#include "study/store/samples/sample_codec.h"

namespace passung::store {

class Database;

/// What a reader does where rows are damaged: refuse the file, if SQLite's own check finds them; hand them out as they
/// are; look at every hash, with or without every checksum of samples, and hand out what is intact; or look at nothing,
/// because the file was found whole since the program runs.
enum class Damaged { Refused, HandedOut, LeftOut, LeftOutWithSamples, KnownWhole };

/// A study's database, read as it was at opening, whatever a session writes meanwhile. All lists are sorted by what
/// they mean (participant, session, trial …), never by row numbers, so that equal data gives equal lists.
class StoreReader {
public:
    /// Fails for files that are missing, damaged, not Passung's, or of a schema that this program cannot read.
    static Result<StoreReader> open(const std::string& path, Damaged damaged = Damaged::Refused);
    ~StoreReader();
    StoreReader(StoreReader&&) noexcept;

    const std::string& path() const { return path_; }
    /// What was left out, by participant, session and trial; none of a reader that refuses.
    const std::vector<DamageRow>& damages() const { return damages_; }

    Result<std::vector<ProtocolRow>> protocols() const;  // by name, version, hash
    Result<std::vector<MeshRow>> meshes() const;         // protocols as above, meshes by name
    Result<std::vector<AccuracyRow>> accuracy() const;   // by protocol hash, then candidate
    Result<std::vector<plan::StableStiffness>> stableStiffness(const std::string& protocol_sha256) const;
    Result<std::vector<ContactGeometryRow>> contactGeometry(const std::string& protocol_sha256) const;
    /// Text of each questionnaire file that the protocol names, by that name.
    Result<std::map<std::string, std::string>> questionnaireTexts(const std::string& protocol_sha256) const;
    Result<std::vector<FactorRow>> factors() const;            // protocols as above, factors as the protocol lists them
    Result<std::vector<ConditionRow>> conditions() const;      // likewise
    Result<std::vector<PlannedCellRow>> plannedCells() const;  // by participant, session, block, then as listed
    Result<std::vector<AnalysisRow>> analyses() const;         // protocols as above, as listed
    Result<std::vector<DataRuleRow>> dataRules() const;        // likewise
    Result<std::vector<NamedFileRow>> namedFiles() const;      // protocols as above, by kind and name
    Result<std::vector<QuestionnaireRow>> questionnaires() const;  // by key, version, language
    Result<std::vector<MeasureRow>> measures() const;
    Result<std::vector<ParticipantRow>> participants() const;
    Result<std::vector<ConsentClauseRow>> consentClauses() const;  // protocols as above, clauses as they are asked
    Result<std::vector<ConsentRow>> consents() const;              // by participant
    /// The highest number that a code of this kind had when somebody was last erased: nobody gets one up to it again.
    Result<std::int64_t> erasedCodesTo(plan::ParticipantKind kind) const;
    Result<AuditReport> audit() const;
    Result<std::vector<SessionRow>> sessions() const;
    Result<std::vector<AttemptRow>> attempts() const;
    Result<AttemptRow> attempt(std::int64_t attempt_id) const;
    /// Of the ticks that were judged after the trial; none of attempts before schema revision 17.
    Result<std::vector<measures::TickOverlap>> overlaps(std::int64_t attempt_id) const;
    Result<std::vector<EventRow>> events() const;
    /// The same one by one.
    Result<Done> eachEvent(const std::function<void(const EventRow&)>& take) const;
    Result<std::vector<NoteRow>> notes() const;
    Result<std::vector<DetectionRow>> detections() const;                // attempts as above, then by time
    Result<std::vector<StaircaseTrackRow>> staircaseTracks() const;      // by protocol, as it lists them
    Result<std::vector<StaircaseStepRow>> staircaseSteps() const;        // by attempt
    Result<std::vector<QuestionnaireRunRow>> questionnaireRuns() const;  // by session, then as they were asked

    /// The attempt's ticks, ascending; gaps are ticks that were dropped. Every chunk's checksum is verified.
    /// duration_ns is 0 where it was not measured.
    /// `hand`: of the condition's scene, from 0. Times are known of the first one's.
    Result<std::vector<TickRecord>> records(std::int64_t attempt_id, std::size_t hand = 0) const;
    /// What any attempt's ticks have beside.
    Result<std::vector<Extra>> extras() const;

private:
    StoreReader(std::string path, std::unique_ptr<Database> database);

    std::string path_;
    std::unique_ptr<Database> database_;
    std::vector<DamageRow> damages_;
};

}  // namespace passung::store
