#pragma once

#include <string>
#include <vector>

#include "analysis/export/study_data.h"
#include "core/base/result.h"
#include "study/store/read/store_reader.h"

namespace passung::presenter {

/// A measure that at least one attempt has.
struct ShownMeasure {
    std::string name, label, unit;
};

/// What a study's database holds, as an experimenter looks through it.
struct Recorded {
    exporter::StudyData data;
    std::vector<ShownMeasure> measures;
    std::vector<std::string> kinds;  // of participants, that have attempts: "real", "pilot", "simulated"
    std::size_t damages = 0;         // that the reader found and left out
};
Result<Recorded> readRecorded(const store::StoreReader& reader);

/// The measure that summaries begin with: how long a trial took, if that varies, else the first measure that does.
std::size_t firstMeasure(const Recorded& recorded);

/// The attempts of a session, by trial, then by number.
std::vector<const store::AttemptRow*> attemptsOf(const Recorded& recorded, const std::string& session_id);

/// Five numbers of a sample; quartiles interpolate linearly between neighbours (type 7 of Hyndman and Fan 1996, the
/// default of R). @pre not empty
struct FiveNumbers {
    double least = 0.0, lower = 0.0, median = 0.0, upper = 0.0, most = 0.0;
};
FiveNumbers fiveNumbers(std::vector<double> values);

/// A measure under one condition: the values of the attempts that count in means.
struct ConditionSummary {
    std::string condition, version;  // version of the protocol, where several ran
    std::size_t participants = 0;
    std::vector<double> values;  // by participant, then as they were made
    FiveNumbers numbers;         // of values, if there are any
};

/// Of participants of one kind only: kinds are never mixed. As the protocol lists its conditions.
std::vector<ConditionSummary> lookAt(const Recorded& recorded, const std::string& measure, const std::string& kind);

}  // namespace passung::presenter
