#include "tests/bench/true_poses.h"

#include <fmt/format.h>

#include <array>
#include <fstream>
#include <sstream>

namespace passung::bench {

namespace {

constexpr std::size_t kNumbers = 22;
constexpr const char* kColumns =
    "kind,x_m,y_m,z_m,qw,qx,qy,qz,shell_in_field_m,field_in_shell_m,uncertainty_m,"
    "force_x_N,force_y_N,force_z_N,torque_x_Nm,torque_y_Nm,torque_z_Nm,"
    "two_way_force_x_N,two_way_force_y_N,two_way_force_z_N,"
    "two_way_torque_x_Nm,two_way_torque_y_Nm,two_way_torque_z_Nm";

std::string firstLine(const ContactScene& scene) {
    return fmt::format("# bunny {:016x}, tool {:016x}; made by passung-bench --make-poses", contentHash(scene.bunny),
                       contentHash(scene.tool));
}

std::string line(const char* kind, const TruePose& t) {
    const Pose& X = t.X_FS;
    std::string text =
        fmt::format("{},{},{},{},{},{},{},{}", kind, X.p.x(), X.p.y(), X.p.z(), X.q.w(), X.q.x(), X.q.y(), X.q.z());
    for (const double value : {t.shell_in_field, t.field_in_shell, t.uncertainty})
        text += fmt::format(",{:.9g}", value);
    for (const Wrench& w : {t.one_way, t.two_way})
        for (const Vec3& v : {w.force, w.torque}) text += fmt::format(",{:.9g},{:.9g},{:.9g}", v.x(), v.y(), v.z());
    return text + "\n";
}

Vec3 vectorAt(const std::array<double, kNumbers>& n, std::size_t i) { return {n[i], n[i + 1], n[i + 2]}; }

/// Of the numbers after the kind; false if there are not enough.
bool parse(std::istringstream& rest, TruePose& pose) {
    std::array<double, kNumbers> n{};
    for (double& value : n) {
        std::string cell;
        if (!std::getline(rest, cell, ',')) return false;
        std::istringstream number(cell);
        if (!(number >> value)) return false;
    }
    pose = {.X_FS = {Quat(n[3], n[4], n[5], n[6]), vectorAt(n, 0)},
            .shell_in_field = n[7],
            .field_in_shell = n[8],
            .uncertainty = n[9],
            .one_way = {vectorAt(n, 10), vectorAt(n, 13)},
            .two_way = {vectorAt(n, 16), vectorAt(n, 19)}};
    return true;
}

}  // namespace

Result<Done> writeTruePoses(const ContactScene& scene, const std::string& file) {
    std::ofstream out(file);
    out << firstLine(scene) << '\n' << kColumns << '\n';
    for (const TruePose& pose : scene.pressed) out << line("pressed", pose);
    for (const TruePose& pose : scene.apart) out << line("apart", pose);
    if (!out.flush()) return Error{.message = "cannot be written", .file = file};
    return Done{};
}

Result<ContactScene> readTruePoses(geometry::TriangleMesh bunny, const std::string& file, std::size_t count) {
    ContactScene scene{.bunny = std::move(bunny), .tool = torusTool(), .pressed = {}, .apart = {}};
    std::ifstream in(file);
    std::string text;
    if (!std::getline(in, text)) return Error{.message = "cannot be read", .file = file};
    if (text != firstLine(scene))
        return Error{.message = "the poses were made for other meshes: " + firstLine(scene), .file = file, .line = 1};
    std::getline(in, text);
    for (int number = 3; std::getline(in, text); ++number) {
        std::istringstream rest(text);
        std::string kind;
        std::getline(rest, kind, ',');
        TruePose pose;
        if ((kind != "pressed" && kind != "apart") || !parse(rest, pose))
            return Error{.message = "not a pose with its truth", .file = file, .line = number};
        std::vector<TruePose>& list = kind == "pressed" ? scene.pressed : scene.apart;
        if (list.size() < count) list.push_back(pose);
    }
    if (scene.pressed.empty() || scene.apart.empty()) return Error{.message = "holds no poses", .file = file};
    return scene;
}

}  // namespace passung::bench
