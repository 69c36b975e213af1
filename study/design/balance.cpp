#include "study/design/balance.h"

#include <fmt/format.h>

#include "study/design/permutations.h"
#include "study/design/williams.h"

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

std::vector<std::string> balanceLines(const Design& design, std::span<const std::size_t> slots) {
    std::vector<std::string> lines;
    const auto wheels = wheelsOf(design);
    for (std::size_t w = 0; w < wheels.size() && !slots.empty(); ++w) {
        if (wheels[w].items < 2) continue;
        const auto rows = rowsWith(wheels[w]);
        Square taken;
        for (const std::size_t slot : slots) taken.push_back(rows[rowOf(wheels, w, slot)]);
        const Balance balance = balanceOf(taken);
        const bool assigned = wheels[w].what == Wheel::What::Assignment;
        const bool even = balance.positions.even() && (assigned || balance.neighbours.even());
        lines.push_back(fmt::format("{} ({} rows): {} counts {}{}{}", nameOf(design, wheels[w]), rows.size(),
                                    assigned ? "pair" : "position", rangeText(balance.positions),
                                    assigned ? "" : ", neighbour counts " + rangeText(balance.neighbours),
                                    even ? "" : ", not balanced"));
    }
    return lines;
}

}  // namespace passung::design
