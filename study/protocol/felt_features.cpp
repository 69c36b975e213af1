#include "study/protocol/felt_features.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/scene/contact_geometry.h"
#include "study/plan/scene_parts.h"

namespace passung::protocol {
namespace {

using shape::FeatureKind;
using shape::ThinFeature;
using shape::ThinIn;

constexpr double kSpacingShare = 1.0 / 50;        // of the held part's longest side
constexpr double kToleranceShare = 1.0 / 2500;    // likewise
constexpr double kFeatureTolerance = 1.0 / 20;    // of the smallest feature
constexpr double kFinestTolerance = 1.0 / 40000;  // of the largest obstacle
constexpr double kEdgeGap = 0.25;  // per spacing: no place of a sharp edge is farther from a sample of it

/// 1, 2 or 5 times a power of ten: the nearest, as a factor.
double rounded(double value) {
    const double decade = std::pow(10.0, std::floor(std::log10(value)));
    const double digits = value / decade;
    return decade * (digits < std::sqrt(2.0)    ? 1.0
                     : digits < std::sqrt(10.0) ? 2.0
                     : digits < std::sqrt(50.0) ? 5.0
                                                : 10.0);
}

std::string roundMillimetres(double metres) { return fmt::format("{:.2g} mm", 1e3 * metres); }

/// "a pin 1 mm thick"
std::string described(const ThinFeature& feature) {
    const auto at = 1e3 * feature.place;
    const std::string place = feature.place.isZero(0.0)
                                  ? ""
                                  : fmt::format(" at {:.3g}, {:.3g}, {:.3g} mm of its frame", at.x(), at.y(), at.z());
    const char* article = feature.kind == FeatureKind::Edge ? "an" : "a";
    return fmt::format("{} {} {} thick{}", article, shape::featureName(feature.kind), roundMillimetres(feature.size),
                       place);
}

double fieldRadius(const scene::ContactSpec& contact) {
    return contact.cell > 0.0 ? 0.5 * std::sqrt(3.0) * contact.cell : contact.tolerance;
}

bool isSheet(const scene::PartSpec& part, PartGeometries& geometries) {
    const PartSurface* geometry = geometries.of(part);
    return geometry != nullptr && geometry->sheet;
}

std::vector<ThinFeature> withoutRelief(std::vector<ThinFeature> features) {
    std::erase_if(features, [](const ThinFeature& feature) { return feature.kind == FeatureKind::Relief; });
    return features;
}

/// Else no feature is lost, and nobody looks for them: of a large mesh that takes longer than all else.
bool isSampled(const scene::SceneSpec& scene) { return scene::geometryOf(scene).geometry == scene::Geometry::Field; }

/// The smallest feature of an obstacle that slips between points of this spacing [m]; infinite if there is none.
double smallestFeature(const scene::SceneSpec& scene, double spacing, PartGeometries& geometries) {
    double smallest = std::numeric_limits<double>::infinity();
    if (!isSampled(scene)) return smallest;
    for (const scene::PartSpec& part : scene.parts) {
        if (&part == plan::heldPart(scene) || isSheet(part, geometries)) continue;
        for (const ThinFeature& feature : geometries.thin(part, kCoverShare * spacing, ThinIn::Points))
            if (feature.kind != FeatureKind::Relief) smallest = std::min(smallest, feature.size);
    }
    return smallest;
}

/// What will not be felt of an obstacle.
struct Unfelt {
    std::size_t part;
    std::string message;
    bool relief;  // of a scan, or not known: not an error
};

/// One scene's obstacles, one after the other.
class FeltCheck {
public:
    FeltCheck(const scene::SceneSpec& scene, PartGeometries& geometries) : scene_(scene), geometries_(geometries) {}

    std::vector<Unfelt> run() {
        if (!isSampled(scene_)) return {};
        const scene::PartSpec* held = plan::heldPart(scene_);
        for (part_ = 0; held != nullptr && part_ < scene_.parts.size(); ++part_) {
            const scene::PartSpec& part = scene_.parts[part_];
            if (&part == held) continue;
            checkPoints(*held, part);
            if (!isSheet(part, geometries_)) checkField(part);
            if (geometries_.halfSearched(part))
                unfelt_.push_back({part_,
                                   "has so many edges and thin places that not all could be looked at: one that would "
                                   "not be felt may be among the rest",
                                   true});
        }
        return std::move(unfelt_);
    }

private:
    void checkPoints(const scene::PartSpec& held, const scene::PartSpec& part) {
        const scene::ContactSpec& contact = scene_.contact;
        const auto& features = geometries_.thin(part, kCoverShare * contact.spacing, ThinIn::Points);
        if (features.empty()) return;
        const std::string apart = fmt::format("the held part's points, {} apart", roundMillimetres(contact.spacing));
        if (!contact.two_way) {
            report(features, "slips between " + apart, [&](double size) {
                return fmt::format("two_way = true{}",
                                   size > 0.0 ? " or spacing_mm of at most " + limit(0.5 * size / kCoverShare) : "");
            });
            return;
        }
        if (isSheet(held, geometries_)) return;
        const double needed = std::max(kEdgeGap * contact.spacing, fieldRadius(contact));
        const auto lost = withoutRelief(geometries_.thin(held, needed, ThinIn::Field));
        if (lost.empty()) return;
        report(features,
               fmt::format("slips between {}, and its own points through {} of the held part", apart,
                           described(lost.front())),
               [&](double) {
                   return fmt::format("{} of at most {}",
                                      needed > kEdgeGap * contact.spacing
                                          ? (contact.cell > 0.0 ? "cell_mm" : "tolerance_um / 1000")
                                          : "spacing_mm",
                                      limit(lost.front().size * (needed > kEdgeGap * contact.spacing ? 0.5 : 1.9)));
               });
    }

