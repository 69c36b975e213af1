#include "study/store/samples/planes.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <numeric>

namespace passung::store {
namespace {

constexpr std::size_t kMostOrder = 3;

template <class Word>
constexpr unsigned kSignShift = 8 * sizeof(Word) - 1;

/// 0, -1, 1, -2 … become 0, 1, 2, 3 …
template <class Word>
Word folded(Word difference) {
    return static_cast<Word>(difference << 1) ^ static_cast<Word>(Word{0} - (difference >> kSignShift<Word>));
}
template <class Word>
Word unfolded(Word word) {
    return (word >> 1) ^ static_cast<Word>(Word{0} - (word & 1));
}

template <class Word>
void takeDifferences(std::vector<Word>& values) {
    for (std::size_t i = values.size(); i-- > 1;) values[i] -= values[i - 1];
}

template <class Word>
std::size_t bitsOf(const std::vector<Word>& differences) {
    std::size_t bits = 0;
    for (const Word difference : differences) bits += static_cast<std::size_t>(std::bit_width(folded(difference)));
    return bits;
}

/// Writes the planes of a column and returns how often differences were taken.
template <class Word>
std::size_t writeColumn(const std::byte* column, std::size_t rows, std::byte* planes) {
    std::vector<Word> values(rows);
    std::memcpy(values.data(), column, rows * sizeof(Word));
    std::vector<Word> best = values;
    std::size_t order = 0, least = bitsOf(values);
    for (std::size_t next = 1; next <= kMostOrder && least > 0; ++next) {
        takeDifferences(values);
        const std::size_t bits = bitsOf(values);
        if (bits >= least) continue;
        best = values, least = bits, order = next;
    }
    for (std::size_t row = 0; row < rows; ++row) {
        const Word word = folded(best[row]);
        for (std::size_t byte = 0; byte < sizeof(Word); ++byte)
            planes[byte * rows + row] = static_cast<std::byte>(word >> (8 * byte) & 0xff);
    }
    return order;
}

template <class Word>
void readColumn(const std::byte* planes, std::size_t rows, std::size_t order, std::byte* column) {
    std::vector<Word> values(rows);
    for (std::size_t row = 0; row < rows; ++row) {
        Word word = 0;
        for (std::size_t byte = 0; byte < sizeof(Word); ++byte)
            word |= static_cast<Word>(std::to_integer<Word>(planes[byte * rows + row]) << (8 * byte));
        values[row] = unfolded(word);
    }
    for (; order > 0; --order) std::partial_sum(values.begin(), values.end(), values.begin());
    std::memcpy(column, values.data(), rows * sizeof(Word));
}

std::size_t bytesOf(std::span<const std::size_t> widths, std::size_t rows) {
    return std::accumulate(widths.begin(), widths.end(), std::size_t{0}) * rows;
}

}  // namespace

std::vector<std::byte> toDifferencePlanes(std::span<const std::byte> columns, std::span<const std::size_t> widths,
                                          std::size_t rows) {
    std::vector<std::byte> bytes(widths.size() + columns.size());
    std::size_t at = 0;
    for (std::size_t i = 0; i < widths.size(); at += widths[i++] * rows) {
        std::byte* planes = bytes.data() + widths.size() + at;
        const auto write = widths[i] == sizeof(std::uint64_t) ? writeColumn<std::uint64_t> : writeColumn<std::uint32_t>;
        bytes[i] = static_cast<std::byte>(write(columns.data() + at, rows, planes));
    }
    return bytes;
}

std::optional<std::vector<std::byte>> fromDifferencePlanes(std::span<const std::byte> bytes,
                                                           std::span<const std::size_t> widths, std::size_t rows) {
    std::vector<std::byte> columns(bytesOf(widths, rows));
    if (bytes.size() != widths.size() + columns.size()) return std::nullopt;
    std::size_t at = 0;
    for (std::size_t i = 0; i < widths.size(); at += widths[i++] * rows) {
        const auto order = std::to_integer<std::size_t>(bytes[i]);
        if (order > kMostOrder) return std::nullopt;
        const auto read = widths[i] == sizeof(std::uint64_t) ? readColumn<std::uint64_t> : readColumn<std::uint32_t>;
        read(bytes.data() + widths.size() + at, rows, order, columns.data() + at);
    }
    return columns;
}

std::vector<std::byte> fromPlanes(std::span<const std::byte> planes, std::span<const std::size_t> widths,
                                  std::size_t rows) {
    std::vector<std::byte> columns(planes.size());
    std::size_t at = 0;
    for (const std::size_t width : widths) {
        for (std::size_t byte = 0; byte < width; ++byte)
            for (std::size_t row = 0; row < rows; ++row)
                columns[at + row * width + byte] = planes[at + byte * rows + row];
        at += rows * width;
    }
    return columns;
}

}  // namespace passung::store
