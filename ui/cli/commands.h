#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "study/run/files/mesh_importer.h"

namespace passung::cli {

// One struct and one function per command; every function prints what a person needs and returns the exit code:
// 0, or 1 after an error line on standard error. Wrong usage (2) is main's business.

/// Becomes the program passung-window if there is a display; returns if there is none, or no such program beside this.
void openWindows();

struct CheckArguments {
    std::string protocol;
    run::ImportLimits import_limits;
};
int check(const CheckArguments& options);

struct PlanArguments {
    std::string protocol;
    run::ImportLimits import_limits;
};
/// The study as a text to be registered before its first participant.
int planStudy(const PlanArguments& options);

struct ExplainArguments {
    std::string file;      // protocol or scene
    int participants = 0;  // 0: as many as the protocol plans
    int stations = 1;      // where they take part in turn
    std::string database;  // of the study: what accuracy = "auto" picked there; empty: measured anew
    std::string orders;    // "csv": a row for each planned trial and nothing else; empty: as text among the rest
    run::ImportLimits import_limits;
};
int explain(const ExplainArguments& options);

/// One of several places with a database of its own; both or neither.
struct StationArguments {
    std::string station;  // capital letter; empty: the only one
    int stations = 0;
};

struct RunArguments {
    std::string protocol;
    std::string database;     // empty: the study's name with .db
    std::string participant;  // empty: the next free codes
    int simulated = 1;
    bool real_time = false;
    bool wait = false;  // for `passung session start`
    std::optional<std::uint64_t> seed;
    StationArguments station;
    std::string station_file;  // that chooses real devices; empty: the user's
    bool no_backup = false;
    bool group = false;
    int acknowledge_fd = -1;            // open file descriptor that gets a line per durable attempt
    std::string answers = "simulated";  // or "participant", "experimenter": asked in this terminal
    std::string language;               // empty: the first that the protocol has
    run::ImportLimits import_limits;
};
int run(const RunArguments& options);

struct ResumeArguments {
    std::string database;
    std::string session;  // id; empty: the newest one that did not complete
    std::string meshes;   // folder that the protocol's mesh paths start from; empty: here, else beside the database
    StationArguments station;
    std::string station_file;  // as of RunArguments
    bool no_backup = false;
    int acknowledge_fd = -1;  // as of RunArguments
    std::string answers = "simulated";
    run::ImportLimits import_limits;
};
int resume(const ResumeArguments& options);

struct ParticipantArguments {
    std::string database;
    std::string code;  // empty: the first unused one
    std::string kind = "real";
    StationArguments station;
    std::string protocol;              // study file; empty: the database has it
    std::vector<std::string> clauses;  // empty: all
    std::string decision = "yes";      // "no", "withdrawn"
    std::string language = "en";
    std::string scope;   // "stop", "exclude", "erase"
    std::string backup;  // of "erase": "erase" or "keep"; empty: asked in a terminal, else erased
    std::string reason;
    std::string by = "experimenter";
    bool group = false;
};
int enrolParticipant(const ParticipantArguments& options);
int listParticipants(const ParticipantArguments& options);
int decideConsent(const ParticipantArguments& options);
int withdrawParticipant(const ParticipantArguments& options);
int excludeParticipant(const ParticipantArguments& options);
int readmitParticipant(const ParticipantArguments& options);
int auditParticipants(const ParticipantArguments& options);
struct SessionArguments {
    std::string action;  // one of session::kCommandNames
    std::string database;
    std::string text;          // the reason, or the note
    std::int64_t attempt = 0;  // 0: the running or the last one
};
/// An experimenter's command to the session that runs on the database.
int tellSession(const SessionArguments& options);

struct ExportArguments {
    std::string database;
    std::string out;
    bool no_samples = false;
    bool group = false;
    std::string format = "plain";  // "psych-ds"
    bool anonymous = false;
    std::vector<std::string> bands = {};  // as exporter::readBand() takes them
    std::int64_t least_persons = 5;
};
int exportData(const ExportArguments& options);
int reportData(const ExportArguments& options);

struct MergeArguments {
    std::vector<std::string> databases;
    std::string out;
    bool group = false;
};
int merge(const MergeArguments& options);

struct PushArguments {
    std::string database;
    std::string to;  // of PostgreSQL, as libpq reads it
};
/// Becomes the program passung-postgres; returns only if there is none.
int push(const PushArguments& options);

struct VerifyArguments {
    std::string database;
};
int verify(const VerifyArguments& options);

struct RestoreArguments {
    std::string database;
    std::string from;  // a file, or PostgreSQL
};
int restore(const RestoreArguments& options);

struct ReplayArguments {
    std::string database;
    std::int64_t attempt = 0;  // 0: all of them
    std::string meshes;  // folder that the protocol's mesh paths start from; empty: here, else beside the database
    run::ImportLimits import_limits;
};
int replay(const ReplayArguments& options);

struct PowerArguments {
    std::string protocol;  // empty with merge
    std::string effect;    // as readEffect takes it
    std::string against;   // level; empty: the factor's first other one
    std::string measure = "time_s";
    std::string test;                   // empty: as the protocol plans
    std::string simulation = "haptic";  // or "model"
    int participants = 0;               // 0: as many as the protocol plans
    int repeats = 200;
    double drop_out = 0.0;  // share of participants who leave before the end
    double alpha = 0.05;
    int shard = 1, shards = 1;
    std::optional<std::uint64_t> seed;
    std::string out;                 // file of results; empty: printed only
    std::vector<std::string> merge;  // files of results to put together instead
};
int power(const PowerArguments& options);

struct MeshArguments {
    std::string file;
    std::string unit = "mm";
    run::ImportLimits import_limits;
};
int mesh(const MeshArguments& options);

struct QueryArguments {
    std::string field, shell, poses, out;
    std::string unit = "mm", field_unit, shell_unit;  // empty: unit
    double tolerance_um = 20.0, cell_mm = 0.0, spacing_mm = 1.0;
    std::string mode = "trilinear";
    std::optional<double> proximity_mm;
    int budget_nodes = 0;
    double quality = 0.0;
    bool two_way = false;
    std::string patches;  // file; empty: none
    run::ImportLimits import_limits;
};
int query(const QueryArguments& options);

struct SimulateArguments {
    std::string scene;
    std::vector<std::string> trajectories, outs;  // one for each hand
    run::ImportLimits import_limits;
};
int simulate(const SimulateArguments& options);

struct AccuracyArguments {
    std::string field, shell, out;  // with a trajectory: field is the scene, shell is empty; a study alone: neither
    bool measure = false;           // of a study: anew, beside it; else what is there is shown
    std::vector<std::string> conditions;  // of it; empty: the first that the program times
    std::string commit;                   // written into the file
    std::string poses;                    // empty: along generated contact paths
    std::string trajectory;  // of the held part; empty: queries of a pair are measured, not ticks of a scene
    int paths = 12;
    std::uint64_t seed = 1;
    std::vector<double> tolerances_um;  // empty: 100, 50, 20, 10; of ticks twice the scene's and its own
    std::vector<double> spacings_mm;    // empty: from the size of SHELL; of ticks twice the scene's and its own
    std::vector<int> budgets;           // empty: 0, 1000, 300, 100; of ticks the scene's own
    std::vector<std::string> modes;     // empty: all; of ticks the scene's own
    std::vector<std::string> methods, geometries;  // of ticks; empty: all that the scene can have
    std::vector<int> ways;                         // of ticks: 1, 2; empty: the scene's own
    int every = 20;                                // of so many ticks one is judged
    int repetitions = 5;
    int fcl_poses = 1000;
    std::string unit = "mm", field_unit, shell_unit;  // empty: unit
    run::ImportLimits import_limits;
};
int accuracy(const AccuracyArguments& options);
int tickAccuracy(const AccuracyArguments& options);
int studyAccuracy(const AccuracyArguments& options);

struct BenchArguments {
    std::string out, filter;
    bool check = false;  // compare with the marks
};
/// Becomes the program passung-bench; returns only if there is none.
int bench(const BenchArguments& options);

struct FeasibleArguments {
    std::string protocol;
    bool json = false;       // in place of the table
    bool keys = false;       // lines for the protocol follow the table
    std::string out;         // folder; empty: none
    std::uint32_t seed = 1;  // > 0
    double seconds = 30.0;   // of each step's search, > 0
    run::ImportLimits import_limits;
};
/// Becomes the program passung-feasible; returns only if there is none.
int feasible(const FeasibleArguments& options);

struct DoctorArguments {
    double seconds = 10.0;
    std::string device;                  // preset; empty: all, with a check of the loop
    bool find_stiffness = false;         // of the device, and keep it
    std::string report;                  // file that gets all this and the logs; empty: none
    std::vector<std::string> databases;  // whose logs; empty: those that run::loggedDatabases() finds
    std::string station_file;            // where to look for real devices; empty: the user's
    std::string write_station;           // file that gets the devices that were found; empty: none
};
int doctor(const DoctorArguments& options);

}  // namespace passung::cli
