#include "core/contact/surface_descent.h"

#include <algorithm>
#include <array>

namespace passung::contact {

namespace {

constexpr std::size_t kDirections = 8;
constexpr float kFirstStep = 0.5f, kLastStep = 0.04f;  // per cover radius
constexpr float kShorter = 0.35f;
/// Cosine and sine of 0°, 45°, ..., 315°; every other time they are turned by 22.5° more.
constexpr float kDiagonal = 0.707106781f, kCosineTurn = 0.923879533f, kSineTurn = 0.382683432f;
constexpr std::array<float, kDirections> kCosine{1.0f, kDiagonal, 0.0f, -kDiagonal, -1.0f, -kDiagonal, 0.0f, kDiagonal};
constexpr std::array<float, kDirections> kSine{0.0f, kDiagonal, 1.0f, kDiagonal, 0.0f, -kDiagonal, -1.0f, -kDiagonal};

}  // namespace

Descent descend(const field::DistanceField& field, const field::DistanceField::Placement& S,
                const shell::SphereTree& shell, std::uint32_t start, double phi) noexcept {
    const geometry::SurfaceWalk& surface = shell.surface();
    const shell::SurfacePoint& from = shell.points()[start];
    if (from.triangle >= surface.size()) return {from.position, 0};
    std::array<geometry::SurfaceWalk::WalkPlace, kDirections> tried;
    std::array<float, kDirections> x, y, z, read;
    geometry::SurfaceWalk::WalkPlace best{from.triangle, from.position.cast<float>()};
    auto least = static_cast<float>(phi);
    const auto cover = static_cast<float>(shell.coverRadius());
    float length = kFirstStep * cover;
    int round = 0;
    for (; round < kDescentRounds && length > kLastStep * cover; ++round) {
        const auto [u, v] = surface.axes(best.triangle);
        const bool turned = round % 2 != 0;
        const float c = length * (turned ? kCosineTurn : 1.0f), s = length * (turned ? kSineTurn : 0.0f);
        const Eigen::Vector3f along = c * u + s * v, across = c * v - s * u;
        for (std::size_t i = 0; i < kDirections; ++i) {
            tried[i] = surface.moved(best, kCosine[i] * along + kSine[i] * across);
            x[i] = tried[i].position.x();
            y[i] = tried[i].position.y();
            z[i] = tried[i].position.z();
        }
        field.sampleMany(S, x, y, z, read);
        const auto lowest = static_cast<std::size_t>(std::min_element(read.begin(), read.end()) - read.begin());
        if (read[lowest] < least) {
            least = read[lowest];
            best = tried[lowest];
        } else {
            length *= kShorter;
        }
    }
    return {best.position.cast<double>(), static_cast<int>(kDirections) * round};
}

}  // namespace passung::contact
