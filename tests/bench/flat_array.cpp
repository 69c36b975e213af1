#include "tests/bench/flat_array.h"

#include <cstdint>

namespace passung::bench {

namespace {

/// The transform and the grid folded into one affine map from a point to grid coordinates.
struct Map {
    float xx, xy, xz, x0, yx, yy, yz, y0, zx, zy, zz, z0;
};

template <class Value>
inline __attribute__((always_inline)) void sampleEach(const Value* values, std::int32_t row, std::int32_t slab,
                                                      float scale, const Map& map, const float* x, const float* y,
                                                      const float* z, float* phi, std::size_t count) {
    const Map m = map;
    for (std::size_t i = 0; i < count; ++i) {
        const float gx = m.xx * x[i] + m.xy * y[i] + m.xz * z[i] + m.x0;
        const float gy = m.yx * x[i] + m.yy * y[i] + m.yz * z[i] + m.y0;
        const float gz = m.zx * x[i] + m.zy * y[i] + m.zz * z[i] + m.z0;
        const auto ix = static_cast<std::int32_t>(gx), iy = static_cast<std::int32_t>(gy),
                   iz = static_cast<std::int32_t>(gz);
        const float ux = gx - static_cast<float>(ix), uy = gy - static_cast<float>(iy),
                    uz = gz - static_cast<float>(iz);
        const Value* v = values + (iz * slab + iy * row + ix);
        const auto at = [&](std::int32_t k) { return static_cast<float>(v[k]); };
        const float a = at(0) + ux * (at(1) - at(0)), b = at(row) + ux * (at(row + 1) - at(row));
        const float c = at(slab) + ux * (at(slab + 1) - at(slab));
        const float d = at(slab + row) + ux * (at(slab + row + 1) - at(slab + row));
        const float e = a + uy * (b - a), f = c + uy * (d - c);
        phi[i] = scale * (e + uz * (f - e));
    }
}

// One loop for each kind of processor, chosen when the program starts.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define PASSUNG_CLONES __attribute__((target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")))
#else
#define PASSUNG_CLONES
#endif

PASSUNG_CLONES void sampleAll(const std::int16_t* values, std::int32_t row, std::int32_t slab, float scale,
                              const Map& map, const float* x, const float* y, const float* z, float* phi,
                              std::size_t count) {
    sampleEach(values, row, slab, scale, map, x, y, z, phi, count);
}

PASSUNG_CLONES void sampleAll(const float* values, std::int32_t row, std::int32_t slab, float scale, const Map& map,
                              const float* x, const float* y, const float* z, float* phi, std::size_t count) {
    sampleEach(values, row, slab, scale, map, x, y, z, phi, count);
}

}  // namespace

template <class Value>
void FlatArray<Value>::sample(const Pose& X, std::span<const float> x, std::span<const float> y,
                              std::span<const float> z, std::span<float> phi) const {
    const Eigen::Matrix3f turn = (X.q.toRotationMatrix() / cell).cast<float>();
    const Eigen::Vector3f shift = ((X.p - origin) / cell).cast<float>();
    const Map map{turn(0, 0), turn(0, 1), turn(0, 2), shift.x(),  turn(1, 0), turn(1, 1),
                  turn(1, 2), shift.y(),  turn(2, 0), turn(2, 1), turn(2, 2), shift.z()};
    sampleAll(values.data(), nodes[0], nodes[0] * nodes[1], scale, map, x.data(), y.data(), z.data(), phi.data(),
              x.size());
}

template struct FlatArray<std::int16_t>;
template struct FlatArray<float>;

}  // namespace passung::bench
