#include "ui/cli/command_line.h"

#include <CLI/CLI.hpp>

#include <cstdint>
#include <cstdio>
#include <functional>
#include <iterator>
#include <sstream>

#include "analysis/power/effect_test.h"
#include "analysis/power/power_file.h"
#include "core/field/field_mode.h"
#include "study/plan/participant.h"
#include "study/session/command.h"
#include "ui/cli/commands.h"
#include "ui/cli/console.h"
#include "ui/cli/option_checks.h"

// The command line: names, options and their help. What a command does is in its own file.

namespace {

using namespace passung::cli;

constexpr int kWrongUsage = 2;

CLI::IsMember aMode() {
    std::vector<std::string> names;
    for (const auto mode : passung::field::kFieldModes) names.emplace_back(passung::field::modeName(mode));
    return CLI::IsMember(names);
}

class CommandLine {
public:
    CommandLine() : app_("Passung: user studies of haptic manipulation") {
        app_.set_version_flag("--version", PASSUNG_VERSION);
        app_.require_subcommand(1);
        addStudyCommands();
        addParticipantCommands();
        addSessionCommands();
        addDataCommands();
        addPowerCommand();
        addCoreCommands();
    }

    int run(int argc, char** argv) {
        if (argc > 1 && argv[1][0] != '-' && !isCommand(argv[1], commandNames())) return kWrongUsage;
        try {
            app_.parse(argc, argv);
        } catch (const CLI::ParseError& error) {
            std::ostringstream out, wrong;  // what it prints passes the C streams, as everything here
            const bool fine = app_.exit(error, out, wrong) == 0;
            std::fputs(out.str().c_str(), stdout);
            std::fputs(wrong.str().c_str(), stderr);
            return fine ? 0 : kWrongUsage;
        }
        return chosen_();
    }

private:
    std::vector<std::string> commandNames() const {
        std::vector<std::string> names;
        for (const CLI::App* command : app_.get_subcommands({})) names.push_back(command->get_name());
        return names;
    }

    template <class Options>
    CLI::App* command(const char* name, const char* help, Options& options, int (*function)(const Options&)) {
        return command(app_, name, help, options, function);
    }

    template <class Options>
    CLI::App* command(CLI::App& parent, const char* name, const char* help, Options& options,
                      int (*function)(const Options&)) {
        CLI::App* sub = parent.add_subcommand(name, help);
        sub->callback([this, &options, function] { chosen_ = [&options, function] { return function(options); }; });
        return sub;
    }

    void addStudyCommands() {
        auto* sub = command("check", "validate a protocol: every problem with its place", check_, check);
        sub->add_option("PROTOCOL", check_.protocol, "study file (.toml)")->required();
        addImport(sub, check_.import_limits);

        sub =
            command("explain", "print design, orders and balance, or the stages of a scene's tick", explain_, explain);
        sub->add_option("FILE", explain_.file, "protocol or scene")->required();
        addImport(sub, explain_.import_limits);
        sub->add_option("--participants", explain_.participants, "number of orders to print")->check(wholeIntFrom(1));
        sub->add_option("--stations", explain_.stations, "number of stations that take their turns; default 1")
            ->check(between(1.0, 26.0, "a number from 1 to 26"));
        sub->add_option("--orders", explain_.orders, "form of the orders: csv prints these alone, a row for each trial")
            ->check(CLI::IsMember({"csv"}));
        sub->add_option("--db", explain_.database,
                        "database of the study: what accuracy = \"auto\" picked there is shown, not measured anew");

        sub = command("plan", "print the preregistration of a study: what is measured, tested and left out", plan_,
                      planStudy);
        sub->add_option("PROTOCOL", plan_.protocol, "study file (.toml)")->required();
        addImport(sub, plan_.import_limits);

        sub = command("run", "perform a study with simulated participants", run_, passung::cli::run);
        sub->add_option("PROTOCOL", run_.protocol, "study file (.toml)")->required();
        addImport(sub, run_.import_limits);
        sub->add_option("--db", run_.database, "database; default: the study's name with .db");
        auto* participant = sub->add_option("--participant", run_.participant, "code of one participant, such as S001");
        sub->add_option("--simulated", run_.simulated, "number of new participants; default 1")
            ->check(wholeIntFrom(1))
            ->excludes(participant);
        sub->add_flag("--real-time", run_.real_time,
                      "run at 1 kHz by the clock instead of as fast as the machine goes");
        sub->add_option("--seed", run_.seed, "seed instead of the protocol's")->check(wholeUnsigned());
        addStation(sub, run_.station);
        addStationFile(sub, run_.station_file);
        addGroup(sub, run_.group);
        sub->add_flag("--no-backup", run_.no_backup, "leave out the copy DB.backup and its SHA-256 at the end");
        addAnswers(sub, run_.answers);
        sub->add_option("--language", run_.language,
                        "language of the session, stored with it; default: the first of the protocol's. With --answers "
                        "consent and instructions are shown in it");
        sub->add_flag("--wait", run_.wait, "begin every session only when `passung session start DB` says so");
        sub->add_option("--acknowledge-fd", run_.acknowledge_fd, "file descriptor for a line per durable attempt");
    }

