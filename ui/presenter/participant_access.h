#pragma once

#include <functional>
#include <string>
#include <vector>

#include "study/store/people/participant_records.h"
#include "study/store/write/store.h"
#include "ui/presenter/leaving.h"

namespace passung::presenter {

/// Who acts at which study's database.
struct ParticipantAccess {
    std::string database;
    std::string by = "experimenter";
    store::Station station = {};
    bool create = false;  // else the database has to be there
    bool group = false;   // as of store::OpenOptions
};

/// Opens the database, lets `work` do its part and closes it.
Result<Done> withParticipants(const ParticipantAccess& access,
                              const std::function<Result<Done>(store::Store&, store::ParticipantRecords&)>& work);

/// Enrols somebody; no code: the first that is free. Returns the code.
Result<std::string> enrolAt(store::Store& store, store::ParticipantRecords& records, plan::ParticipantKind kind,
                            std::string code);

/// What came of somebody's leaving.
struct Left {
    std::string surrogate;            // of whoever was erased, in the audit
    bool backup = false;              // they were erased from the backup too
    std::string backup_problem;       // why that could not be done; empty: it was, or there was nothing to do
    std::vector<std::string> copies;  // known ones that still hold them
};
Result<Left> leave(const ParticipantAccess& access, const presenter::Leaving& leaving);

/// The database of a study's real sessions, beside the folder of those of try-outs, which never hold any.
std::string studyDatabase(const std::string& tryouts, const std::string& study);

}  // namespace passung::presenter
