#include "core/shell/edge_curves.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "core/base/single_precision.h"
#include "core/geometry/mesh_edges.h"

namespace passung::shell {

namespace {

/// Edges, as pairs of vertices, strung together to curves.
class Strings {
public:
    Strings(const geometry::TriangleMesh& mesh, const std::vector<geometry::SharpEdge>& edges) : mesh_(mesh) {
        for (const geometry::SharpEdge& edge : edges) {
            if (edge.inner) continue;
            const auto number = static_cast<std::uint32_t>(ends_.size());
            ends_.push_back({edge.edge.low, edge.edge.high});
            at_[edge.edge.low].push_back(number);
            at_[edge.edge.high].push_back(number);
        }
        taken_.assign(ends_.size(), false);
    }

    /// Calls `use(line, closed)`; a closed line ends where it begins.
    template <class Use>
    void visit(const Use& use) {
        for (const auto& [vertex, edges] : at_) {
            if (passesThrough(vertex)) continue;
            for (const std::uint32_t edge : edges)
                if (!taken_[edge]) use(follow(vertex, edge), false);
        }
        for (std::uint32_t edge = 0; edge < ends_.size(); ++edge)
            if (!taken_[edge]) use(follow(ends_[edge][0], edge), true);
    }

private:
    std::uint32_t otherEnd(std::uint32_t edge, std::uint32_t vertex) const {
        return ends_[edge][0] == vertex ? ends_[edge][1] : ends_[edge][0];
    }

    Vec3 directionFrom(std::uint32_t vertex, std::uint32_t edge) const {
        return (mesh_.vertices[otherEnd(edge, vertex)] - mesh_.vertices[vertex]).normalized();
    }

    bool passesThrough(std::uint32_t vertex) const {
        const auto& edges = at_.at(vertex);
        return edges.size() == 2 &&
               directionFrom(vertex, edges[0]).dot(directionFrom(vertex, edges[1])) < -geometry::kSharpCosine;
    }

    std::vector<Vec3> follow(std::uint32_t vertex, std::uint32_t edge) {
        std::vector<Vec3> line{mesh_.vertices[vertex]};
        while (!taken_[edge]) {
            taken_[edge] = true;
            vertex = otherEnd(edge, vertex);
            line.push_back(mesh_.vertices[vertex]);
            if (!passesThrough(vertex)) break;
            const auto& edges = at_.at(vertex);
            edge = edges[0] == edge ? edges[1] : edges[0];
        }
        return line;
    }

    const geometry::TriangleMesh& mesh_;
    std::vector<std::array<std::uint32_t, 2>> ends_;
    std::map<std::uint32_t, std::vector<std::uint32_t>> at_;
    std::vector<bool> taken_;
};

/// `line` with vertices in between, so that none is farther than `longest` from the next.
std::vector<Vec3> divided(const std::vector<Vec3>& line, double longest) {
    std::vector<Vec3> fine{line.front()};
    for (std::size_t i = 1; i < line.size(); ++i) {
        const Vec3 way = line[i] - line[i - 1];
        const int pieces = std::max(1, static_cast<int>(std::ceil(way.norm() / longest)));
        for (int k = 1; k < pieces; ++k) fine.push_back(line[i - 1] + way * (static_cast<double>(k) / pieces));
        fine.push_back(line[i]);
    }
    return fine;
}

}  // namespace

EdgeCurves::EdgeCurves(const geometry::TriangleMesh& mesh, double spacing) {
    Strings(mesh, geometry::sharpEdges(mesh)).visit([&](const std::vector<Vec3>& line, bool closed) {
        addCurve(divided(line, spacing), closed, spacing);
    });
}

void EdgeCurves::addCurve(std::vector<Vec3> line, bool closed, double spacing) {
    const auto first_station = static_cast<std::uint32_t>(stations_.size());
    std::vector<std::size_t> places{0};
    double gap = 0.0;
    const auto addStation = [&](std::size_t place) {
        places.push_back(place);
        gaps_.push_back(roundedUpToFloat(gap));
        gap = 0.0;
    };
    for (std::size_t i = 1; i < line.size(); ++i) {
        const double next = (line[i] - line[i - 1]).norm();
        if (gap > 0.0 && gap + next > spacing) addStation(i - 1);
        gap += next;
    }
    addStation(line.size() - 1);
    if (closed) {  // on to the second station, so that every station has one on both sides
        const std::size_t second = places[1];
        const float second_gap = gaps_[first_station];
        for (std::size_t i = 1; i <= second; ++i) line.push_back(line[i]);
        places.push_back(line.size() - 1);
        gaps_.push_back(second_gap);
    }
    gaps_.push_back(0.0f);
    const auto first_vertex = static_cast<std::uint32_t>(vertices_.size());
    vertices_.insert(vertices_.end(), line.begin(), line.end());
    for (const std::size_t place : places) {
        const Vec3 p = roundedToFloat(line[place]);
        stations_.push_back(first_vertex + static_cast<std::uint32_t>(place));
        positions_.add(static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z()));
    }
    const auto count = static_cast<std::uint32_t>(places.size());
    // Round a closed curve those between the first and the last, which stand again beside them.
    if (closed)
        addStretches(first_station + 1, count - 2, true);
    else
        addStretches(first_station, count, false);
}

void EdgeCurves::addStretches(std::uint32_t first, std::uint32_t count, bool closed) {
    const std::uint32_t pieces = (count + kStretchStations - 1) / kStretchStations;
    for (std::uint32_t i = 0; i < pieces; ++i) {
        const std::uint32_t begin = first + i * count / pieces, end = first + (i + 1) * count / pieces;
        const Stretch stretch{begin, end - begin, !closed && i == 0, !closed && i + 1 == pieces};
        stretches_.push_back(stretch);
        const std::uint32_t from = stations_[stretch.begins ? begin : begin - 1];
        const std::uint32_t to = stations_[stretch.ends ? end - 1 : end];
        geometry::Bounds bounds;
        for (std::uint32_t k = from; k <= to; ++k) bounds.extend(vertices_[k]);
        const Vec3 centre = roundedToFloat(Vec3(0.5 * (bounds.low + bounds.high)));
        double radius = 0.0;
        for (std::uint32_t k = from; k <= to; ++k) radius = std::max(radius, (vertices_[k] - centre).norm());
        centres_.add(static_cast<float>(centre.x()), static_cast<float>(centre.y()), static_cast<float>(centre.z()));
        radii_.push_back(roundedUpToFloat(radius));
    }
}

}  // namespace passung::shell
