#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "study/design/design.h"

namespace passung::design {

/// What the places of a study's participants depend on.
struct Allocation {
    std::size_t groups = 1;     // of the between factors
    std::size_t sequences = 1;  // per group
    std::size_t blocks_of = 1;  // a permuted block holds each group so often
    std::string_view study;
    std::uint64_t seed = 0;
};

/// One place: a group, and in it a row of the counterbalancing.
struct Place {
    std::size_t group = 0;
    std::size_t sequence = 0;
    std::size_t replicate = 0;

    friend bool operator==(const Place&, const Place&) = default;
};

/// Places in the order in which participants of a stratum take them; `round` r holds replicates r·blocks_of to
/// (r + 1)·blocks_of - 1 of every group. Permuted blocks, each drawn from the stream "allocation" of the stratum: after
/// every whole block all groups have equally many. Whoever leaves frees a place; the first free one is taken next, so
/// that what counts is who completed or is under way, not who started.
std::vector<Place> placesOf(const Allocation& allocation, std::string_view stratum, std::size_t round);

/// One of several stations at which a study runs. Each takes whole replicates of its own, every count-th of them.
struct Share {
    std::size_t index = 0;
    std::size_t count = 1;
};

/// Rows of everything that takes turns, the fastest first.
std::vector<std::size_t> rowsOf(const Design& design);

/// The row with which a station begins its replicates, the others following around. Were it the first everywhere, few
/// people at each station would meet the first rows only. `rows`: see rowsOf(); each
/// of them begins count-th parts of its rows apart. 0 for the first station.
std::size_t firstRow(std::span<const std::size_t> rows, const Share& share);

/// The places that a station's first `count` participants of a stratum take, who begin with row `first_row`.
std::vector<Place> firstPlaces(const Allocation& allocation, std::string_view stratum, std::size_t count,
                               const Share& share = {}, std::size_t first_row = 0);

}  // namespace passung::design
