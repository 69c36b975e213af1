#include "core/shell/shell_bytes.h"

#include <cmath>

#include "core/base/bytes.h"

namespace passung::shell {

std::string toBytes(const PointShell& shell) {
    ByteWriter writer;
    writer.put(shell.total_area);
    writer.put(shell.cover_radius);
    writer.put(shell.rounding);
    writer.put(shell.points.size(), 8);
    for (const SurfacePoint& point : shell.points) {
        writer.put(point.position);
        writer.put(point.normal);
        writer.put(point.area);
        writer.put(point.triangle, 4);
    }
    return writer.take();
}

std::optional<PointShell> shellFrom(std::string_view bytes) {
    ByteReader reader(bytes);
    PointShell shell;
    shell.total_area = reader.takeDouble();
    shell.cover_radius = reader.takeDouble();
    shell.rounding = reader.takeDouble();
    shell.points.resize(reader.takeCount(60));
    bool sound = std::isfinite(shell.total_area);
    for (const double length : {shell.cover_radius, shell.rounding})
        sound = sound && length >= 0.0 && std::isfinite(length);
    for (SurfacePoint& point : shell.points) {
        point.position = reader.takeVec3();
        point.normal = reader.takeVec3();
        point.area = reader.takeDouble();
        point.triangle = static_cast<std::uint32_t>(reader.take(4));
        sound = sound && point.position.allFinite() && std::abs(point.normal.norm() - 1.0) < 1e-6 &&
                point.area >= 0.0 && std::isfinite(point.area);
    }
    if (!sound || !reader.atEnd() || shell.points.empty()) return std::nullopt;
    return shell;
}

}  // namespace passung::shell