    static void addAnswers(CLI::App* sub, std::string& answers) {
        sub->add_option(
               "--answers", answers,
               "source of the answers to questionnaires and consent: simulated (default), or, asked in this terminal, "
               "participant or experimenter (who reads them out). Trials stay those of a simulated hand")
            ->check(CLI::IsMember({"simulated", "participant", "experimenter"}));
    }

    static void addGroup(CLI::App* sub, bool& group) {
        sub->add_flag("--group", group,
                      "let the group of the file's owner read and write it (mode 0660); default: the owner alone "
                      "(0600), or as an earlier --group left it");
    }

    /// What reading a mesh file may take.
    static void addImport(CLI::App* sub, passung::run::ImportLimits& limits) {
        sub->add_option("--import-seconds", limits.processor_s, "most processor time to read a mesh file; default 20")
            ->check(between(1.0, 86400.0, "a number from 1 to 86400"));
        sub->add_option_function<double>(
               "--import-memory-mb",
               [&limits](double mebibytes) { limits.memory = static_cast<std::uintmax_t>(mebibytes) << 20; },
               "most memory to read a mesh file; default 1024; at least 16 times the file")
            ->check(between(64.0, 1048576.0, "a number from 64 to 1048576"));
    }

    static void addStationFile(CLI::App* sub, std::string& file) {
        sub->add_option("--station-file", file,
                        "file that says which real devices serve here; people hold them, with --real-time. Default: "
                        "station.toml in the folder of the user's data, if it is there")
            ->check(CLI::ExistingFile);
    }

    static void addStation(CLI::App* sub, StationArguments& options) {
        auto* letter = sub->add_option("--station", options.station,
                                       "letter of this station, where several run the study with a database each. Each "
                                       "takes slots and codes of its own");
        letter->check(capitalLetter());
        auto* count = sub->add_option("--stations", options.stations, "number of stations, the same for each");
        count->check(between(2.0, 26.0, "a number from 2 to 26"))->needs(letter);
        letter->needs(count);
    }

