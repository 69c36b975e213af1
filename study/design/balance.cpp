#include "study/design/balance.h"

#include <fmt/format.h>

#include "study/design/permutations.h"

namespace passung::design {
namespace {

/// All rows of a counterbalancing factor, before relabelling.
Square rowsWith(const CounterbalancingFactor& balancing) {
    if (balancing.what != CounterbalancingFactor::What::Assignment && balancing.order == Order::Williams)
        return williamsSquare(balancing.items);
    Square rows;
    for (std::size_t row = 0; row < rowsOf(balancing); ++row) {
        if (balancing.what != CounterbalancingFactor::What::Assignment) {
            rows.push_back(permutation(balancing.items, row));
            continue;
        }
        rows.emplace_back();
        for (std::size_t i = 0; i < balancing.items; ++i) rows.back().push_back((i + row) % balancing.items);
    }
    return rows;
}

std::string nameOf(const Design& design, const CounterbalancingFactor& balancing) {
    const auto factor = [&] { return design.factors[*balancing.factor].name; };
    const char* list = balancing.order == Order::Williams ? "Williams square" : "list of all orders";
    switch (balancing.what) {
        case CounterbalancingFactor::What::Conditions:
            return fmt::format("conditions{}, {} of {}", balancing.factor ? " within " + factor() : "", list,
                               balancing.items);
        case CounterbalancingFactor::What::Levels:
            return fmt::format("levels of {}, {} of {}", factor(), list, balancing.items);
        case CounterbalancingFactor::What::Assignment:
            return fmt::format("assignment of {}, {} levels", factor(), balancing.items);
    }
    return "";
}

}  // namespace

std::vector<FactorBalance> balancesOf(const Design& design, std::span<const std::size_t> slots) {
    std::vector<FactorBalance> all;
    const auto balancings = counterbalancingFactorsOf(design);
    for (std::size_t w = 0; w < balancings.size() && !slots.empty(); ++w) {
        if (balancings[w].items < 2) continue;
        const auto rows = rowsWith(balancings[w]);
        Square taken;
        for (const std::size_t slot : slots) taken.push_back(rows[rowOf(balancings, w, slot)]);
        FactorBalance of{balancings[w], rows.size(), balanceOf(taken)};
        of.even = of.counts.positions.even() &&
                  (balancings[w].what == CounterbalancingFactor::What::Assignment || of.counts.neighbours.even());
        all.push_back(of);
    }
    return all;
}

std::size_t evenNumber(const Design& design) { return sequencesOf(design) * groupsOf(design).size(); }

std::vector<std::string> balanceLines(const Design& design, std::span<const std::size_t> slots) {
    std::vector<std::string> lines;
    for (const FactorBalance& of : balancesOf(design, slots)) {
        const bool assigned = of.balancing.what == CounterbalancingFactor::What::Assignment;
        lines.push_back(fmt::format("{} ({} rows): {} counts {}{}{}", nameOf(design, of.balancing), of.rows,
                                    assigned ? "pair" : "position", rangeText(of.counts.positions),
                                    assigned ? "" : ", neighbour counts " + rangeText(of.counts.neighbours),
                                    of.even ? "" : ", not balanced"));
    }
    return lines;
}

}  // namespace passung::design
