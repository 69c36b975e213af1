#pragma once

#include <string>
#include <string_view>

#include "core/base/result.h"

namespace passung::shape {

/// How far the limits of a size are from its nominal [m].
struct LimitDeviations {
    double lower, upper;
};

/// Limit deviations by ISO 286 (1 and 2), nominal sizes up to 500 mm. `tolerance_class`: holes D, E, F, G, H, JS, K, M,
/// N, P, shafts d, e, f, g, h, js, k, m, n, p, r, s, with the grade 01, 0 or 1 to 18; `nominal` [m].
/// Errors, their key `fit` or `nominal_diameter`: unknown class, a size out of range, a class that the standard does
/// not give for the grade or size.
Result<LimitDeviations> limitDeviations(std::string_view tolerance_class, double nominal);

/// A hole's and a shaft's tolerance class: "H7/g6".
struct Fit {
    std::string hole, shaft;
};
/// Errors, their key `fit`: not two classes, or the shaft's first.
Result<Fit> parseFit(std::string_view text);

/// Which parts of all that the fit allows: the pair with the mean, the least or the most clearance.
enum class Clearance { Mean, Min, Max };

/// Diameter of the hole or the shaft [m]. Errors as limitDeviations.
Result<double> holeDiameter(const Fit& fit, double nominal, Clearance clearance);
Result<double> shaftDiameter(const Fit& fit, double nominal, Clearance clearance);

}  // namespace passung::shape