    void checkField(const scene::PartSpec& part) {
        const scene::ContactSpec& contact = scene_.contact;
        // What grows thicker farther in is blunted, not lost.
        std::vector<ThinFeature> features = geometries_.thin(part, fieldRadius(contact), ThinIn::Field);
        std::erase_if(features, [](const ThinFeature& feature) {
            return feature.kind == FeatureKind::Edge || feature.kind == FeatureKind::Tip;
        });
        const bool cells = contact.cell > 0.0;
        report(features,
               cells ? fmt::format("is lost in the distance field's cells of {}", roundMillimetres(contact.cell))
                     : fmt::format("is lost in the distance field's tolerance of {:.3g} um", 1e6 * contact.tolerance),
               [&](double size) {
                   return cells ? fmt::format("cell_mm of at most {}, or tolerance_um in its place",
                                              limit(size / std::sqrt(3.0)))
                                : fmt::format("tolerance_um of at most {:.2g}", 0.95 * 0.5e6 * size);
               });
    }

    /// In roundMillimetres, rounded down.
    static std::string limit(double metres) { return fmt::format("{:.2g}", 0.95e3 * metres); }

    template <class Remedy>
    void report(const std::vector<ThinFeature>& features, const std::string& why, const Remedy& remedy) {
        const auto clear = withoutRelief(features);
        if (!clear.empty()) {
            const auto others = clear.size() > 1 ? fmt::format(" (and {} more)", clear.size() - 1) : std::string();
            unfelt_.push_back({part_,
                               fmt::format("{}{} {}: it would not be felt; {}", described(clear.front()), others, why,
                                           remedy(clear.front().size)),
                               false});
        } else if (!features.empty()) {
            unfelt_.push_back({part_,
                               fmt::format("relief of up to {} {}: it is not felt; {}",
                                           roundMillimetres(features.back().size), why, remedy(features.front().size)),
                               true});
        }
    }

    const scene::SceneSpec& scene_;
    PartGeometries& geometries_;
    std::size_t part_ = 0;
    std::vector<Unfelt> unfelt_;
};

}  // namespace

ContactDefaults defaultsFor(const scene::SceneSpec& scene, PartGeometries& geometries) {
    ContactDefaults defaults;
    const scene::PartSpec* held = plan::heldPart(scene);
    const PartSurface* geometry = held != nullptr ? geometries.of(*held) : nullptr;
    if (geometry == nullptr || !(geometry->longest() > 0.0)) return defaults;
    const double spacing = rounded(kSpacingShare * geometry->longest());
    const double feature = smallestFeature(scene, spacing, geometries);
    const double fewest = std::sqrt(geometry->area / kDefaultPoints);
    defaults.spacing = std::max(spacing > feature ? rounded(feature) : spacing, fewest);
    double largest = 0.0;
    for (const scene::PartSpec& part : scene.parts)
        if (const PartSurface* other = geometries.of(part); other != nullptr)
            largest = std::max(largest, other->longest());
    const double fine = std::min(kToleranceShare * geometry->longest(), kFeatureTolerance * std::max(feature, 1e-9));
    defaults.tolerance = std::max(rounded(fine), kFinestTolerance * largest);
    return defaults;
}

bool oneWayFeelsAll(const scene::SceneSpec& scene, PartGeometries& geometries) {
    if (!isSampled(scene)) return true;
    return std::all_of(scene.parts.begin(), scene.parts.end(), [&](const scene::PartSpec& part) {
        return &part == plan::heldPart(scene) ||
               geometries.thin(part, kCoverShare * scene.contact.spacing, ThinIn::Points).empty();
    });
}

void checkFelt(const Node& table, const std::string& path, const scene::SceneSpec& scene, PartGeometries& geometries,
               Errors& errors, std::vector<std::string>& warnings) {
    const Node* parts = table.find("part");
    if (parts == nullptr || parts->items.size() != scene.parts.size()) return;
    for (const Unfelt& unfelt : FeltCheck(scene, geometries).run()) {
        const std::string key = fmt::format("{}part.{}", path.empty() ? "" : path + ".", scene.parts[unfelt.part].name);
        if (unfelt.relief)
            warnings.push_back(key + ": " + unfelt.message);
        else
            errors.push_back(errorAt(parts->items[unfelt.part].place, key, "", unfelt.message));
    }
}

bool feelsEverything(const scene::SceneSpec& scene, PartGeometries& geometries) {
    const auto unfelt = FeltCheck(scene, geometries).run();
    return std::all_of(unfelt.begin(), unfelt.end(), [](const Unfelt& one) { return one.relief; });
}

}  // namespace passung::protocol