    void addParticipantCommands() {
        CLI::App& people =
            *app_.add_subcommand("participant", "enrol and list participants: codes and consent, never names");
        people.require_subcommand(1);
        const auto action = [&](const char* name, const char* help, int (*function)(const ParticipantArguments&)) {
            auto* sub = command(people, name, help, participant_, function);
            sub->add_option("DB", participant_.database, "database of a study")->required();
            return sub;
        };
        const auto about = [&](CLI::App* sub) {
            sub->add_option("CODE", participant_.code, "code, such as P001")->required();
            sub->add_option("--by", participant_.by, "name for the audit of whoever does it; default experimenter");
        };
        auto* sub = action("enrol", "enrol a participant and print the code", enrolParticipant);
        sub->add_option("CODE", participant_.code, "code, such as P001; default: the first unused one");
        sub->add_option("--kind", participant_.kind, "kind of participant; default real")
            ->check(CLI::IsMember(passung::plan::participantKindNames()));
        sub->add_option(
            "--protocol", participant_.protocol,
            "study file, stored first where the database does not have it. A database that is absent is made");
        sub->add_option("--by", participant_.by, "name for the audit of whoever does it; default experimenter");
        addGroup(sub, participant_.group);

        addStation(sub, participant_.station);

        action("list", "list all participants, with state, slot and consent", listParticipants);

        sub = action("consent", "store decisions on the protocol's clauses of consent", decideConsent);
        about(sub);
        sub->add_option("--decision", participant_.decision, "decision; default yes")
            ->check(CLI::IsMember({"yes", "no", "withdrawn"}));
        sub->add_option("--clause", participant_.clauses, "clause of consent; default: all")->expected(1)->take_all();
        sub->add_option("--language", participant_.language, "language of the text that was read; default en");

        sub = action("withdraw", "end a participant's part in the study", withdrawParticipant);
        about(sub);
        sub->add_option("--scope", participant_.scope,
                        "extent. stop: no more sessions, the data stays. exclude: the data counts nowhere any more. "
                        "erase: nothing of the participant is left in the database")
            ->required()
            ->check(CLI::IsMember({"stop", "exclude", "erase"}));
        sub->add_option(
               "--backup", participant_.backup,
               "copies in the database's backup, with the scope erase: erase (default, asked in a terminal) or keep")
            ->check(CLI::IsMember({"erase", "keep"}));
        sub->add_option("--reason", participant_.reason, "reason, if the participant gave one; no names");

        sub = action("exclude", "exclude a participant from the analysis and free the slot", excludeParticipant);
        about(sub);
        sub->add_option("--reason", participant_.reason, "reason, stored with the status")->required();

        sub = action("readmit", "take an exclusion back; the audit keeps both", readmitParticipant);
        about(sub);
        sub->add_option("--reason", participant_.reason, "reason, stored with the status")->required();

        action("audit", "check the chain of what was done to participants", auditParticipants);
    }

    void addSessionCommands() {
        auto* sub = command("resume", "go on with an interrupted session by its protocol's [resume]", resume_, resume);
        sub->add_option("DB", resume_.database, "database of the study")->required();
        addImport(sub, resume_.import_limits);
        sub->add_option("--session", resume_.session, "session_id; default: the newest one that did not complete");
        sub->add_option("--meshes", resume_.meshes, "folder of the mesh files, as of replay")
            ->check(CLI::ExistingDirectory);
        addStation(sub, resume_.station);
        addStationFile(sub, resume_.station_file);
        addAnswers(sub, resume_.answers);
        sub->add_flag("--no-backup", resume_.no_backup, "leave out the copy, as of run");
        sub->add_option("--acknowledge-fd", resume_.acknowledge_fd, "file descriptor for a line per durable attempt");

        sub = command("session", "send an experimenter's command to the session that runs on a database", session_,
                      tellSession);
        sub->add_option("ACTION", session_.action,
                        "command: start, pause (after the running trial), continue, repeat, skip, invalidate, back, "
                        "note, abort (ends the session), stop (emergency: motors off at once, then paused), done, "
                        "failed (of a trial that the experimenter times)")
            ->required()
            ->check(CLI::IsMember(std::vector<std::string>(std::begin(passung::session::kCommandNames),
                                                           std::end(passung::session::kCommandNames))));
        sub->add_option("DB", session_.database, "database of the study")->required();
        sub->add_option("--text,--reason", session_.text, "text of the note, or reason; note and invalidate need it");
        sub->add_option("--attempt", session_.attempt,
                        "attempt_id, for invalidate and note; default: the running attempt, else the last one")
            ->check(wholeFrom(1));
    }

    static void addAnonymity(CLI::App* sub, ExportArguments& options) {
        auto* anonymous =
            sub->add_flag("--anonymous", options.anonymous,
                          "for others than the lab: times of each person set back by whole weeks that nobody keeps, "
                          "texts that somebody "
                          "typed left out; anonymity.csv says where, and which answers only few persons gave");
        sub->add_option("--band", options.bands,
                        "QUESTIONNAIRE.ITEM=WIDTH: answers told as the low end of ranges, demographics.age=10")
            ->needs(anonymous);
        sub->add_option("--small-cell", options.least_persons,
                        "number of persons below which an answer is listed; default 5")
            ->check(wholeFrom(1))
            ->needs(anonymous);
    }

