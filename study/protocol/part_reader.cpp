#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <numbers>
#include <utility>

#include "core/shape/iso_fit.h"
#include "study/protocol/scene_node.h"

namespace passung::protocol {
namespace {

constexpr double kMaxLength = 10.0;  // [m], of positions and edges: more is a slip in the unit
constexpr double kMinLength = 1e-6;  // [m], of edges: less is none that a hand could feel

const shape::Shape kHarmless = shape::Sphere{1.0};  // stands in after an error

/// What a kind's fit decides: the key of its diameter, and whether that is a hole's. Kinds without one take no fit.
struct FittedKind {
    std::string_view kind, key;
    bool hole;
};
constexpr std::array kFittedKinds{
    FittedKind{"peg", "diameter", false},
    FittedKind{"keyed_peg", "diameter", false},
    FittedKind{"bore_plate", "bore_diameter", true},
    FittedKind{"keyed_bore_plate", "bore_diameter", true},
};

const FittedKind* fittedKind(std::string_view kind) {
    const auto found = std::find_if(kFittedKinds.begin(), kFittedKinds.end(),
                                    [&](const FittedKind& fitted) { return fitted.kind == kind; });
    return found != kFittedKinds.end() ? &*found : nullptr;
}

/// The diameter [m] that the fit gives; reports what keeps it from that.
double readFit(const TableReader& read, const FittedKind& fitted, double units, Errors& errors) {
    const std::size_t before = errors.size();
    const auto fit = shape::parseFit(read.text("fit"));
    if (!fit) read.fail("fit", fit.errors()[0].message);
    if (read.has(fitted.key)) read.fail("fit", fmt::format("gives the {}, which stands here too", fitted.key));
    if (!read.has("nominal_diameter")) read.fail("nominal_diameter", "required by the fit");
    if (errors.size() > before) return 0.0;
    const double nominal = read.number("nominal_diameter") / units;
    const auto word = read.text("deviation");
    const auto clearance = word == "min"   ? shape::Clearance::Min
                           : word == "max" ? shape::Clearance::Max
                                           : shape::Clearance::Mean;
    const auto diameter =
        fitted.hole ? shape::holeDiameter(*fit, nominal, clearance) : shape::shaftDiameter(*fit, nominal, clearance);
    if (!diameter) read.fail(diameter.errors()[0].key, diameter.errors()[0].message);
    return diameter ? *diameter : 0.0;
}

/// The diameter [m] of a kind that may have a fit; 0 if it may not, and after an error.
double readDiameter(const TableReader& read, const std::string& kind, double units, Errors& errors) {
    const FittedKind* fitted = fittedKind(kind);
    if (fitted == nullptr) return 0.0;
    if (read.has("fit")) return readFit(read, *fitted, units, errors);
    for (const char* key : {"nominal_diameter", "deviation"})
        if (read.has(key)) read.fail(key, "needs a fit");
    if (!read.has(fitted->key)) read.fail(fitted->key, "required");
    return read.number(fitted->key) / units;
}

/// `fitted`: see readDiameter.
shape::Shape buildShape(const TableReader& read, const std::string& kind, double units, double fitted) {
    const auto length = [&](const char* name) { return read.number(name) / units; };
    if (kind == "sphere") return shape::Sphere{length("diameter")};
    if (kind == "box") return shape::Box{length("width"), length("depth"), length("height")};
    if (kind == "cylinder") return shape::Cylinder{length("diameter"), length("length")};
    if (kind == "torus") return shape::Torus{length("diameter"), length("tube_diameter")};
    if (kind == "sheet") return shape::Sheet{length("width"), length("depth")};
    const double chamfer = length("chamfer");
    if (kind == "peg") return shape::Peg{fitted, length("length"), chamfer};
    if (kind == "square_peg") return shape::SquarePeg{length("width"), length("depth"), length("length"), chamfer};
    if (kind == "keyed_peg")
        return shape::KeyedPeg{fitted, length("length"), length("key_width"), length("key_height"), chamfer};
    const auto flankHeight = [&] { return read.has("flank_height") ? length("flank_height") : 0.0; };
    if (kind == "thread_bolt")
        return shape::ThreadBolt{
            length("nominal_diameter"),     length("pitch"), length("length"), chamfer, length("clearance"),
            read.number("flank_angle_deg"), flankHeight()};
    if (kind == "thread_nut")
        return shape::ThreadNut{length("nominal_diameter"),
                                length("pitch"),
                                length("outer_diameter"),
                                length("height"),
                                chamfer,
                                length("clearance"),
                                read.number("flank_angle_deg"),
                                flankHeight()};
    const double width = length("width"), depth = length("depth"), height = length("height");
    const double bore_depth = read.text("bore_depth") == "through" ? height : length("bore_depth");
    if (kind == "square_bore_plate")
        return shape::SquareBorePlate{width,      depth,  height, length("pocket_width"), length("pocket_depth"),
                                      bore_depth, chamfer};
    if (kind == "bore_plate") return shape::BorePlate{width, depth, height, fitted, bore_depth, chamfer};
    return shape::KeyedBorePlate{width,      depth,  height, fitted, length("key_width"), length("key_height"),
                                 bore_depth, chamfer};
}

shape::Shape readShape(const Node& table, const std::string& path, double units, Errors& errors) {
    const std::size_t before = errors.size();
    // The kind first: without it no other key can be judged.
    Node kind_only = emptyTable(table.place);
    std::copy_if(table.entries.begin(), table.entries.end(), std::back_inserter(kind_only.entries),
                 [](const Entry& entry) { return entry.key == "kind"; });
    const auto kind = TableReader(kind_only, {"shape"}, path, errors).text("kind");
    if (errors.size() > before) return kHarmless;

    const std::string id = "shape." + kind;
    std::vector<std::string_view> ids{"shape", id};
    if (fittedKind(kind) != nullptr) ids.emplace_back("shape.fit");
    const TableReader read(table, std::move(ids), path, errors);
    if (errors.size() > before) return kHarmless;
    for (const Key& key : keys())
        if (key.table == id && read.has(key.name) && read.node(key.name)->number / units > kMaxLength)
            read.fail(key.name, fmt::format("must be at most {} m", kMaxLength));
    for (const Key& key : keys())
        if (key.table == id && key.name != "chamfer" && read.has(key.name) &&
            read.node(key.name)->kind != Node::Kind::Text && read.node(key.name)->number / units < kMinLength)
            read.fail(key.name, fmt::format("must be at least {} m", kMinLength));
    const double fitted = readDiameter(read, kind, units, errors);
    if (errors.size() > before) return kHarmless;
    const auto shape = buildShape(read, kind, units, fitted);
    for (const Error& error : shape::validate(shape)) read.fail(error.key, error.message);
    return errors.size() > before ? kHarmless : shape;
}

scene::MeshFile readMesh(const TableReader& read, const Node& value, double units) {
    const auto folder = std::filesystem::path(value.place.file).parent_path();
    const auto path = folder / value.text;
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored)) read.fail("mesh", "there is no such file");
    return {path.lexically_normal().string(), 1.0 / units};
}

