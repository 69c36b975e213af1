#include <CLI/CLI.hpp>

#include <cstdio>
#include <exception>
#include <functional>

#include "ui/cli/commands.h"

// The command line: names, options and their help. What a command does is in its own file.

namespace {

using namespace passung::cli;

constexpr int kWrongUsage = 2;

class CommandLine {
public:
    CommandLine() : app_("Passung: user studies of haptic manipulation") {
        app_.set_version_flag("--version", PASSUNG_VERSION);
        app_.require_subcommand(1);
        addStudyCommands();
        addDataCommands();
        addCoreCommands();
    }

    int run(int argc, char** argv) {
        try {
            app_.parse(argc, argv);
        } catch (const CLI::ParseError& error) {
            return app_.exit(error) == 0 ? 0 : kWrongUsage;
        }
        return chosen_();
    }

private:
    template <class Options>
    CLI::App* command(const char* name, const char* help, Options& options, int (*function)(const Options&)) {
        CLI::App* sub = app_.add_subcommand(name, help);
        sub->callback([this, &options, function] { chosen_ = [&options, function] { return function(options); }; });
        return sub;
    }

    void addStudyCommands() {
        auto* sub = command("check", "validate a protocol: every problem with its place", check_, check);
        sub->add_option("PROTOCOL", check_.protocol, "study file (.toml)")->required();

        sub = command("explain", "design, orders and balance, or the stages of a scene's tick", explain_, explain);
        sub->add_option("FILE", explain_.file, "protocol or scene")->required();
        sub->add_option("--participants", explain_.participants, "how many orders to print")
            ->check(CLI::PositiveNumber);

        sub = command("run", "perform a study with simulated participants", run_, passung::cli::run);
        sub->add_option("PROTOCOL", run_.protocol, "study file (.toml)")->required();
        sub->add_option("--db", run_.database, "database; default: the study's name with .db");
        auto* participant = sub->add_option("--participant", run_.participant, "code of one participant");
        sub->add_option("--simulated", run_.simulated, "number of new participants; default 1")
            ->check(CLI::PositiveNumber)
            ->excludes(participant);
        sub->add_flag("--real-time", run_.real_time, "at 1 kHz by the clock instead of as fast as the machine goes");
        sub->add_option("--seed", run_.seed, "instead of the protocol's")->check(CLI::NonNegativeNumber);
        sub->add_option("--acknowledge-fd", run_.acknowledge_fd, "file descriptor for a line per durable attempt");
    }

    void addDataCommands() {
        auto* sub = command("export", "write all data as tables", export_, exportData);
        sub->add_option("DB", export_.database, "database of a study")->required();
        sub->add_option("--out", export_.out, "folder")->required();
        sub->add_flag("--no-samples", export_.no_samples, "leave out the recorded ticks");

        sub = command("replay", "run recorded inputs again and compare every bit", replay_, replay);
        sub->add_option("DB", replay_.database, "database of a study")->required();
        sub->add_option("--attempt", replay_.attempt, "attempt_id; default: all")->check(CLI::PositiveNumber);
        sub->add_option("--meshes", replay_.meshes,
                        "folder that the protocol's mesh paths start from; default: here, else beside DB")
            ->check(CLI::ExistingDirectory);
    }

    void addCoreCommands() {
        const CLI::IsMember units({"m", "cm", "mm", "um", "in"});
        auto* sub = command("mesh", "report what a mesh file is like", mesh_, mesh);
        sub->add_option("FILE", mesh_.file, "STL, OBJ, PLY, OFF, glTF, 3MF ...")->required();
        sub->add_option("--unit", mesh_.unit, "of files that have none; default mm")->check(units);

        sub = command("query", "distance, depth and wrench of two parts at given poses", query_, query);
        sub->add_option("FIELD", query_.field, "mesh or part.toml")->required();
        sub->add_option("SHELL", query_.shell, "mesh or part.toml")->required();
        sub->add_option("--poses", query_.poses, "CSV of poses of SHELL in FIELD")->required();
        sub->add_option("--out", query_.out, "CSV of results")->required();
        sub->add_option("--tolerance-um", query_.tolerance_um, "of the field")->check(CLI::PositiveNumber);
        sub->add_option("--cell-mm", query_.cell_mm, "of the field, instead of a tolerance")
            ->check(CLI::PositiveNumber);
        sub->add_option("--spacing-mm", query_.spacing_mm, "of the shell")->check(CLI::PositiveNumber);
        sub->add_option("--mode", query_.mode, "of interpolation: trilinear, linear")
            ->check(CLI::IsMember({"trilinear", "linear"}));
        sub->add_option("--proximity-mm", query_.proximity_mm, "search no farther; default unlimited")
            ->check(CLI::NonNegativeNumber);
        sub->add_option("--budget-nodes", query_.budget_nodes, "most tree nodes a query visits")
            ->check(CLI::PositiveNumber);
        sub->add_option("--quality", query_.quality, "least share of proven area; wins over the budget")
            ->check(CLI::Range(0.0, 1.0));
        sub->add_flag("--two-way", query_.two_way, "each part's points against the other's field");
        sub->add_option("--unit", query_.unit, "of files that have none; default mm")->check(units);
        sub->add_option("--field-unit", query_.field_unit, "of FIELD, instead of --unit")->check(units);
        sub->add_option("--shell-unit", query_.shell_unit, "of SHELL, instead of --unit")->check(units);

        sub = command("simulate", "run a scene along a device path", simulate_, simulate);
        sub->add_option("SCENE", simulate_.scene)->required();
        sub->add_option("--trajectory", simulate_.trajectory, "CSV of device poses")->required();
        sub->add_option("--out", simulate_.out, "CSV of ticks")->required();

        sub = command("doctor", "devices, permissions and a check of the loop", doctor_, doctor);
        sub->add_option("--seconds", doctor_.seconds, "of the loop check")->check(CLI::Range(0.1, 3600.0));
    }

    CLI::App app_;
    std::function<int()> chosen_;
    CheckOptions check_;
    ExplainOptions explain_;
    RunOptions run_;
    ExportOptions export_;
    ReplayOptions replay_;
    MeshOptions mesh_;
    QueryOptions query_;
    SimulateOptions simulate_;
    DoctorOptions doctor_;
};

}  // namespace

int main(int argc, char** argv) {
    try {
        return CommandLine().run(argc, argv);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "error: %s\n", error.what());
        return 1;
    }
}