    void addDataCommands() {
        auto* sub = command("export", "write all data as tables", export_, exportData);
        sub->add_option("DB", export_.database, "database of a study")->required();
        sub->add_option("--out", export_.out, "folder of the tables")->required();
        sub->add_flag("--no-samples", export_.no_samples, "leave out the recorded ticks");
        sub->add_option("--format", export_.format,
                        "plain: tables by their names; psych-ds: in data/, by the names and with the description of "
                        "Psych-DS (plain)")
            ->check(CLI::IsMember({"plain", "psych-ds"}));
        addAnonymity(sub, export_);
        addGroup(sub, export_.group);

        sub = command("report",
                      "write all data as tables with the planned analyses as a text of R, analysis.Rmd; where R is "
                      "installed, their report.html and results.json too",
                      report_, reportData);
        sub->add_option("DB", report_.database, "database of a study")->required();
        sub->add_option("--out", report_.out, "folder of the report")->required();
        report_.no_samples = true;
        sub->add_flag("!--samples,--no-samples", report_.no_samples,
                      "with --samples every recorded tick too; default: those that the pictures show");
        addAnonymity(sub, report_);
        addGroup(sub, report_.group);

        sub = command("merge", "put the databases of several stations together", merge_, merge);
        sub->add_option("DB", merge_.databases, "databases of one study")->required()->expected(1, -1);
        sub->add_option("--out", merge_.out, "database that gets what it does not have yet")->required();
        addGroup(sub, merge_.group);

        sub = command("push", "copy a study into PostgreSQL; from the second time on only what is new", push_, push);
        sub->add_option("DB", push_.database, "database of a study")->required();
        sub->add_option("--to", push_.to, "server and database: postgresql://USER@HOST/DATABASE, or as libpq reads it")
            ->required();

        sub = command("verify", "look for damage: every page, every hash, every checksum", verify_, verify);
        sub->add_option("DB", verify_.database, "database of a study; stays unchanged")->required();

        sub =
            command("restore", "heal a damaged database from a copy: only what is damaged changes", restore_, restore);
        sub->add_option("DB", restore_.database, "damaged database of a study")->required();
        sub->add_option("--from", restore_.from,
                        "copy: DB.backup, another database that has the sessions, or postgresql://USER@HOST/DATABASE")
            ->required();

        sub = command("replay", "run recorded inputs again and compare every bit", replay_, replay);
        addImport(sub, replay_.import_limits);
        sub->add_option("DB", replay_.database, "database of a study")->required();
        sub->add_option("--attempt", replay_.attempt, "attempt_id; default: all")->check(wholeFrom(1));
        sub->add_option("--meshes", replay_.meshes,
                        "folder that the protocol's mesh paths start from; default: here, else beside DB")
            ->check(CLI::ExistingDirectory);
    }

