#include "study/design/williams.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/assert.h"
#include "study/design/counted.h"

namespace passung::design {
namespace {

std::vector<std::size_t> firstRow(std::size_t n) {
    std::vector<std::size_t> row{0};
    for (std::size_t low = 1, high = n - 1; row.size() < n;) row.push_back(row.size() % 2 == 1 ? low++ : high--);
    return row;
}

CountRange rangeOf(const std::vector<int>& counts) {
    const auto [low, high] = std::minmax_element(counts.begin(), counts.end());
    return {*low, *high};
}

}  // namespace

std::string rangeText(const CountRange& range) {
    return range.even() ? fmt::format("{}", range.low) : fmt::format("{}-{}", range.low, range.high);
}

std::size_t williamsRows(std::size_t n) { return n % 2 == 0 ? n : 2 * n; }

Square williamsSquare(std::size_t n) {
    PASSUNG_ASSERT(n >= 2);
    const auto first = firstRow(n);
    Square square;
    for (std::size_t r = 0; r < n; ++r) {
        auto row = first;
        for (auto& entry : row) entry = (entry + r) % n;
        square.push_back(std::move(row));
    }
    if (n % 2 == 1)
        for (std::size_t r = 0; r < n; ++r) square.emplace_back(square[r].rbegin(), square[r].rend());
    return square;
}

Balance balanceOf(const Square& orders) {
    PASSUNG_ASSERT(!orders.empty() && !orders.front().empty());
    const std::size_t n = orders.front().size();
    std::vector<int> positions(n * n), followers(n * n);
    for (const auto& row : orders)
        for (std::size_t i = 0; i < n; ++i) {
            ++positions[row[i] * n + i];
            if (i > 0) ++followers[row[i - 1] * n + row[i]];
        }
    std::vector<int> pairs;
    for (std::size_t i = 0; i < n * n; ++i)
        if (i / n != i % n) pairs.push_back(followers[i]);
    return {rangeOf(positions), pairs.empty() ? CountRange{} : rangeOf(pairs)};
}

Square assignedRows(std::size_t participants, std::size_t conditions) {
    const auto square = williamsSquare(conditions);
    Square rows;
    for (std::size_t slot = 0; slot < participants; ++slot) rows.push_back(square[slot % square.size()]);
    return rows;
}

std::string balanceSentence(std::size_t participants, std::size_t conditions) {
    const std::size_t rows = williamsRows(conditions);
    const std::size_t squares = participants / rows;
    if (participants % rows == 0)
        return fmt::format("{} = {} of {}{}", counted(participants, "participant"),
                           counted(squares, "complete Williams square"), conditions,
                           rows == conditions ? "" : fmt::format(" ({} rows)", rows));
    const auto balance = balanceOf(assignedRows(participants, conditions));
    return fmt::format("{} is not a multiple of {}: position counts {}, neighbour counts {}; balanced with {}{}",
                       participants, rows, rangeText(balance.positions), rangeText(balance.neighbours),
                       squares == 0 ? "" : fmt::format("{} or ", squares * rows), (squares + 1) * rows);
}

}  // namespace passung::design
