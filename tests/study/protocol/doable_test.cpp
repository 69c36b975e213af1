#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <tuple>

#include "core/shape/shape.h"
#include "study/protocol/protocol_reader.h"
#include "tests/study/protocol/known_names.h"

namespace passung::protocol {
namespace {

const std::string kBlock = R"(shape = { kind = "box", width = 20, depth = 20, height = 20 })";
const std::string kPlate =
    R"(shape = { kind = "bore_plate", width = 60, depth = 60, height = 30, bore_diameter = 21, bore_depth = 25 })";
const std::string kPeg = R"(shape = { kind = "peg", diameter = 20, length = 50 })";
const std::string kBall = R"(shape = { kind = "sphere", diameter = 10 })";
const std::string kHollow = "mesh = \"hollow.off\"";
const std::string kThroughPlate =
    R"(shape = { kind = "bore_plate", width = 60, depth = 60, height = 20, bore_diameter = 21, bore_depth = "through" })";
const std::string kInsert = "type = \"peg_in_hole\"\ntarget = \"still\"\n";
const std::string kThrough = "type = \"narrow_passage\"\ntarget = \"still\"\n";
const std::string kLine = "type = \"contour_following\"\ntarget = \"still\"\n";

std::string place(const std::string& position, const std::string& more = {}) {
    return "type = \"free_placement\"\nposition = " + position + "\n" + more;
}

std::string line(const std::string& points, const std::string& more = {}) {
    return kLine + "points = " + points + "\n" + more;
}

/// A study as its author writes it; what is left out is usual.
struct Study {
    std::string unit = "mm";
    std::string held = kBlock, held_pose = "position = [0, 0, 30]";
    std::string still = kPlate, still_pose = "position = [0, 0, 0]";
    std::string device = "sigma7";
    std::string task = place("[20, 0, 40]");
    std::string contact = {}, registration = {}, gate = {}, more = {};

    std::string text() const {
        std::string scene =
            "passung = 1\n[study]\nname = \"s\"\nversion = \"1\"\nseed = 1\nparticipants = 4\n[scene]\n";
        scene += "unit = \"" + unit + "\"\n[[scene.part]]\nname = \"still\"\n" + still + "\npose = { " + still_pose +
                 " }\n[[scene.part]]\nname = \"held\"\nheld = true\n" + held + "\npose = { " + held_pose + " }\n";
        scene += "[scene.contact]\n" + contact + "\n[scene.device]\npreset = \"" + device + "\"\n";
        scene += "[scene.registration]\n" + registration + "\n[scene.start_gate]\n" + gate + "\n[task]\n" + task;
        return scene + "\n[[block]]\nname = \"main\"\norder = \"listed\"\n" + more;
    }
};

/// Meshes that the studies name, in a folder that goes with it.
class Folder {
public:
    Folder() : path_(std::filesystem::temp_directory_path() / ("passung_doable_" + std::to_string(getpid()))) {
        std::filesystem::create_directories(path_);
    }
    ~Folder() { std::filesystem::remove_all(path_); }
    std::string file(const std::string& name) const { return (path_ / name).string(); }

    /// A block of 40 x 40 x 10 mm, top at z = 0, and another shape on it, in one OFF file [mm].
    void write(const std::string& name, const shape::Shape& shape, double height) const {
        geometry::TriangleMesh mesh = shape::tessellate(shape::Box{40, 40, 10}, 0.01);
        for (Vec3& v : mesh.vertices) v.z() -= 5;
        const geometry::TriangleMesh other = shape::tessellate(shape, 0.01);
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        for (const Vec3& v : other.vertices) mesh.vertices.emplace_back(v + Vec3(0, 0, 0.25 * height));
        for (const auto& t : other.triangles) mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
        std::ofstream out(file(name));
        out << "OFF\n" << mesh.vertices.size() << ' ' << mesh.triangles.size() << " 0\n";
        for (const Vec3& v : mesh.vertices) out << v.x() << ' ' << v.y() << ' ' << v.z() << '\n';
        for (const auto& t : mesh.triangles) out << "3 " << t[0] << ' ' << t[1] << ' ' << t[2] << '\n';
    }