/// Number of the hand that holds the part.
std::size_t readHand(const TableReader& read, bool held, std::span<const std::string> other_hands) {
    if (!held) read.fail("hand", "needs held = true");
    auto found = std::find(other_hands.begin(), other_hands.end(), read.text("hand"));
    if (found == other_hands.end()) found = std::find(other_hands.begin(), other_hands.end(), "");  // told already
    if (found != other_hands.end()) return static_cast<std::size_t>(found - other_hands.begin()) + 1;
    read.fail("hand", other_hands.empty()
                          ? std::string("the scene has no [[hand]]")
                          : fmt::format("no [[hand]] has this name; there are: {}", fmt::join(other_hands, ", ")));
    return 0;
}

}  // namespace

double unitsPerMetre(const TableReader& read, double absent) {
    const auto name = read.text("unit");
    for (const LengthUnit& unit : kLengthUnits)
        if (name == unit.name) return unit.per_metre;
    return absent;
}

Vec3 readPosition(const TableReader& read, std::string_view key, double units_per_metre) {
    const Vec3 position = read.vector(key) / units_per_metre;
    if (position.cwiseAbs().maxCoeff() > kMaxLength)
        read.fail(key, fmt::format("must be within {} m along every axis", kMaxLength));
    return position;
}

Pose readPose(const TableReader& read, std::string_view position_key, std::string_view rotation_key,
              double units_per_metre) {
    const Vec3 angles = read.vector(rotation_key) * (std::numbers::pi / 180.0);
    Pose pose;
    pose.p = readPosition(read, position_key, units_per_metre);
    pose.q = Eigen::AngleAxisd(angles.z(), Vec3::UnitZ()) * Eigen::AngleAxisd(angles.y(), Vec3::UnitY()) *
             Eigen::AngleAxisd(angles.x(), Vec3::UnitX());
    return pose;
}

scene::PartSpec readPartNode(const Node& table, const std::string& parent_path, double units_per_metre,
                             std::span<const std::string> other_hands, Errors& errors) {
    const Node* name = table.find("name");
    std::string path = parent_path;
    path += parent_path.empty() ? "part" : ".part";
    if (name != nullptr && name->kind == Node::Kind::Text && isName(name->text)) path += '.' + name->text;

    const TableReader read(table, {"part"}, path, errors);
    scene::PartSpec part;
    part.name = read.text("name");
    part.held = read.boolean("held");
    part.pickable = read.boolean("pickable");
    if (read.has("hand")) part.hand = readHand(read, part.held, other_hands);
    const double units = unitsPerMetre(read, units_per_metre);
    part.shown_offset = readPosition(read, "shown_offset", units);
    part.friction = read.number("friction");
    part.sliding_friction = read.numberOr("sliding_friction", part.friction);
    part.density = read.number("density_kg_per_m3");
    if (part.sliding_friction > part.friction) read.fail("sliding_friction", "must not exceed `friction`");
    if (part.held && !part.shown_offset.isZero(0.0))
        read.fail("shown_offset", "the held part cannot be drawn elsewhere: it would move the hand's aim");
    if (const Node* pose = read.node("pose"))
        part.X_WP =
            readPose(TableReader(*pose, {"pose"}, read.pathOf("pose"), errors), "position", "rotation_deg", units);

    const Node* shape = read.node("shape");
    const Node* mesh = read.node("mesh");
    if (table.find("shape") != nullptr && table.find("mesh") != nullptr)
        read.fail("shape", "a part has either a shape or a mesh");
    else if (shape != nullptr)
        part.geometry = readShape(*shape, read.pathOf("shape"), units, errors);
    else if (mesh != nullptr)
        part.geometry = readMesh(read, *mesh, units);
    else if (table.find("shape") == nullptr && table.find("mesh") == nullptr)
        errors.push_back(errorAt(table.place, path, "", "needs a shape or a mesh"));
    return part;
}

}  // namespace passung::protocol