    void addPowerCommand() {
        auto* sub = command("power", "estimate how often a study like this one finds an effect that is really there",
                            power_, passung::cli::power);
        auto* protocol = sub->add_option("PROTOCOL", power_.protocol, "study file (.toml)");
        auto* effect = sub->add_option(
            "--effect", power_.effect,
            "effect FACTOR:LEVEL=DELTA~SPREAD, planted in every virtual study at one level of a factor, or "
            "FACTOR:LEVEL*FACTOR:LEVEL=DELTA~SPREAD, an interaction, where both are met. DELTA is +0.3 or -0.3 (added, "
            "in the measure's unit) or x1.2 (multiplied); +0 gives the rate of false positives. ~SPREAD: standard "
            "deviation of the effect between persons, of the logarithm where it is multiplied; without it everybody "
            "has the same effect, and the power is too high. A time that comes to lie above the time-out times out");
        sub->add_option("--against", power_.against, "level to compare with; default: the factor's first other one");
        sub->add_option("--measure", power_.measure, "measure of a trial; default time_s");
        sub->add_option("--test", power_.test,
                        "test of a within factor: paired_t, wilcoxon, rm_anova, friedman, mixed_anova; of a between "
                        "factor: welch_t, mann_whitney, mixed_anova; of either: lmm, survival, equivalence; of an "
                        "interaction: rm_anova, mixed_anova, lmm. What either or an interaction has is computed by R. "
                        "Default: the protocol's "
                        "analysis of that measure and factor, else paired_t or welch_t, rm_anova or mixed_anova")
            ->check(CLI::IsMember(passung::power::testNames()));
        sub->add_option("--participants", power_.participants,
                        "participants of a virtual study; default: the protocol's")
            ->check(wholeIntFrom(2));
        sub->add_option("--repeats", power_.repeats, "number of virtual studies; default 200")->check(wholeIntFrom(1));
        sub->add_option("--drop-out", power_.drop_out,
                        "share of participants who leave before the end, each before any trial alike; default 0")
            ->check(above0Below(1.0));
        sub->add_option(
               "--simulation", power_.simulation,
               "kind of virtual study. haptic (default): every trial, tick by tick, through database and means of the "
               "export. model: times drawn for the same people, orders and means, thousands of studies in seconds")
            ->check(CLI::IsMember({"haptic", "model"}));
        sub->add_option("--alpha", power_.alpha, "level of significance; default 0.05")->check(above0Below(0.8));
        sub->add_option("--seed", power_.seed, "seed instead of the protocol's")->check(wholeUnsigned());
        auto* out = sub->add_option("--out", power_.out,
                                    "file of results, a row per virtual study, written when all are done. Studies "
                                    "whose rows are there are not run again");
        sub->add_option_function<std::string>(
               "--shard", [this](const std::string& text) { readShard(text); },
               "part i/n: every n-th virtual study, the i-th first. Shards run anywhere, in any order")
            ->needs(out);
        auto* merge = sub->add_option("--merge", power_.merge,
                                      "files of all shards: the result is, byte for byte, that of one run without "
                                      "--shard. --out names its file")
                          ->excludes(protocol);
        sub->callback([this, protocol, effect, merge, sub] {
            if (merge->empty() && (protocol->empty() || effect->empty()))
                throw CLI::RequiredError("PROTOCOL and --effect, or --merge");
            if (!merge->empty() && sub->count_all() > merge->count() + sub->get_option("--out")->count() + 1)
                throw CLI::ExcludesError("--merge", "anything but --out");
            chosen_ = [this] { return passung::cli::power(power_); };
        });
    }

    void readShard(const std::string& text) {
        const auto shard = passung::power::shardNamed(text);
        if (!shard) throw CLI::ValidationError("--shard", "must be i/n with 1 ≤ i ≤ n, not \"" + text + '"');
        power_.shard = shard->index;
        power_.shards = shard->of;
    }

