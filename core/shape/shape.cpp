#include "core/shape/shape.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>
#include <utility>

#include "core/shape/thread.h"

namespace passung::shape {

namespace {

/// Nothing that a hand touches is larger; squares of such lengths stay far from overflow.
constexpr double kLongest = 1000.0;                              // [m]
constexpr double kSteepestFlanks = 2.0 * kIsoFlankAngle / 60.0;  // [rad]

template <class... Ts>
struct Overloaded : Ts... {
    using Ts::operator()...;
};
template <class... Ts>
Overloaded(Ts...) -> Overloaded<Ts...>;

/// Collects what is wrong with the values of one shape.
class Check {
public:
    explicit Check(const char* kind) : kind_(kind) {}

    void length(const char* key, double value) {
        if (!(value > 0.0 && value <= kLongest)) add(key, value, "must be a length above 0 m, at most 1000 m");
    }
    void flankAngle(const char* key, double value) {
        if (!(value >= kSteepestFlanks * (1.0 - 1e-9) && value <= kIsoFlankAngle * (1.0 + 1e-9)))
            add(key, value, "must be 2 to 60 degrees", " rad");
    }
    void lengthOrNone(const char* key, double value) {
        if (!(value >= 0.0 && value <= kLongest)) add(key, value, "must be a length, 0 m or more (0 = none)");
    }
    /// True if it is, by more than rounding: of what is between the two something must be left.
    bool less(const char* key, double value, double limit, const std::string& requirement) {
        const bool fits = value < limit * (1.0 - 1e-9);
        if (!fits) add(key, value, requirement);
        return fits;
    }
    void add(const char* key, double value, const std::string& requirement, const char* unit = " m") {
        std::array<char, 32> text{};
        const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
        Error error;
        error.message = std::string(kind_) + ": " + requirement;
        error.key = key;
        error.value = std::string(text.data(), end) + unit;
        errors_.push_back(error);
    }
    bool empty() const { return errors_.empty(); }
    std::vector<Error> take() { return std::move(errors_); }

private:
    const char* kind_;
    std::vector<Error> errors_;
};

using Dimensions = std::vector<Dimension>;

constexpr const char *kFlankAngle = "flank_angle_deg", *kFlankHeight = "flank_height";

Dimensions dimensionsOf(const Sphere& s) { return {{"diameter", s.diameter}}; }
Dimensions dimensionsOf(const Box& b) { return {{"width", b.width}, {"depth", b.depth}, {"height", b.height}}; }
Dimensions dimensionsOf(const Cylinder& c) { return {{"diameter", c.diameter}, {"length", c.length}}; }
Dimensions dimensionsOf(const Torus& t) { return {{"diameter", t.diameter}, {"tube_diameter", t.tube_diameter}}; }
Dimensions dimensionsOf(const Sheet& s) { return {{"width", s.width}, {"depth", s.depth}}; }
Dimensions dimensionsOf(const Peg& p) {
    return {{"diameter", p.diameter}, {"length", p.length}, {"chamfer", p.chamfer}};
}
Dimensions dimensionsOf(const SquarePeg& p) {
    return {{"width", p.width}, {"depth", p.depth}, {"length", p.length}, {"chamfer", p.chamfer}};
}
Dimensions dimensionsOf(const KeyedPeg& p) {
    return {{"diameter", p.diameter},
            {"length", p.length},
            {"key_width", p.key_width},
            {"key_height", p.key_height},
            {"chamfer", p.chamfer}};
}
Dimensions dimensionsOf(const BorePlate& p) {
    return {{"width", p.width},           {"depth", p.depth},
            {"height", p.height},         {"bore_diameter", p.bore_diameter},
            {"bore_depth", p.bore_depth}, {"chamfer", p.chamfer}};
}
Dimensions dimensionsOf(const SquareBorePlate& p) {
    return {{"width", p.width},
            {"depth", p.depth},
            {"height", p.height},
            {"pocket_width", p.pocket_width},
            {"pocket_depth", p.pocket_depth},
            {"bore_depth", p.bore_depth},
            {"chamfer", p.chamfer}};
}
Dimensions dimensionsOf(const KeyedBorePlate& p) {
    return {{"width", p.width},           {"depth", p.depth},
            {"height", p.height},         {"bore_diameter", p.bore_diameter},
            {"key_width", p.key_width},   {"key_height", p.key_height},
            {"bore_depth", p.bore_depth}, {"chamfer", p.chamfer}};
}
Dimensions dimensionsOf(const ThreadBolt& b) {
    return {{"nominal_diameter", b.nominal_diameter},
            {"pitch", b.pitch},
            {"length", b.length},
            {"chamfer", b.chamfer},
            {"clearance", b.clearance},
            {kFlankAngle, b.flank_angle},
            {kFlankHeight, b.flank_height}};
}
Dimensions dimensionsOf(const ThreadNut& n) {
    return {{"nominal_diameter", n.nominal_diameter},
            {"pitch", n.pitch},
            {"outer_diameter", n.outer_diameter},
            {"height", n.height},
            {"chamfer", n.chamfer},
            {"clearance", n.clearance},
            {kFlankAngle, n.flank_angle},
            {kFlankHeight, n.flank_height}};
}

constexpr double kMostFlankHeight = 0.75;                     // of the pitch
constexpr double kMostBetweenEdges = 5e-6;                    // [m]
constexpr double kMostTurns = 100.0, kMostTurnsOfNut = 12.0;  // all of a nut's turns touch at once

constexpr double kMostClearance = 0.25;  // of a pitch: more lets flanks pass each other
constexpr const char* kLittleClearance = "must be less than a quarter of the pitch";

constexpr const char* kMouthInside = "the widened mouth must lie inside the plate's top face";

/// Rules between several dimensions, each of which is a length.
template <class AnyShape>
void checkTogether(const AnyShape&, Check&) {}

void checkTogether(const Torus& t, Check& check) {
    check.less("tube_diameter", t.tube_diameter, t.diameter, "must be less than the diameter");
}

void checkTogether(const Peg& p, Check& check) {
    check.less("chamfer", p.chamfer, std::min(0.5 * p.diameter, p.length),
               "must be less than half the diameter and less than the length");
}

void checkTogether(const SquarePeg& p, Check& check) {
    check.less("chamfer", p.chamfer, std::min({0.5 * p.width, 0.5 * p.depth, p.length}),
               "must be less than half the width, half the depth and the length");
}

void checkTogether(const KeyedPeg& p, Check& check) {
    check.less("key_width", p.key_width, p.diameter, "must be less than the diameter") &&
        check.less("chamfer", p.chamfer, std::min(0.5 * p.key_width, p.length),
                   "must be less than half the key's width and less than the length");
}

template <class Plate>
bool checkChamferDepth(const Plate& p, Check& check) {
    return check.less("chamfer", p.chamfer, std::min(p.bore_depth, p.height),
                      "must be less than the depth of the bore");
}

void checkTogether(const BorePlate& p, Check& check) {
    const double half = 0.5 * std::min(p.width, p.depth), bore = 0.5 * p.bore_diameter;
    checkChamferDepth(p, check) &&
        check.less("bore_diameter", p.bore_diameter, 2.0 * half, "must be less than the plate's width and depth") &&
        check.less("chamfer", p.chamfer, half - bore, kMouthInside);
}

void checkTogether(const SquareBorePlate& p, Check& check) {
    checkChamferDepth(p, check) &&
        check.less("pocket_width", p.pocket_width, p.width, "must be less than the plate's width") &&
        check.less("pocket_depth", p.pocket_depth, p.depth, "must be less than the plate's depth") &&
        check.less("chamfer", p.chamfer, 0.5 * std::min(p.width - p.pocket_width, p.depth - p.pocket_depth),
                   kMouthInside);
}

void checkTogether(const KeyedBorePlate& p, Check& check) {
    const double bore = 0.5 * p.bore_diameter, beside_key = 0.5 * p.width - bore;
    checkChamferDepth(p, check) &&
        check.less("bore_diameter", p.bore_diameter, std::min(p.width, p.depth),
                   "must be less than the plate's width and depth") &&
        check.less("key_width", p.key_width, p.bore_diameter, "must be less than the diameter of the bore") &&
        check.less("key_height", p.key_height, beside_key, "the keyway must end inside the plate") &&
        check.less("chamfer", p.chamfer, std::min(beside_key - p.key_height, 0.5 * p.depth - bore), kMouthInside);
}

/// Crests that are left, and flanks that touch at their edges.
bool checkProfile(const ThreadForm& form, Check& check) {
    const double height = form.outer - form.inner;
    if (!(height <= kMostFlankHeight * form.pitch && form.crest() > 0.0 && form.root() < 0.5 * form.pitch))
        check.add(kFlankHeight, height, "must be at most 3/4 of the pitch, and leave crests and roots");
    else if (form.mostBetweenEdges() > kMostBetweenEdges)
        check.add(kFlankHeight, height,
                  "must be less: flanks so steep would overlap by more than 5 µm between their edges");
    return check.empty();
}

/// Of a thread that is `length` long.
bool checkThread(double diameter, double pitch, double length, const char* key, double most_turns, Check& check) {
    if (!(pitch <= 0.25 * diameter)) check.add("pitch", pitch, "must be at most a quarter of the diameter");
    if (!(length >= pitch && length <= most_turns * pitch))
        check.add(key, length, "must be 1 to " + std::to_string(static_cast<int>(most_turns)) + " pitches");
    return check.empty();
}

void checkTogether(const ThreadBolt& b, Check& check) {
    checkThread(b.nominal_diameter, b.pitch, b.length, "length", kMostTurns, check) &&
        check.less("clearance", b.clearance, kMostClearance * b.pitch, kLittleClearance) &&
        checkProfile(threadOf(b), check) &&
        check.less("chamfer", b.chamfer, std::min(threadOf(b).outer, b.length),
                   "must be less than half the diameter and less than the length");
}

void checkTogether(const ThreadNut& n, Check& check) {
    checkThread(n.nominal_diameter, n.pitch, n.height, "height", kMostTurnsOfNut, check) &&
        check.less("clearance", n.clearance, kMostClearance * n.pitch, kLittleClearance) &&
        checkProfile(threadOf(n), check) &&
        check.less("nominal_diameter", n.nominal_diameter, n.outer_diameter - 2.0 * n.clearance,
                   "must be less than the outer diameter, by the clearance on both sides") &&
        check.less("chamfer", n.chamfer, std::min(0.5 * n.outer_diameter - threadOf(n).inner, 0.5 * n.height),
                   "the widened mouths must lie inside the nut's faces, each within half its height");
}

}  // namespace

const char* kindName(const Shape& shape) {
    return std::visit(
        Overloaded{[](const Sphere&) { return "sphere"; }, [](const Box&) { return "box"; },
                   [](const Cylinder&) { return "cylinder"; }, [](const Torus&) { return "torus"; },
                   [](const Sheet&) { return "sheet"; }, [](const Peg&) { return "peg"; },
                   [](const SquarePeg&) { return "square_peg"; }, [](const KeyedPeg&) { return "keyed_peg"; },
                   [](const BorePlate&) { return "bore_plate"; },
                   [](const SquareBorePlate&) { return "square_bore_plate"; },
                   [](const KeyedBorePlate&) { return "keyed_bore_plate"; },
                   [](const ThreadBolt&) { return "thread_bolt"; }, [](const ThreadNut&) { return "thread_nut"; }},
        shape);
}

bool isRound(const Shape& shape) {
    return std::visit(Overloaded{[](const Sphere&) { return true; }, [](const Cylinder&) { return true; },
                                 [](const Torus&) { return true; }, [](const Peg&) { return true; },
                                 [](const ThreadBolt&) { return true; }, [](const ThreadNut&) { return true; },
                                 [](const auto&) { return false; }},
                      shape);
}

std::vector<Dimension> namedDimensions(const Shape& shape) {
    return std::visit([](const auto& s) { return dimensionsOf(s); }, shape);
}

std::vector<double> dimensions(const Shape& shape) {
    std::vector<double> values;
    for (const auto& dimension : namedDimensions(shape)) values.push_back(dimension.value);
    return values;
}

std::vector<Error> validate(const Shape& shape) {
    Check check(kindName(shape));
    for (const auto& [key, value] : namedDimensions(shape)) {
        if (const std::string_view name = key; name == "chamfer" || name == "clearance" || name == kFlankHeight)
            check.lengthOrNone(key, value);
        else if (name == kFlankAngle)
            check.flankAngle(key, value);
        else
            check.length(key, value);
    }
    if (check.empty()) std::visit([&](const auto& s) { checkTogether(s, check); }, shape);
    return check.take();
}

}  // namespace passung::shape
