#include "study/design/allocation.h"

#include <string>

#include "core/base/random.h"

namespace passung::design {

std::vector<Place> placesOf(const Allocation& allocation, std::string_view stratum, std::size_t round) {
    const auto& [groups, sequences, blocks_of, study, seed] = allocation;
    std::vector<Place> places;
    std::vector<std::size_t> taken(groups);  // of each group in this round
    for (std::size_t block = 0; block < sequences; ++block) {
        std::vector<std::size_t> order;
        for (std::size_t i = 0; i < blocks_of; ++i)
            for (std::size_t group = 0; group < groups; ++group) order.push_back(group);
        Random random(streamSeed(study, stratum, "allocation", std::to_string(round * sequences + block), seed));
        shuffle(order, random);
        for (const std::size_t group : order) {
            const std::size_t number = taken[group]++;
            places.push_back({group, number % sequences, round * blocks_of + number / sequences});
        }
    }
    return places;
}

std::vector<std::size_t> rowsOf(const Design& design) {
    std::vector<std::size_t> rows;
    for (const CounterbalancingFactor& balancing : counterbalancingFactorsOf(design)) rows.push_back(rowsOf(balancing));
    return rows;
}

std::size_t firstRow(std::span<const std::size_t> rows, const Share& share) {
    std::size_t first = 0, place_value = 1;
    for (const std::size_t count : rows) {
        first += share.index * count / share.count % count * place_value;
        place_value *= count;
    }
    return first;
}

std::vector<Place> firstPlaces(const Allocation& allocation, std::string_view stratum, std::size_t count,
                               const Share& share, std::size_t first_row) {
    std::vector<Place> places;
    for (std::size_t round = 0; places.size() < count; ++round)
        for (Place place : placesOf(allocation, stratum, round)) {
            if (places.size() == count || place.replicate % share.count != share.index) continue;
            place.sequence = (place.sequence + first_row) % allocation.sequences;
            places.push_back(place);
        }
    return places;
}

}  // namespace passung::design