    void addCoreCommands() {
        const CLI::IsMember units({"m", "cm", "mm", "um", "in"});
        auto* sub = command("mesh", "report what a mesh file, or the mesh of a shape, is like", mesh_, mesh);
        sub->add_option("FILE", mesh_.file, "mesh (STL, OBJ, PLY, OFF, glTF, 3MF ...) or part.toml")->required();
        addImport(sub, mesh_.import_limits);
        sub->add_option("--unit", mesh_.unit, "unit of files that have none; default mm")->check(units);

        sub = command("query", "find distance, depth and wrench of two parts at given poses", query_, query);
        sub->add_option("FIELD", query_.field, "mesh or part.toml")->required();
        sub->add_option("SHELL", query_.shell, "mesh or part.toml")->required();
        sub->add_option("--poses", query_.poses,
                        "CSV of poses of SHELL in FIELD, in metres; header: x_m,y_m,z_m,qw,qx,qy,qz")
            ->required();
        sub->add_option("--out", query_.out,
                        "CSV of results: the poses and what was found. force_* and torque_* are the penalty on SHELL "
                        "about its origin, 1e9 N/m3 times depth times area, for comparisons: no device's force")
            ->required();
        sub->add_option("--tolerance-um", query_.tolerance_um,
                        "tolerance of the field and of every distance; default 20. Status bound_not_reached: the row's "
                        "error_bound_m is above the tolerance (few steps, hard pose, or --budget-nodes)")
            ->check(above0());
        sub->add_option("--cell-mm", query_.cell_mm, "cell of the field, instead of a tolerance")->check(above0());
        addImport(sub, query_.import_limits);
        sub->add_option("--spacing-mm", query_.spacing_mm, "spacing of the shell's points")->check(above0());
        sub->add_option("--mode", query_.mode, "mode of interpolation; default trilinear")->check(aMode());
        sub->add_option("--proximity-mm", query_.proximity_mm, "search no farther; default unlimited")
            ->check(atLeast0());
        sub->add_option("--budget-nodes", query_.budget_nodes, "most tree nodes a query visits")
            ->check(wholeIntFrom(1));
        sub->add_option("--quality", query_.quality, "least share of proven area; wins over the budget")
            ->check(between(0.0, 1.0, "a number from 0 to 1"));
        sub->add_flag("--two-way", query_.two_way, "ask each part's points against the other's field");
        sub->add_option("--patches", query_.patches,
                        "JSON of the patches of contact at every pose, the deepest first: deepest point, area, mean "
                        "normal and force of each; not with --two-way");
        sub->add_option("--unit", query_.unit, "unit of files that have none; default mm")->check(units);
        sub->add_option("--field-unit", query_.field_unit, "unit of FIELD, instead of --unit")->check(units);
        sub->add_option("--shell-unit", query_.shell_unit, "unit of SHELL, instead of --unit")->check(units);

        sub = command("simulate", "run a scene along a device path", simulate_, simulate);
        sub->add_option("SCENE", simulate_.scene, "scene file (.toml), not a study")->required();
        addImport(sub, simulate_.import_limits);
        sub->add_option("--trajectory", simulate_.trajectories,
                        "CSV of poses of the held part in the world, in seconds and metres; header: "
                        "t_s,x_m,y_m,z_m,qw,qx,qy,qz, and for effects of buttons a further column, buttons: a "
                        "number, bit 0 the first button, until the next row. Once for each hand of the scene, in their "
                        "order")
            ->required()
            ->allow_extra_args(false);
        sub->add_option("--out", simulate_.outs,
                        "CSV of ticks, once for each hand. force_* and torque_* are what the device would be told: on "
                        "the hand, in the world, about the held part's origin, after all limits")
            ->required()
            ->allow_extra_args(false);

        addAccuracyCommand(units);

        sub =
            command("bench", "compare our queries with other engines: time and error at the same poses", bench_, bench);
        sub->add_option("--out", bench_.out, "CSV of all rows");
        sub->add_option("--filter", bench_.filter,
                        "text that the rows' group and method contain: hard, forces, pieces, a mesh, an engine");
        sub->add_flag("--check", bench_.check, "compare with the marks; exit 1 if one is missed or not measured");

        addFeasibleCommand();

        sub = command("doctor", "show devices and permissions, and check the loop", doctor_, doctor);
        sub->add_option("--seconds", doctor_.seconds, "length of the loop check")
            ->check(between(0.1, 3600.0, "a number from 0.1 to 3600"));
        auto* device = sub->add_option("--device", doctor_.device, "device to show alone, without a loop check");
        auto* report = sub->add_option("--report", doctor_.report,
                                       "file of text for a bug report: all this and the logs of studies. No log tells "
                                       "of participants or what they did")
                           ->excludes(device);
        sub->add_option("--db", doctor_.databases,
                        "databases whose logs (DB.log) the report takes; default: all here and the windows'")
            ->needs(report);
        addStationFile(sub, doctor_.station_file);
        sub->add_option("--write-station", doctor_.write_station,
                        "station file to write with the real devices that were found, without a loop check; one that "
                        "is there already is left as it is")
            ->excludes(device);
        sub->add_flag("--find-stiffness", doctor_.find_stiffness,
                      "find the stiffest wall that the device bears while nobody holds it, and keep it as this user's "
                      "calibration: a stiffness \"max\" then stands for it")
            ->needs(device);
    }