    /// A closed box of 60 mm with walls of 5 mm, in one OFF file [mm].
    void writeHollow(const std::string& name) const {
        const auto outer = shape::tessellate(shape::Box{60, 60, 60}, 0.01);
        const auto inner = shape::tessellate(shape::Box{50, 50, 50}, 0.01);
        std::ofstream out(file(name));
        out << "OFF\n" << 2 * outer.vertices.size() << ' ' << 2 * outer.triangles.size() << " 0\n";
        for (const auto& mesh : {outer, inner})
            for (const Vec3& v : mesh.vertices) out << v.x() << ' ' << v.y() << ' ' << v.z() << '\n';
        const std::size_t first = outer.vertices.size();
        for (const auto& t : outer.triangles) out << "3 " << t[0] << ' ' << t[1] << ' ' << t[2] << '\n';
        for (const auto& t : inner.triangles)
            out << "3 " << t[0] + first << ' ' << t[2] + first << ' ' << t[1] + first << '\n';
    }

private:
    std::filesystem::path path_;
};

/// What check says of it: errors, what keeps people out, warnings; a line each.
std::vector<std::string> told(const Study& study, const Folder& folder) {
    const std::string path = folder.file("s.toml");
    std::ofstream(path) << study.text();
    const Examined examined = examineProtocol(path, knownDevices(), knownMeasures());
    std::vector<std::string> lines;
    for (const Errors& errors : {examined.errors, examined.for_people})
        for (const Error& error : errors) lines.push_back(toString(error));
    lines.insert(lines.end(), examined.plan.warnings.begin(), examined.plan.warnings.end());
    return lines;
}

struct Row {
    const char* name;
    Study study;
    std::vector<std::string> says;  // all of it in one line
};

std::string staircase(const std::string& levels, const std::string& side) {
    return R"([[staircase]]
name = "threshold"
block = "main"
key = "task.comparison.contact.stiffness_N_per_m"
levels = )" +
           levels +
           "\nrule = \"psi\"\nguess = 0.5\nsigma_low = 10\nsigma_high = 300\nmax_trials = 20\n"
           "tracks = [{ name = \"a\" }]\nmeasure = \"correct\"\n" +
           side + " = 0.5\n";
}

Study pair(const std::string& levels, const std::string& side) {
    return {.task =
                "type = \"discrimination_pair\"\ntarget = \"still\"\nquestion = \"Which was stiffer?\"\n"
                "comparison = { \"contact.stiffness_N_per_m\" = 1000 }\n",
            .contact = "stiffness_N_per_m = 800",
            .gate = "position_tolerance_mm = 3\nhold_ms = 200",
            .more = staircase(levels, side)};
}

Study changed(Study study, const std::string& task) {
    study.task += task;
    return study;
}

/// A pair whose comparison has what the reference has.
Study same() {
    return {.task =
                "type = \"discrimination_pair\"\ntarget = \"still\"\nquestion = \"Which was stiffer?\"\n"
                "comparison = { \"contact.stiffness_N_per_m\" = 800 }\n",
            .contact = "stiffness_N_per_m = 800",
            .gate = "position_tolerance_mm = 3\nhold_ms = 200"};
}

std::string consent(const std::string& text) {
    return "[[consent]]\nclause = \"data\"\n[consent.text]\nen = \"" + text + "\"\n";
}

/// A line of 78 mm at `height` over the plate that bends down, or up, and has 1000 corners from `from` to `to` there.
std::string bentLine(double height, double from, double to) {
    std::string points = "[[-50, 25, " + std::to_string(height) + "], [28, 25, " + std::to_string(height) + "]";
    for (int i = 0; i < 1000; ++i) points += ", [28, 25, " + std::to_string(from + (to - from) * i / 999.0) + "]";
    return points + "]";
}

/// A pair that is seen only, whose comparison has this instead.
Study seen(const std::string& comparison, const std::string& feedback = {}) {
    Study study = same();
    study.task.replace(study.task.find("\"contact"), 33, comparison);
    study.more = "[feedback]\nkinesthetic = false\n" + feedback;
    return study;
}

const std::string kPin = "mesh = \"pin.off\"", kFin = "mesh = \"fin.off\"";

std::vector<Row> undoable() {
    const std::string small = R"(shape = { kind = "box", width = 0.02, depth = 0.02, height = 0.03 })";
    const std::string far_plate = "position = [0, 0, -60]";
    return {
        {"goal 5 m away", {.task = place("[5000, 0, 30]")}, {"task.position", "5000 mm", "sigma7", "75 mm"}},
        {"goal 40 cm off on a device of 4 cm",
         {.device = "falcon", .task = place("[0, 400, 30]")},
         {"task.position", "falcon", "40 mm"}},
        {"goal just outside", {.task = place("[0, 0, 81]")}, {"task.position", "81 mm"}},
        {"goal in inches",
         {.unit = "in",
          .held = R"(shape = { kind = "sphere", diameter = 1 })",
          .held_pose = "position = [0, 0, 1]",
          .still = R"(shape = { kind = "box", width = 2, depth = 2, height = 0.5 })",
          .task = place("[4, 0, 1]")},
         {"task.position", "104.7 mm"}},
        {"goal in the plate", {.task = place("[0, 25, -15]")}, {"task.position", "deep in part still"}},
        {"goal in a mesh",
         {.still = "mesh = \"post.off\"", .task = place("[0, 0, 5]", "position_tolerance_mm = 2\n")},
         {"task.position", "deep in part still"}},
        {"start in a mesh",
         {.held_pose = "position = [0, 0, 8]", .still = "mesh = \"post.off\""},
         {"pose", "deep in part still"}},
        {"start out of reach", {.held_pose = "position = [0, 0, 90]"}, {"scene.part.held.pose", "90 mm"}},
        {"start out of reach in cm",
         {.unit = "cm",
          .held = R"(shape = { kind = "box", width = 2, depth = 2, height = 2 })",
          .held_pose = "position = [0, 0, 12]",
          .still = R"(shape = { kind = "box", width = 6, depth = 6, height = 1 })",
          .device = "touch",
          .task = place("[0, 0, 4]")},
         {"pose", "120 mm", "touch"}},
        {"base elsewhere", {.registration = "position = [200, 0, 0]"}, {"pose", "202.2 mm"}},
        {"scaled down", {.registration = "scale = 0.2"}, {"pose", "150 mm", "workspace"}},
        {"handle far from the part", {.registration = "handle_position = [0, 0, 120]"}, {"pose", "90 mm"}},
        {"turn on a handle that cannot",
         {.device = "falcon", .task = place("[0, 10, 30]", "rotation_deg = [0, 0, 40]\n")},
         {"task.rotation_deg", "40 degrees", "falcon"}},
        {"peg that starts tilted on a handle that cannot turn",
         {.held = kPeg,
          .held_pose = "position = [0, 0, 20], rotation_deg = [30, 0, 0]",
          .device = "falcon",
          .task = kInsert},
         {"task.target", "30 degrees"}},
        {"placement finer than encoders",
         {.device = "falcon", .task = place("[0, 5, 30]", "position_tolerance_mm = 0.05\n")},
         {"task.position_tolerance_mm", "0.064 mm"}},
        {"gate finer than encoders",
         {.device = "touch", .gate = "position_tolerance_mm = 0.02\nhold_ms = 100"},
         {"start_gate.position_tolerance_mm", "0.055 mm"}},
        {"line 40 cm away", {.task = line("[[20, 0, 0], [400, 0, 0]]")}, {"task.points", "400 mm"}},
        {"line in the plate", {.task = line("[[20, 0, -12], [25, 0, 0]]")}, {"task.points", "deep in part still"}},
        {"box led where its origin alone has room",
         {.task = line("[[12, 0, 0], [25, 0, 0]]")},
         {"task.points", "no room", "100 %"}},
        {"ball led down a bore that is too narrow for it",
         {.held = R"(shape = { kind = "sphere", diameter = 40 })", .task = line("[[0, 0, -8], [0, 0, -20]]")},
         {"task.points", "no room"}},
        {"line without room but for many corners",
         {.held = R"(shape = { kind = "sphere", diameter = 20 })",
          .task = line(bentLine(5, 12, 14), "reach_mm = 1\ncoverage = 0.5\n")},
         {"task.points", "no room", "9"}},
        {"line at a surface that stops the part",
         {.held = R"(shape = { kind = "sphere", diameter = 12 })",
          .task = line("[[12, -20, 0], [12, 20, 0]]", "reach_mm = 5\nforce_N = 2\n")},
         {"task.points", "no room"}},
        {"passage with a floor",
         {.held = kBall, .task = kThrough + "passage_length_mm = 30\npassage_width_mm = 8\n"},
         {"task.target", "blocked or too narrow"}},
        {"passage blocked behind",
         {.held = kBall,
          .still = kThroughPlate,
          .task = kThrough + "passage_length_mm = 20\npassage_width_mm = 8\n",
          .more = "[[scene.part]]\nname = \"lid\"\nshape = { kind = \"box\", width = 40, depth = 40, height = 4 }\n"
                  "pose = { position = [0, 0, -22.5] }\n"},
         {"task.target", "blocked or too narrow"}},
        {"start beyond the passage",
         {.held = kBall,
          .held_pose = "position = [0, 0, -40]",
          .still = kThroughPlate,
          .task = kThrough + "passage_length_mm = 20\npassage_width_mm = 8\n"},
         {"task.target", "beyond the passage"}},
        {"goal in a closed box",
         {.held = kBall, .held_pose = "position = [0, 0, 50]", .still = kHollow, .task = place("[0, 0, 0]")},
         {"task.position", "no way leads"}},
        {"start in a closed box",
         {.held = kBall, .held_pose = "position = [0, 0, 0]", .still = kHollow, .task = place("[0, 0, 50]")},
         {"task.position", "no way leads"}},
        {"line in a closed box",
         {.held = kBall,
          .held_pose = "position = [0, 0, 50]",
          .still = kHollow,
          .task = line("[[-10, 0, 0], [10, 0, 0]]")},
         {"task.points", "no way leads"}},
        {"line pressed too hard",
         {.device = "touch", .task = line("[[20, 0, 0], [25, 0, 0]]", "force_N = 5\n")},
         {"task.force_N", "touch", "3.3 N"}},
        {"line too fast",
         {.task = line("[[20, -25, 0], [20, 25, 0], [25, -25, 0], [25, 25, 0]]", "timeout_s = 0.1\n")},
         {"task.timeout_s", "too short"}},
        {"goal too fast", {.task = place("[0, 50, 30]", "timeout_s = 0.02\n")}, {"task.timeout_s", "too short"}},
        {"passage longer than the reach",
         {.held = R"(shape = { kind = "sphere", diameter = 10 })",
          .task = kThrough + "passage_length_mm = 200\npassage_width_mm = 8\n"},
         {"task.target", "end of the passage"}},
        {"passage too narrow",
         {.held = R"(shape = { kind = "sphere", diameter = 30 })",
          .still =
              R"(shape = { kind = "bore_plate", width = 60, depth = 60, height = 20, bore_diameter = 21, bore_depth = "through" })",
          .task = kThrough + "passage_length_mm = 20\npassage_width_mm = 2\n"},
         {"task.target", "does not fit through"}},
        {"bore out of reach",
         {.held = kPeg, .held_pose = "position = [20, 0, 30]", .still_pose = far_plate, .task = kInsert},
         {"task.target", "79 mm"}},
        {"a slot that takes a quarter turn on a handle that cannot turn",
         {.held = R"(shape = { kind = "box", width = 18, depth = 8, height = 8 })",
          .still =
              R"(shape = { kind = "square_bore_plate", width = 60, depth = 60, height = 20, pocket_width = 10, pocket_depth = 20, bore_depth = "through" })",
          .device = "falcon",
          .task = kThrough + "passage_length_mm = 20\npassage_width_mm = 4\nleave_radius_mm = 5\n"},
         {"task.target", "does not fit through"}},
        {"a pair that nobody can touch",
         [] {
             Study study = pair("[900, 1000, 1100]", "above");
             study.still_pose = "position = [0, 0, -300]";
             return study;
         }(),
         {"task.target", "within"}},
        {"something in the bore",
         {.held = kPeg,
          .task = kInsert,
          .more = "[[scene.part]]\nname = \"plug\"\nshape = { kind = \"sphere\", diameter = 12 }\npose = { position = "
                  "[0, 0, -16] }\n"},
         {"task.target", "deep in part plug"}},
        {"over before a hand moves",
         {.task = place("[0, 5, 30]", "timeout_s = 0.06\n")},
         {"task.timeout_s", "reaction"}},
        {"held for all but a millisecond",
         {.held = kPeg, .task = kInsert + "hold_s = 29.999\n"},
         {"task.hold_s", "at most 29.85 s"}},
        {"held without a tremor",
         {.held = kPeg, .task = kInsert + "max_speed_mm_per_s = 1e-6\n"},
         {"task.max_speed_mm_per_s", "calm"}},
        {"turned to a millionth of a degree",
         {.task = place("[20, 0, 40]", "angle_tolerance_deg = 1e-6\n")},
         {"task.angle_tolerance_deg", "finer than a hand on sigma7"}},
        {"gate turned to a millionth of a degree",
         {.gate = "angle_tolerance_deg = 1e-6\nhold_ms = 100"},
         {"start_gate.angle_tolerance_deg", "finer than a hand"}},
        {"placed to a nanometre",
         {.task = place("[20, 0, 40]", "position_tolerance_mm = 1e-6\n")},
         {"task.position_tolerance_mm", "finer than"}},
        {"intervals of a millisecond",
         changed(pair("[900, 1000, 1100]", "above"), "interval_s = 0.001\n"),
         {"task.interval_s", "at least 0.1 s"}},
        {"answers in a millisecond",
         changed(pair("[900, 1000, 1100]", "above"), "answer_s = 0.001\n"),
         {"task.answer_s", "at least 0.15 s"}},
        {"stimuli to be answered at once",
         {.held = kBall,
          .still = kThroughPlate,
          .task = kThrough + "passage_length_mm = 20\npassage_width_mm = 8\n",
          .more = "[secondary]\nstimulus = \"audio\"\ninterval_min_s = 3\nresponse_min_ms = 1\nresponse_max_ms = 20\n"
                  "button = 3\n"},
         {"secondary.response_max_ms", "150 ms"}},
        {"a pair whose proxies are not drawn",
         seen(R"("contact.method" = "penalty")", "shown_pose = \"device\"\n"),
         {"task.comparison", "felt, seen or heard"}},
        {"a comparison that is its reference", same(), {"task.comparison", "nothing to tell apart"}},
        {"a pair without anything to compare",
         [] {
             Study study = pair("[900, 1000, 1100]", "above");
             study.more += "[feedback]\nkinesthetic = false\n";
             return study;
         }(),
         {"task.comparison", "felt, seen or heard"}},
        {"held longer than it lasts", {.held = kPeg, .task = kInsert + "hold_s = 40\n"}, {"task.hold_s"}},
        {"clock that never starts",
         {.task = place("[0, 20, 40]", "leave_radius_mm = 300\n")},
         {"task.leave_radius_mm"}},
        {"metres under mm",
         {.held = small,
          .held_pose = "position = [0, 0, 0.06]",
          .still = R"(shape = { kind = "box", width = 0.06, depth = 0.06, height = 0.03 })",
          .task = place("[0.01, 0, 0.05]", "position_tolerance_mm = 0.005\n")},
         {"held part held", "0.03 mm", "\"m\" meant"}},
        {"centimetres under mm",
         {.held = R"(shape = { kind = "box", width = 1, depth = 1, height = 1.9 })",
          .held_pose = "position = [0, 0, 4]",
          .still = R"(shape = { kind = "box", width = 6, depth = 6, height = 1 })",
          .task = place("[1, 0, 3]", "position_tolerance_mm = 0.5\n")},
         {"held part held", "1.9 mm", "meant"}},
        {"millimetres under m",
         {.unit = "m",
          .held = R"(shape = { kind = "box", width = 3, depth = 0.02, height = 0.02 })",
          .held_pose = "position = [0, 0, 0.05]",
          .still = R"(shape = { kind = "box", width = 0.06, depth = 0.06, height = 0.03 })",
          .device = "hug",
          .task = place("[0.1, 0, 0.1]")},
         {"held part held", "3000 mm"}},
        {"comparisons below the reference", pair("[200, 400, 600]", "above"), {"threshold", "200", "reference, 800"}},
        {"comparisons on both sides", pair("[700, 900, 1100]", "above"), {"threshold", "700", "reference, 800"}},
        {"comparisons above, fewer correct",
         pair("[900, 1000, 1100]", "below"),
         {"threshold", "900", "reference, 800"}},
        {"date not filled in", {.more = consent("Deleted until YYYY-MM-DD.")}, {"consent.data.text.en", "YYYY-MM-DD"}},
        {"German date not filled in", {.more = consent("Bis zum TT.MM.JJJJ.")}, {"TT.MM.JJJJ"}},
        {"English date not filled in", {.more = consent("By DD/MM/YYYY at the latest")}, {"DD/MM/YYYY"}},
        {"pin between the points",
         {.still = kPin, .contact = "geometry = \"field\"\nspacing_mm = 1\ntwo_way = false"},
         {"part.still", "a pin ", "slips", "two_way"}},
        {"fin between the points",
         {.still = kFin, .contact = "geometry = \"field\"\nspacing_mm = 1\ntwo_way = false"},
         {"part.still", "wall 0.5 mm"}},
        {"fin lost in cells",
         {.still = kFin, .contact = "geometry = \"field\"\ncell_mm = 0.5"},
         {"part.still", "wall 0.5 mm", "cells of 0.5 mm"}},
        {"plate lost in cells",
         {.still = R"(shape = { kind = "box", width = 60, depth = 60, height = 0.8 })",
          .contact = "geometry = \"field\"\ncell_mm = 0.5"},
         {"part.still", "wall 0.8 mm", "cell_mm"}},
        {"thin rim of a bore",
         {.still =
              R"(shape = { kind = "bore_plate", width = 22, depth = 60, height = 30, bore_diameter = 21, bore_depth = 25 })",
          .contact = "geometry = \"field\"\ntwo_way = false"},
         {"part.still", "wall 0.5 mm"}},
        {"sheet one way",
         {.still = R"(shape = { kind = "sheet", width = 60, depth = 60 })",
          .contact = "geometry = \"field\"\ntwo_way = false"},
         {"part.still", "wall 0 mm"}},
        {"wall below the tolerance",
         {.still = R"(shape = { kind = "box", width = 60, depth = 60, height = 0.1 })",
          .contact = "geometry = \"field\"\ntolerance_um = 100"},
         {"part.still", "wall 0.1 mm", "tolerance"}},
        {"needle on needle",
         {.held = R"(shape = { kind = "cylinder", diameter = 0.3, length = 40 })",
          .still = R"(shape = { kind = "cylinder", diameter = 0.3, length = 40 })",
          .still_pose = "position = [30, 0, -10]",
          .contact = "geometry = \"field\"\nspacing_mm = 2\ntwo_way = true"},
         {"part.still", "pin 0.3 mm", "held part"}},
        {"too stiff by its scale",
         {.device = "touch", .contact = "stiffness_N_per_m = 300", .registration = "scale = 2"},
         {"stiffness_N_per_m", "scale of 2"}},
        {"damped too much by its scale",
         {.contact = "damping_Ns_per_m = 5", .registration = "scale = 2"},
         {"damping_Ns_per_m", "2.5"}},
    };
}

std::vector<Row> odd() {
    const std::string ball = R"(shape = { kind = "sphere", diameter = 10 })";
    return {
        {"a small device scaled up",
         {.device = "falcon", .task = place("[150, 0, 40]"), .registration = "scale = 5"},
         {}},
        {"a large one scaled down", {.device = "hug", .registration = "scale = 0.2"}, {}},
        {"stiff for its scale",
         {.task = place("[10, 0, 32]"),
          .contact = "stiffness_N_per_m = 2000\ndamping_Ns_per_m = 10",
          .registration = "scale = 0.5"},
         {}},
        {"soft for its scale",
         {.device = "touch", .contact = "stiffness_N_per_m = 100", .registration = "scale = 3"},
         {}},
        {"everything a metre away",
         {.held_pose = "position = [1000, 0, 30]",
          .still_pose = "position = [1000, 0, 0]",
          .task = place("[1020, 0, 40]"),
          .registration = "position = [1000, 0, 0]"},
         {}},
        {"inches",
         {.unit = "in",
          .held = R"(shape = { kind = "sphere", diameter = 1 })",
          .held_pose = "position = [0, 0, 1]",
          .still = R"(shape = { kind = "box", width = 2, depth = 2, height = 0.5 })",
          .task = place("[1, 0, 1]")},
         {}},
        {"micrometres",
         {.unit = "um",
          .held = R"(shape = { kind = "sphere", diameter = 10000 })",
          .held_pose = "position = [0, 0, 20000]",
          .still = R"(shape = { kind = "box", width = 40000, depth = 40000, height = 20000 })",
          .task = place("[20000, 0, 30000]")},
         {}},
        {"metres",
         {.unit = "m",
          .held = R"(shape = { kind = "sphere", diameter = 0.02 })",
          .held_pose = "position = [0, 0, 0.05]",
          .still = R"(shape = { kind = "torus", diameter = 0.04, tube_diameter = 0.01 })",
          .task = place("[0, 0, 0.03]")},
         {}},
        {"a needle of 2.5 mm",
         {.held = R"(shape = { kind = "cylinder", diameter = 0.4, length = 2.5 })",
          .held_pose = "position = [0, 0, 20]",
          .still = R"(shape = { kind = "box", width = 3, depth = 3, height = 3 })",
          .task = place("[0, 3, 10]", "leave_radius_mm = 1\n")},
         {}},
        {"plate and peg tilted alike",
         {.held = kPeg,
          .held_pose = "position = [0, -20, 35], rotation_deg = [30, 0, 0]",
          .still_pose = "position = [0, 0, 0], rotation_deg = [30, 0, 0]",
          .task = kInsert},
         {}},
        {"tilted alike on a handle that cannot turn",
         {.held = kPeg,
          .held_pose = "position = [0, -10, 25], rotation_deg = [0, 20, 0]",
          .still_pose = "position = [0, 0, 0], rotation_deg = [0, 20, 0]",
          .device = "falcon",
          .task = kInsert + "leave_radius_mm = 5\n"},
         {}},
        {"goal that rests on the plate", {.task = place("[20, 20, 10]")}, {}},
        {"goal a little too low", {.task = place("[20, 20, 8]", "position_tolerance_mm = 4\n")}, {}},
        {"goal beside the start in a closed box",
         {.held = kBall,
          .held_pose = "position = [0, 0, 0]",
          .still = kHollow,
          .task = place("[10, 5, 0]", "leave_radius_mm = 5\n")},
         {}},
        {"goal down a blind bore", {.held = kBall, .task = place("[0, 0, -15]")}, {}},
        {"ball down a bore with little to spare",
         {.held = R"(shape = { kind = "sphere", diameter = 20.9 })", .task = line("[[0, 0, 5], [0, 0, -12]]")},
         {}},
        {"ball through a passage",
         {.held = kBall, .still = kThroughPlate, .task = kThrough + "passage_length_mm = 20\npassage_width_mm = 8\n"},
         {}},
        {"ball that starts beside its passage, below the mouth",
         {.held = kBall,
          .held_pose = "position = [40, 0, -10]",
          .still = kThroughPlate,
          .task = kThrough + "passage_length_mm = 20\npassage_width_mm = 8\n"},
         {}},
        {"line down the side of the plate", {.held = ball, .task = line("[[30, 0, 0], [30, 0, -30]]")}, {}},
        {"line of a ball's centre above the plate", {.held = ball, .task = line("[[12, 0, 5], [25, 10, 5]]")}, {}},
        {"line without room at many corners alone",
         {.held = R"(shape = { kind = "sphere", diameter = 20 })",
          .task = line(bentLine(12, 8.5, 6.5), "reach_mm = 1\n")},
         {}},
        {"line at a surface that gives way",
         {.held = R"(shape = { kind = "sphere", diameter = 12 })",
          .task = line("[[12, -20, 0], [12, 20, 0]]", "reach_mm = 5\nforce_N = 2\n"),
          .contact = "method = \"penalty\"\nstiffness_N_per_m = 1000"},
         {}},
        {"line at a surface that is not felt",
         {.held = R"(shape = { kind = "sphere", diameter = 12 })",
          .task = line("[[12, -20, 0], [12, 20, 0]]", "reach_mm = 5\n"),
          .more = "[feedback]\nkinesthetic = false\n"},
         {}},
        {"goal in a closed box that gives way",
         {.held = kBall,
          .held_pose = "position = [0, 0, 50]",
          .still = kHollow,
          .task = place("[0, 0, 0]"),
          .contact = "method = \"penalty\"\ncoupling = \"quasi_static\""},
         {}},
        {"a pair whose proxies part", seen(R"("contact.method" = "penalty")"), {}},
        {"a pair that is drawn elsewhere", seen(R"("part.still.shown_offset" = [5, 0, 0])"), {}},
        {"pin with what follows from it", {.still = kPin}, {}},
        {"fin with what follows from it", {.still = kFin}, {}},
        {"sheet with what follows from it", {.still = R"(shape = { kind = "sheet", width = 60, depth = 60 })"}, {}},
        {"thin plate felt by its own faces",
         {.still = R"(shape = { kind = "box", width = 60, depth = 60, height = 0.1 })",
          .contact = "cell_mm = 0.5\ntwo_way = false"},
         {}},
        {"thin plate with what follows from it",
         {.still = R"(shape = { kind = "box", width = 60, depth = 60, height = 0.4 })"},
         {}},
        {"fin with fine cells", {.still = kFin, .contact = "cell_mm = 0.2"}, {}},
        {"a pair of shapes that is seen",
         [] {
             Study study = same();
             study.task.replace(study.task.find("\"contact"), 33, "\"part.still.shape.bore_diameter\" = 24");
             study.more = "[feedback]\nkinesthetic = false\n";
             return study;
         }(),
         {}},
        {"as exact as a handle that does not turn",
         {.device = "falcon", .task = place("[0, 5, 30]", "angle_tolerance_deg = 0.001\nleave_radius_mm = 2\n")},
         {}},
        {"a staircase down to where nobody can",
         {.held = kPeg,
          .task = kInsert + "hold_s = 0.05\n",
          .more = "[[staircase]]\nname = \"time\"\nblock = \"main\"\nkey = \"task.timeout_s\"\nlevels = [0.1, 1, 10]\n"
                  "rule = \"1_up_1_down\"\nstep_down = 5\nmax_trials = 6\ntracks = [{ name = \"a\", start = 10 }]\n"
                  "measure = \"success\"\nabove = 0.5\n"},
         {}},
        {"comparisons above the reference", pair("[900, 1000, 1100]", "above"), {}},
        {"comparisons below, fewer correct", pair("[200, 400, 600]", "below"), {}},
        {"capital letters in the consent",
         {.more = consent("My CT-data of 2027-03-31, AB.CD, A-B-C and DLR/TUM/UPM.")},
         {}},
        {"a slot that takes a quarter turn",
         {.held = R"(shape = { kind = "box", width = 18, depth = 8, height = 8 })",
          .still =
              R"(shape = { kind = "square_bore_plate", width = 60, depth = 60, height = 20, pocket_width = 10, pocket_depth = 20, bore_depth = "through" })",
          .task = kThrough + "passage_length_mm = 20\npassage_width_mm = 4\n"},
         {}},
        {"a bar that goes through on end",
         {.held = R"(shape = { kind = "box", width = 40, depth = 8, height = 8 })",
          .held_pose = "position = [0, 0, 40]",
          .still =
              R"(shape = { kind = "square_bore_plate", width = 60, depth = 60, height = 20, pocket_width = 10, pocket_depth = 20, bore_depth = "through" })",
          .task = kThrough + "passage_length_mm = 20\npassage_width_mm = 4\n"},
         {}},
        {"a round peg that starts turned, held beside its axis",
         {.held = kPeg,
          .held_pose = "position = [0, 0, 30], rotation_deg = [0, 0, 180]",
          .task = kInsert,
          .registration = "position = [50, 0, 20]\nhandle_position = [50, 0, 0]"},
         {}},
        {"handle beside a turned part",
         {.held_pose = "position = [0, 0, 50], rotation_deg = [0, 0, 90]",
          .task = place("[0, 10, 50]", "rotation_deg = [0, 0, 90]\n"),
          .registration = "handle_position = [0, 0, -20]\nrotation_deg = [0, 0, 45]"},
         {}},
        {"a pin that surfaces feel", {.still = kPin, .contact = "spacing_mm = 1\ntwo_way = false"}, {}},
        {"a fin that surfaces feel", {.still = kFin, .contact = "cell_mm = 0.5"}, {}},
        {"a sheet that surfaces feel",
         {.still = R"(shape = { kind = "sheet", width = 60, depth = 60 })", .contact = "two_way = false"},
         {}},
        {"a beam of 1.9 m on a large device",
         {.unit = "m",
          .held = R"(shape = { kind = "box", width = 1.9, depth = 0.1, height = 0.1 })",
          .held_pose = "position = [0, 0, 0.3]",
          .still = R"(shape = { kind = "box", width = 2, depth = 2, height = 0.2 })",
          .device = "hug",
          .task = place("[0.2, 0, 0.3]")},
         {}},
    };
}

void writeMeshes(const Folder& folder) {
    folder.write("pin.off", shape::Cylinder{1, 10}, 10);
    folder.write("fin.off", shape::Box{12, 0.5, 10}, 10);
    folder.write("post.off", shape::Box{20, 20, 20}, 20);
    folder.writeHollow("hollow.off");
}

TEST(Doable, WhatNobodyCouldDoIsNamedWithItsPlace) {
    // Truth: closed form: in each study one thing is impossible by its own numbers, which its row tells.
    const Folder folder;
    writeMeshes(folder);
    const auto rows = undoable();
    EXPECT_GE(rows.size(), 40u);
    for (const Row& row : rows) {
        const auto lines = told(row.study, folder);
        const bool named = std::any_of(lines.begin(), lines.end(), [&](const std::string& line) {
            return std::all_of(row.says.begin(), row.says.end(),
                               [&](const std::string& part) { return line.find(part) != std::string::npos; });
        });
        std::string all;
        for (const std::string& line : lines) all += "\n  " + line;
        EXPECT_TRUE(named) << row.name << ": says" << all;
    }
}

TEST(Doable, NavigationLeadsBeyondTheWorkspaceButForTheStart) {
    // Truth: closed form: a goal 40 cm off on a device of 4 cm is refused, and reached with a clutch, a drift or a
    // scale that is larger; a start out of reach stays one.
    const Folder folder;
    const Study far{.device = "falcon", .task = place("[0, 400, 30]")};
    EXPECT_FALSE(told(far, folder).empty());
    for (const char* effect :
         {"clutch]\nbutton = 1", "drift]\nshare = 0.1", "position_scale]\nbutton = 1\nscale = 12"}) {
        Study led = far;
        led.gate = std::string("\n[scene.effects.") + effect;
        for (const std::string& line : told(led, folder))
            EXPECT_EQ(line.find("task.position"), std::string::npos) << line;
        led.held_pose = "position = [0, 0, 90]";
        const auto lines = told(led, folder);
        EXPECT_TRUE(std::any_of(lines.begin(), lines.end(), [](const std::string& line) {
            return line.find("scene.part.held.pose") != std::string::npos;
        })) << effect;
    }
    Study slower = far;
    slower.gate = "\n[scene.effects.position_scale]\nbutton = 1\nscale = 0.1";
    EXPECT_FALSE(told(slower, folder).empty()) << "a smaller scale leads nowhere";
    Study none = far;
    none.gate = "\n[scene.effects.clutch]\nbutton = 5";
    const auto lines = told(none, folder);
    ASSERT_FALSE(lines.empty());
    EXPECT_NE(lines.front().find("scene.effects.clutch.button: 5: falcon has 4 buttons"), std::string::npos)
        << lines[0];
}

TEST(Doable, WhatIsOnlyOddIsNotRefused) {
    // Truth: closed form: each study is possible by its own numbers, near a limit or in an unusual way.
    const Folder folder;
    writeMeshes(folder);
    const auto rows = odd();
    EXPECT_GE(rows.size(), 20u);
    for (const Row& row : rows) {
        std::string all;
        for (const std::string& line : told(row.study, folder)) all += "\n  " + line;
        EXPECT_EQ(all, "") << row.name;
    }
}

TEST(Doable, WhatHardlyAnybodyDoesIsAWarning) {
    // Truth: closed form: each is within what is possible and beyond what is usual by its number, which the line tells.
    const Folder folder;
    const std::pair<Study, std::string> rows[] = {
        {{.held = kPeg, .task = kInsert + "max_speed_mm_per_s = 0.1\n"}, "task.max_speed_mm_per_s = 0.1"},
        {{.task = place("[20, 0, 40]", "angle_tolerance_deg = 0.2\n")}, "task.angle_tolerance_deg = 0.2"},
        {changed(pair("[900, 1000, 1100]", "above"), "interval_s = 0.2\n"), "task.interval_s = 0.2"},
        {{.more = "rest_s = 86400\n"}, "block.rest_s = 86400 keeps a person waiting"}};
    for (const auto& [study, sentence] : rows) {
        const auto lines = told(study, folder);
        ASSERT_EQ(lines.size(), 1u) << sentence << ": says " << testing::PrintToString(lines);
        EXPECT_NE(lines[0].find(sentence), std::string::npos) << lines[0];
        EXPECT_EQ(lines[0].find("error"), std::string::npos) << lines[0];
    }
}

TEST(Doable, ThePlaceIsThatOfTheValue) {
    // Truth: closed form: the goal's list stands in the line "position = ..." of the task.
    const Folder folder;
    Study study;
    study.task = place("[0, 0, 500]");
    const std::string text = study.text();
    const auto at = text.find("position = [0, 0, 500]");
    const auto lines = told(study, folder);
    ASSERT_EQ(lines.size(), 1u) << lines[0] << "\n" << lines.back();
    const auto number = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
    EXPECT_NE(lines[0].find("s.toml:" + std::to_string(number) + ":12: error"), std::string::npos) << lines[0];
}

TEST(Doable, DefaultsFollowThePartsSize) {
    // Truth: closed form: a fiftieth and 1/2500 of the held part's longest side, rounded to 1, 2, 5; 1 mm and 20 um at
    // 50 mm. A part a thousand times as large has a thousand times as much.
    const auto contactOf = [](const std::string& unit, double size) {
        const Folder folder;
        Study study;
        study.unit = unit;
        const auto box = [&](double x) {
            return "shape = { kind = \"box\", width = " + std::to_string(x * size) +
                   ", depth = " + std::to_string(0.4 * size) + ", height = " + std::to_string(0.4 * size) + " }";
        };
        study.held = study.still = box(1.0);
        study.held_pose = "position = [0, 0, " + std::to_string(size) + "]";
        study.task = place("[0, 0, " + std::to_string(1.2 * size) + "]");
        study.device = "hug";
        const std::string path = folder.file("s.toml");
        std::ofstream(path) << study.text();
        const Examined examined = examineProtocol(path, knownDevices(), knownMeasures());
        return examined.plan.conditions.at(0).scene.contact;
    };
    for (const auto& [unit, size, spacing, tolerance] : {std::tuple("mm", 3.0, 5e-5, 1e-6),
                                                         {"mm", 50.0, 1e-3, 2e-5},
                                                         {"cm", 5.0, 1e-3, 2e-5},
                                                         {"m", 3.0, 5e-2, 1e-3}}) {
        const auto contact = contactOf(unit, size);
        EXPECT_NEAR(contact.spacing, spacing, 1e-12) << size << unit;
        EXPECT_NEAR(contact.tolerance, tolerance, 1e-15) << size << unit;
        EXPECT_FALSE(contact.two_way) << "a block has no thin feature";
    }
}

TEST(Doable, BothWaysIsTheDefaultOnlyWhereOneWayWouldMiss) {
    // Truth: closed form: a pin of 1 mm is thinner than a gap of 0.9 mm to all sides; a post of 20 mm is not. Explicit
    // settings stay.
    const Folder folder;
    writeMeshes(folder);
    const auto twoWay = [&](const std::string& still, const std::string& contact) {
        Study study;
        study.held = R"(shape = { kind = "box", width = 40, depth = 20, height = 20 })";
        study.still = still;
        study.contact = contact;
        const std::string path = folder.file("s.toml");
        std::ofstream(path) << study.text();
        return examineProtocol(path, knownDevices(), knownMeasures()).plan.conditions.at(0).scene.contact.two_way;
    };
    const std::string field = "geometry = \"field\"\n";
    EXPECT_TRUE(twoWay(kPin, field));
    EXPECT_FALSE(twoWay(kPin, field + "two_way = false"));
    EXPECT_FALSE(twoWay(kPin, field + "spacing_mm = 0.5"));
    EXPECT_FALSE(twoWay("mesh = \"post.off\"", field));
    EXPECT_TRUE(twoWay("mesh = \"post.off\"", field + "two_way = true"));
    EXPECT_FALSE(twoWay(kPin, "")) << "on closed forms, which have no points";
}

TEST(Doable, AGoalWhereAPartStartsThatMayStillBeThereIsAWarning) {
    // Truth: closed form. The block belongs where the lid starts, and the lid is put on the block: so it has to be
    // taken away first, which no step says. As shipped nothing starts at a goal.
    std::ifstream stream(PASSUNG_SOURCE_DIR "/protocols/ASSEMBLY.md");
    const std::string page(std::istreambuf_iterator<char>(stream), {}), fence = "```toml\n";
    const std::size_t begin = page.find(fence) + fence.size();
    std::string text = page.substr(begin, page.find("```", begin) - begin);
    const auto warned = [](const std::string& study) {
        const auto plan = readProtocolText(study, "study.toml", knownDevices(), knownMeasures());
        if (!plan) ADD_FAILURE() << toString(plan.errors().front());
        return !plan ? 0
                     : std::ranges::count(plan->warnings,
                                          "the goal of step block is where part lid starts, which must be taken away "
                                          "first; after does not say so");
    };
    EXPECT_EQ(warned(text), 0);
    const std::string goal = "position = [-25, 15, 5.5]";
    text.replace(text.find(goal), goal.size(), "position = [-60, -30, 10]");
    EXPECT_EQ(warned(text), 1);
}

}  // namespace
}  // namespace passung::protocol
