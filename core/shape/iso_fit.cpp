#include "core/shape/iso_fit.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <span>

namespace passung::shape {

namespace {

// The standard's values in µm. They come from formulae in the geometric mean of each step's limits, but rounded by
// rules with exceptions: the rounded values are the standard.

/// Steps of nominal sizes: "above the last, up to and including", mm. The finer ones are for r and s.
constexpr std::array kSteps{3.0, 6.0, 10.0, 18.0, 30.0, 50.0, 80.0, 120.0, 180.0, 250.0, 315.0, 400.0, 500.0};
constexpr std::array kFineSteps{3.0,   6.0,   10.0,  18.0,  30.0,  50.0,  65.0,  80.0,  100.0, 120.0, 140.0,
                                160.0, 180.0, 200.0, 225.0, 250.0, 280.0, 315.0, 355.0, 400.0, 450.0, 500.0};
constexpr double kLargestSize = kSteps.back();  // [mm]

using Row = std::array<double, kSteps.size()>;
using FineRow = std::array<double, kFineSteps.size()>;

// clang-format off
/// Standard tolerances IT01, IT0, IT1 ... IT18.
constexpr std::array<Row, 20> kTolerances{{
    {0.3, 0.4, 0.4, 0.5, 0.6, 0.6, 0.8, 1, 1.2, 2, 2.5, 3, 4},
    {0.5, 0.6, 0.6, 0.8, 1, 1, 1.2, 1.5, 2, 3, 4, 5, 6},
    {0.8, 1, 1, 1.2, 1.5, 1.5, 2, 2.5, 3.5, 4.5, 6, 7, 8},
    {1.2, 1.5, 1.5, 2, 2.5, 2.5, 3, 4, 5, 7, 8, 9, 10},
    {2, 2.5, 2.5, 3, 4, 4, 5, 6, 8, 10, 12, 13, 15},
    {3, 4, 4, 5, 6, 7, 8, 10, 12, 14, 16, 18, 20},
    {4, 5, 6, 8, 9, 11, 13, 15, 18, 20, 23, 25, 27},
    {6, 8, 9, 11, 13, 16, 19, 22, 25, 29, 32, 36, 40},
    {10, 12, 15, 18, 21, 25, 30, 35, 40, 46, 52, 57, 63},
    {14, 18, 22, 27, 33, 39, 46, 54, 63, 72, 81, 89, 97},
    {25, 30, 36, 43, 52, 62, 74, 87, 100, 115, 130, 140, 155},
    {40, 48, 58, 70, 84, 100, 120, 140, 160, 185, 210, 230, 250},
    {60, 75, 90, 110, 130, 160, 190, 220, 250, 290, 320, 360, 400},
    {100, 120, 150, 180, 210, 250, 300, 350, 400, 460, 520, 570, 630},
    {140, 180, 220, 270, 330, 390, 460, 540, 630, 720, 810, 890, 970},
    {250, 300, 360, 430, 520, 620, 740, 870, 1000, 1150, 1300, 1400, 1550},
    {400, 480, 580, 700, 840, 1000, 1200, 1400, 1600, 1850, 2100, 2300, 2500},
    {600, 750, 900, 1100, 1300, 1600, 1900, 2200, 2500, 2900, 3200, 3600, 4000},
    {1000, 1200, 1500, 1800, 2100, 2500, 3000, 3500, 4000, 4600, 5200, 5700, 6300},
    {1400, 1800, 2200, 2700, 3300, 3900, 4600, 5400, 6300, 7200, 8100, 8900, 9700},
}};

/// Fundamental deviations of shafts, without their sign: the upper one of d to h (below the nominal), the lower one of
/// k to s (above it).
constexpr Row kD{20, 30, 40, 50, 65, 80, 100, 120, 145, 170, 190, 210, 230};
constexpr Row kE{14, 20, 25, 32, 40, 50, 60, 72, 85, 100, 110, 125, 135};
constexpr Row kF{6, 10, 13, 16, 20, 25, 30, 36, 43, 50, 56, 62, 68};
constexpr Row kG{2, 4, 5, 6, 7, 9, 10, 12, 14, 15, 17, 18, 20};
constexpr Row kH{};
constexpr Row kK{0, 1, 1, 1, 2, 2, 2, 3, 3, 4, 4, 4, 5};
constexpr Row kM{2, 4, 6, 7, 8, 9, 11, 13, 15, 17, 20, 21, 23};
constexpr Row kN{4, 8, 10, 12, 15, 17, 20, 23, 27, 31, 34, 37, 40};
constexpr Row kP{6, 12, 15, 18, 22, 26, 32, 37, 43, 50, 56, 62, 68};
constexpr FineRow kR{10, 15, 19, 23, 28, 34, 41, 43, 51, 54, 63, 65, 68, 77, 80, 84, 94, 98, 108, 114, 126, 132};
constexpr FineRow kS{14, 19, 23, 28, 35, 43, 53, 59, 71, 79, 92, 100, 108, 122, 130, 140, 158, 170, 190, 208, 232, 252};
// clang-format on

Error fitError(std::string message) { return Error{.message = std::move(message), .key = "fit"}; }

/// A tolerance class taken apart. `grade`: row of kTolerances; IT n is row n + 1.
struct ToleranceClass {
    std::string_view letters;  // in lower case
    bool hole;
    std::size_t grade;
    std::string_view text;
};
constexpr std::size_t row(int it) { return static_cast<std::size_t>(it + 1); }

std::optional<std::size_t> gradeOf(std::string_view text) {
    if (text == "01") return 0;
    int it = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), it);
    const bool plain = error == std::errc{} && end == text.data() + text.size() && (text.size() == 1 || text[0] != '0');
    if (!plain || it < 0 || row(it) >= kTolerances.size()) return std::nullopt;
    return row(it);
}

