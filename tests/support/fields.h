#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "core/base/random.h"
#include "core/contact/contact_query.h"
#include "core/tick/closed_form_proxy.h"
#include "core/tick/surface_follow.h"

namespace passung::test {

/// What saves time and holds nothing that anybody may look at, and a proxy that hides what it holds.
template <class T>
inline constexpr bool kIsMemory =
    std::is_same_v<T, contact::QueryWorkspace> || std::is_same_v<T, geometry::NearList> ||
    std::is_same_v<T, tick::KnownPairs> || std::is_same_v<T, tick::ClosedFormMemory> ||
    std::is_same_v<T, tick::FieldLook> || std::is_same_v<T, std::optional<surface::SurfaceProxy>>;

/// Converts to whatever a field is.
struct Anything {
    template <class T>
    operator T() const;
};

inline constexpr std::size_t kMostFields = 11;

/// How many fields the plain struct T has: the most that it can be made from.
template <class T, class... Field>
consteval std::size_t fieldCount() {
    if constexpr (sizeof...(Field) <= kMostFields) {
        constexpr std::size_t more = fieldCount<T, Field..., Anything>();
        if (more > 0) return more;
        if (requires { T{Field{}...}; }) return sizeof...(Field);
    } else if (requires { T{Field{}...}; }) {
        return kMostFields + 1;
    }
    return 0;
}

/// Calls `f` with each field of a plain struct.
template <class T, class F>
void eachField(T& value, F f) {
    constexpr std::size_t count = fieldCount<std::remove_const_t<T>>();
    const auto all = [&f](auto&... field) { (f(field), ...); };
    static_assert(count >= 1 && count <= kMostFields, "a longer struct needs a line here");
    if constexpr (count == 1) {
        auto& [a] = value;
        all(a);
    } else if constexpr (count == 2) {
        auto& [a, b] = value;
        all(a, b);
    } else if constexpr (count == 3) {
        auto& [a, b, c] = value;
        all(a, b, c);
    } else if constexpr (count == 4) {
        auto& [a, b, c, d] = value;
        all(a, b, c, d);
    } else if constexpr (count == 5) {
        auto& [a, b, c, d, e] = value;
        all(a, b, c, d, e);
    } else if constexpr (count == 6) {
        auto& [a, b, c, d, e, g] = value;
        all(a, b, c, d, e, g);
    } else if constexpr (count == 7) {
        auto& [a, b, c, d, e, g, h] = value;
        all(a, b, c, d, e, g, h);
    } else if constexpr (count == 8) {
        auto& [a, b, c, d, e, g, h, i] = value;
        all(a, b, c, d, e, g, h, i);
    } else if constexpr (count == 9) {
        auto& [a, b, c, d, e, g, h, i, j] = value;
        all(a, b, c, d, e, g, h, i, j);
    } else if constexpr (count == 10) {
        auto& [a, b, c, d, e, g, h, i, j, k] = value;
        all(a, b, c, d, e, g, h, i, j, k);
    } else {
        auto& [a, b, c, d, e, g, h, i, j, k, l] = value;
        all(a, b, c, d, e, g, h, i, j, k, l);
    }
}

/// Calls `f` with each number in `value`, however deep. Memory of queries has none that anybody may look at.
template <class T, class F>
void eachNumber(T& value, F&& f) {
    using Plain = std::remove_const_t<T>;
    if constexpr (std::is_arithmetic_v<Plain> || std::is_enum_v<Plain>) {
        f(value);
    } else if constexpr (std::is_same_v<Plain, Quat>) {
        for (int i = 0; i < 4; ++i) f(value.coeffs()[i]);
    } else if constexpr (std::is_base_of_v<Eigen::MatrixBase<Plain>, Plain>) {
        for (int i = 0; i < value.size(); ++i) f(value.data()[i]);
    } else if constexpr (requires { value.held(); }) {
        for (std::size_t i = 0; i < value.size(); ++i) eachNumber(value[i], f);
    } else if constexpr (requires {
                             value[0];
                             value.begin();
                         }) {
        for (auto& element : value) eachNumber(element, f);
    } else if constexpr (!kIsMemory<Plain>) {
        eachField(value, [&f](auto& field) { eachNumber(field, f); });
    }
}

/// All bits in `value`.
template <class T>
std::vector<std::uint64_t> bitsOf(const T& value) {
    std::vector<std::uint64_t> bits;
    eachNumber(value, [&bits](const auto& number) {
        if constexpr (std::is_same_v<decltype(number), const double&>)
            bits.push_back(std::bit_cast<std::uint64_t>(number));
        else
            bits.push_back(static_cast<std::uint64_t>(number));
    });
    return bits;
}

/// Fills every number of `value` with random bits. A list keeps its length; contacts get any number of them.
template <class T>
void scramble(T& value, Random& random) {
    if constexpr (std::is_same_v<T, contact::ContactManifold>) {
        value.clear();
        for (auto left = random.below(20); left > 0; --left) {
            contact::ContactPoint point;
            scramble(point, random);
            if (!value.tryPush(point)) return;
        }
    } else if constexpr (std::is_same_v<T, bool>) {
        value = random.below(2) == 1;
    } else if constexpr (std::is_same_v<T, double>) {
        value = std::bit_cast<double>(random.next());
    } else if constexpr (std::is_integral_v<T> || std::is_enum_v<T>) {
        value = static_cast<T>(random.next());
    } else if constexpr (std::is_same_v<T, Quat> || std::is_base_of_v<Eigen::MatrixBase<T>, T> || requires {
                             value[0];
                             value.begin();
                         }) {
        eachNumber(value, [&random](auto& number) { scramble(number, random); });
    } else if constexpr (!kIsMemory<T>) {
        eachField(value, [&random](auto& field) { scramble(field, random); });
    }
}

}  // namespace passung::test
