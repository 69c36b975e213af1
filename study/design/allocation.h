#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

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

/// The first `count` of all rounds.
std::vector<Place> firstPlaces(const Allocation& allocation, std::string_view stratum, std::size_t count);

}  // namespace passung::design