Result<ToleranceClass> parseClass(std::string_view text) {
    constexpr std::array<std::array<std::string_view, 2>, 12> kLetters{{{"d", "D"},
                                                                        {"e", "E"},
                                                                        {"f", "F"},
                                                                        {"g", "G"},
                                                                        {"h", "H"},
                                                                        {"js", "JS"},
                                                                        {"k", "K"},
                                                                        {"m", "M"},
                                                                        {"n", "N"},
                                                                        {"p", "P"},
                                                                        {"r", ""},
                                                                        {"s", ""}}};
    const std::size_t length = std::min(text.find_first_of("0123456789"), text.size());
    const std::string_view letters = text.substr(0, length);
    const auto grade = gradeOf(text.substr(length));
    const auto found = std::find_if(kLetters.begin(), kLetters.end(), [&](const auto& pair) {
        return !letters.empty() && (letters == pair[0] || letters == pair[1]);
    });
    if (found == kLetters.end())
        return fitError(
            std::string(text) +
            ": the letter must be D, E, F, G, H, JS, K, M, N or P of a hole, d, e, f, g, h, js, k, m, n, p, "
            "r or s of a shaft");
    if (!grade) return fitError(std::string(text) + ": the grade must be 01, 0 or 1 to 18");
    return ToleranceClass{(*found)[0], letters == (*found)[1], *grade, text};
}

template <std::size_t N>
double inStep(const std::array<double, N>& limits, const std::array<double, N>& values, double size) {
    const auto at = std::lower_bound(limits.begin(), limits.end(), size) - limits.begin();
    return values[static_cast<std::size_t>(at)];
}

/// Fundamental deviation of a shaft's letter but js, without its sign [µm].
double shaftDeviation(const ToleranceClass& c, double size) {
    const auto in = [&](const Row& values) { return inStep(kSteps, values, size); };
    switch (c.letters[0]) {
        case 'd':
            return in(kD);
        case 'e':
            return in(kE);
        case 'f':
            return in(kF);
        case 'g':
            return in(kG);
        case 'h':
            return in(kH);
        case 'k':
            return in(kK);
        case 'm':
            return in(kM);
        case 'n':
            return in(kN);
        case 'p':
            return in(kP);
        case 'r':
            return inStep(kFineSteps, kR, size);
        default:
            return inStep(kFineSteps, kS, size);
    }
}