    void addFeasibleCommand() {
        auto* sub = command("feasible",
                            "search a collision-free path for each step of an assembly or a peg_in_hole, with its "
                            "least clearance; exit 1 if one has none",
                            feasible_, feasible);
        sub->add_option("PROTOCOL", feasible_.protocol, "study file (.toml)")->required();
        addImport(sub, feasible_.import_limits);
        sub->add_option("--out", feasible_.out,
                        "folder for the paths: paths_N.csv of each distinct geometry, with a row for each waypoint, "
                        "and geometries.csv, which says whose it is");
        auto* json = sub->add_flag("--json", feasible_.json,
                                   "print JSON in place of the table, in SI units, with what is proven of each path");
        sub->add_flag("--keys", feasible_.keys,
                      "print the path's length of each step of an assembly as a line for its [[task.step]]")
            ->excludes(json);
        sub->add_option("--seed", feasible_.seed, "of the searches, from 1; default 1")
            ->check(between(1, 4294967295.0, "a whole number from 1 to 4294967295"));
        sub->add_option("--seconds", feasible_.seconds, "most time to search a step's path; default 30")
            ->check(between(0.1, 86400.0, "a number from 0.1 to 86400"));
    }

    void addAccuracyCommand(const CLI::Validator& units) {
        auto* sub = command("accuracy", "measure error against truth over time, of queries or of a scene's tick",
                            accuracy_, accuracy);
        sub->add_option(
               "FIELD", accuracy_.field,
               "watertight mesh or part.toml; with --trajectory the scene (.toml); alone a study (.toml), whose "
               "measured front is shown")
            ->required();
        addImport(sub, accuracy_.import_limits);
        auto* shell = sub->add_option("SHELL", accuracy_.shell, "mesh or part.toml; left out with --trajectory");
        auto* out =
            sub->add_option("--out", accuracy_.out,
                            "folder for accuracy.csv, accuracy.svg, codebook.csv, without --trajectory poses.csv");
        auto* trajectory =
            sub->add_option("--trajectory", accuracy_.trajectory,
                            "CSV of poses of the held part, as for simulate: the scene's tick is measured "
                            "along it, in every way to render it")
                ->excludes(shell);
        addStudyOptions(sub, {shell, out, trajectory});
        sub->parse_complete_callback([this, out] {
            const bool study = accuracy_.trajectory.empty() && accuracy_.shell.empty();
            if (study && (out->count() > 0 || !accuracy_.field.ends_with(".toml"))) throw CLI::RequiredError("SHELL");
            if (!study && out->count() == 0) throw CLI::RequiredError("--out");
        });
        addAccuracyLevels(sub);
        addPairOptions(sub, trajectory, units);
        addTickOptions(sub, trajectory);
        sub->add_option("--repetitions", accuracy_.repetitions,
                        "repetitions, the fastest of which is the time of a pose or tick; default 5")
            ->check(wholeIntFrom(1));
    }

    /// Of a study's measured front alone; `others` are of all else.
    void addStudyOptions(CLI::App* sub, const std::vector<CLI::Option*>& others) {
        auto* measure = sub->add_flag("--measure", accuracy_.measure,
                                      "measure the front of the study anew and keep it beside the study, which takes "
                                      "minutes");
        auto* conditions = sub->add_option("--conditions", accuracy_.conditions,
                                           "names of the conditions that are measured; default: the first whose trials "
                                           "the program times")
                               ->delimiter(',')
                               ->expected(1, -1)
                               ->needs(measure);
        auto* commit =
            sub->add_option("--commit", accuracy_.commit, "commit of the program's sources, to be kept with it")
                ->needs(measure);
        for (CLI::Option* option : {measure, conditions, commit})
            for (CLI::Option* other : others) option->excludes(other);
    }

    static CLI::Option* list(CLI::Option* option) { return option->delimiter(',')->expected(1, -1); }

