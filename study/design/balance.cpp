#include "study/design/balance.h"

#include <fmt/format.h>

#include "study/design/permutations.h"

namespace passung::design {
namespace {

/// All rows of a wheel, before relabelling.
Square rowsWith(const Wheel& wheel) {
    if (wheel.what != Wheel::What::Assignment && wheel.order == Order::Williams) return williamsSquare(wheel.items);
    Square rows;
    for (std::size_t row = 0; row < rowsOf(wheel); ++row) {
        if (wheel.what != Wheel::What::Assignment) {
            rows.push_back(permutation(wheel.items, row));
            continue;
        }
        rows.emplace_back();
        for (std::size_t i = 0; i < wheel.items; ++i) rows.back().push_back((i + row) % wheel.items);
    }
    return rows;
}

std::string nameOf(const Design& design, const Wheel& wheel) {
    const auto factor = [&] { return design.factors[*wheel.factor].name; };
    const char* list = wheel.order == Order::Williams ? "Williams square" : "list of all orders";
    switch (wheel.what) {
        case Wheel::What::Conditions:
            return fmt::format("conditions{}, {} of {}", wheel.factor ? " within " + factor() : "", list, wheel.items);
        case Wheel::What::Levels:
            return fmt::format("levels of {}, {} of {}", factor(), list, wheel.items);
        case Wheel::What::Assignment:
            return fmt::format("assignment of {}, {} levels", factor(), wheel.items);
    }
    return "";
}

}  // namespace

std::vector<WheelBalance> balancesOf(const Design& design, std::span<const std::size_t> slots) {
    std::vector<WheelBalance> all;
    const auto wheels = wheelsOf(design);
    for (std::size_t w = 0; w < wheels.size() && !slots.empty(); ++w) {
        if (wheels[w].items < 2) continue;
        const auto rows = rowsWith(wheels[w]);
        Square taken;
        for (const std::size_t slot : slots) taken.push_back(rows[rowOf(wheels, w, slot)]);
        WheelBalance of{wheels[w], rows.size(), balanceOf(taken)};
        of.even =
            of.counts.positions.even() && (wheels[w].what == Wheel::What::Assignment || of.counts.neighbours.even());
        all.push_back(of);
    }
    return all;
}

std::size_t evenNumber(const Design& design) { return sequencesOf(design) * groupsOf(design).size(); }

std::vector<std::string> balanceLines(const Design& design, std::span<const std::size_t> slots) {
    std::vector<std::string> lines;
    for (const WheelBalance& of : balancesOf(design, slots)) {
        const bool assigned = of.wheel.what == Wheel::What::Assignment;
        lines.push_back(fmt::format("{} ({} rows): {} counts {}{}{}", nameOf(design, of.wheel), of.rows,
                                    assigned ? "pair" : "position", rangeText(of.counts.positions),
                                    assigned ? "" : ", neighbour counts " + rangeText(of.counts.neighbours),
                                    of.even ? "" : ", not balanced"));
    }
    return lines;
}

}  // namespace passung::design