/// Upper deviation of the holes K, M, N, P [µm]. So that a hole of one grade and a shaft of the next finer one fit
/// alike whichever of them has the letter h or H, the shaft's deviation turned over is raised by Δ = IT n - IT (n - 1):
/// for K, M, N up to IT8, for P up to IT7, above 3 mm.
double holeUpper(const ToleranceClass& c, double size) {
    const char letter = c.letters[0];
    const bool small = size <= 3.0;
    if (letter == 'n' && c.grade > row(8) && !small) return 0.0;
    // The one value that the standard sets apart.
    if (letter == 'm' && c.grade == row(6) && size > 250.0 && size <= 315.0) return -9.0;
    const bool raised = !small && c.grade <= row(letter == 'p' ? 7 : 8);
    const double delta =
        raised ? inStep(kSteps, kTolerances[c.grade], size) - inStep(kSteps, kTolerances[c.grade - 1], size) : 0.0;
    return delta - shaftDeviation(c, size);
}

/// Classes for which the standard gives no value at this grade or size.
std::optional<Error> missing(const ToleranceClass& c, double size) {
    const std::string text(c.text);
    const bool fits_tight = c.hole && (c.letters == "k" || c.letters == "m" || c.letters == "n" || c.letters == "p");
    if (fits_tight && c.grade < row(3)) return fitError(text + ": holes K, M, N, P have grades from 3");
    if (c.hole && c.letters == "k" && c.grade > row(8)) return fitError(text + ": holes K have grades up to 8");
    if (size <= 1.0 && (c.grade >= row(14) || (c.hole && c.letters == "n" && c.grade > row(8))))
        return Error{.message = "must be above 1 mm for " + text, .key = "nominal_diameter"};
    return std::nullopt;
}

double between(const LimitDeviations& deviations, Clearance clearance, bool more_is_larger) {
    if (clearance == Clearance::Mean) return 0.5 * (deviations.lower + deviations.upper);
    return (clearance == Clearance::Max) == more_is_larger ? deviations.upper : deviations.lower;
}

}  // namespace

Result<LimitDeviations> limitDeviations(std::string_view tolerance_class, double nominal) {
    const auto parsed = parseClass(tolerance_class);
    if (!parsed) return parsed.errors();
    const ToleranceClass& c = *parsed;
    // Steps end at whole millimetres: what the conversion of units rounds must not reach the next step.
    const double size = std::round(1e9 * nominal) * 1e-6;  // [mm]
    if (!(size > 0.0 && size <= kLargestSize))
        return Error{.message = "must be above 0 and at most 500 mm for an ISO 286 fit", .key = "nominal_diameter"};
    if (const auto error = missing(c, size)) return *error;

    const double tolerance = inStep(kSteps, kTolerances[c.grade], size);
    const auto micrometres = [](double lower, double upper) { return LimitDeviations{1e-6 * lower, 1e-6 * upper}; };
    if (c.letters == "js") return micrometres(-0.5 * tolerance, 0.5 * tolerance);
    if (c.letters[0] <= 'h') {
        const double away = shaftDeviation(c, size);
        return c.hole ? micrometres(away, away + tolerance) : micrometres(-away - tolerance, -away);
    }
    if (c.hole) {
        const double upper = holeUpper(c, size);
        return micrometres(upper - tolerance, upper);
    }
    // k is on the nominal but for the grades 4 to 7.
    const bool on_nominal = c.letters == "k" && (c.grade < row(4) || c.grade > row(7));
    const double lower = on_nominal ? 0.0 : shaftDeviation(c, size);
    return micrometres(lower, lower + tolerance);
}

Result<Fit> parseFit(std::string_view text) {
    const auto slash = text.find('/');
    const Error malformed = fitError("must be a hole's and a shaft's tolerance class, such as \"H7/g6\"");
    if (slash == std::string_view::npos) return malformed;
    const auto hole = parseClass(text.substr(0, slash));
    if (!hole) return hole.errors();
    const auto shaft = parseClass(text.substr(slash + 1));
    if (!shaft) return shaft.errors();
    if (!hole->hole || shaft->hole) return malformed;
    return Fit{std::string(hole->text), std::string(shaft->text)};
}

Result<double> holeDiameter(const Fit& fit, double nominal, Clearance clearance) {
    const auto deviations = limitDeviations(fit.hole, nominal);
    if (!deviations) return deviations.errors();
    return nominal + between(*deviations, clearance, true);
}

Result<double> shaftDiameter(const Fit& fit, double nominal, Clearance clearance) {
    const auto deviations = limitDeviations(fit.shaft, nominal);
    if (!deviations) return deviations.errors();
    return nominal + between(*deviations, clearance, false);
}

}  // namespace passung::shape