    void addAccuracyLevels(CLI::App* sub) {
        list(sub->add_option("--tolerances-um", accuracy_.tolerances_um,
                             "tolerances of the field; default 100,50,20,10, of a scene twice its own and its own")
                 ->check(above0()));
        list(
            sub->add_option("--spacings-mm", accuracy_.spacings_mm,
                            "spacings of SHELL's points; default: four around a fiftieth of SHELL's longest side, of a "
                            "scene twice its own and its own")
                ->check(above0()));
        list(sub->add_option("--budgets", accuracy_.budgets,
                             "most nodes of a query, 0: no limit; default 0,1000,300,100, of a scene its own")
                 ->check(wholeIntFrom(0)));
        list(sub->add_option("--modes", accuracy_.modes, "modes of interpolation; default: all, of a scene its own")
                 ->check(aMode()));
    }

    /// Of queries of a pair alone.
    void addPairOptions(CLI::App* sub, CLI::Option* trajectory, const CLI::Validator& units) {
        auto* poses = sub->add_option("--poses", accuracy_.poses,
                                      "CSV of poses of SHELL in FIELD, as for query; default: along contact paths")
                          ->excludes(trajectory);
        sub->add_option("--paths", accuracy_.paths, "contact paths of 11 poses each; default 12")
            ->check(wholeIntFrom(1))
            ->excludes(poses)
            ->excludes(trajectory);
        sub->add_option("--seed", accuracy_.seed, "seed of the paths; default 1")
            ->check(wholeUnsigned())
            ->excludes(trajectory);
        sub->add_option("--fcl-poses", accuracy_.fcl_poses,
                        "number of further poses whose separation and intersection are compared with FCL; default 1000")
            ->check(wholeIntFrom(0))
            ->excludes(trajectory);
        sub->add_option("--unit", accuracy_.unit, "unit of files that have none; default mm")
            ->check(units)
            ->excludes(trajectory);
        sub->add_option("--field-unit", accuracy_.field_unit, "unit of FIELD, instead of --unit")
            ->check(units)
            ->excludes(trajectory);
        sub->add_option("--shell-unit", accuracy_.shell_unit, "unit of SHELL, instead of --unit")
            ->check(units)
            ->excludes(trajectory);
    }

    /// Of a scene's tick alone.
    void addTickOptions(CLI::App* sub, CLI::Option* trajectory) {
        list(sub->add_option("--methods", accuracy_.methods, "methods of contact; default: all")
                 ->check(CLI::IsMember({"penalty", "god_object_heuristic", "god_object"})))
            ->needs(trajectory);
        list(sub->add_option("--geometries", accuracy_.geometries,
                             "geometries of contact; default: all that the scene's parts can have")
                 ->check(CLI::IsMember({"closed_form", "surface", "field"})))
            ->needs(trajectory);
        list(sub->add_option("--ways", accuracy_.ways,
                             "1: points of the held part, 2: of both parts (two_way); default: the scene's own")
                 ->check(CLI::IsMember({"1", "2"})))
            ->needs(trajectory);
        sub->add_option("--every", accuracy_.every,
                        "ticks from one whose overlap and force are judged to the next; default 20. Those of largest "
                        "recorded overlap and force are judged besides")
            ->check(wholeIntFrom(1))
            ->needs(trajectory);
    }

    CLI::App app_;
    std::function<int()> chosen_;
    CheckArguments check_;
    PlanArguments plan_;
    ExplainArguments explain_;
    RunArguments run_;
    ParticipantArguments participant_;
    ResumeArguments resume_;
    SessionArguments session_;
    ExportArguments export_, report_;
    MergeArguments merge_;
    PushArguments push_;
    VerifyArguments verify_;
    RestoreArguments restore_;
    ReplayArguments replay_;
    PowerArguments power_;
    MeshArguments mesh_;
    QueryArguments query_;
    SimulateArguments simulate_;
    AccuracyArguments accuracy_;
    BenchArguments bench_;
    FeasibleArguments feasible_;
    DoctorArguments doctor_;
};

}  // namespace

namespace passung::cli {

int runCommandLine(int argc, char** argv) { return CommandLine().run(argc, argv); }

}  // namespace passung::cli
