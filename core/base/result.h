#pragma once

#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace passung {

/// One thing that is wrong with an input, for a person to read.
/// Printed as `file:line:column: error: key: value: requirement`, parts that do not apply left out.
struct Error {
    std::string message;  // what is required, or what failed
    std::string file = {};
    int line = 0;    // 1-based; 0 = not from a text
    int column = 0;  // 1-based
    std::string key = {};
    std::string value = {};
};

/// The line a user sees.
std::string toString(const Error& error);

using Errors = std::vector<Error>;

/// A value or the list of everything that is wrong (never empty).
template <class T>
class [[nodiscard]] Result {
public:
    Result(T value) : content_(std::in_place_index<0>, std::move(value)) {}
    Result(Error error) : content_(std::in_place_index<1>, Errors{std::move(error)}) {}
    Result(Errors errors) : content_(std::in_place_index<1>, std::move(errors)) {}

    explicit operator bool() const { return content_.index() == 0; }
    T& operator*() & { return std::get<0>(content_); }
    const T& operator*() const& { return std::get<0>(content_); }
    T&& operator*() && { return std::get<0>(std::move(content_)); }
    T* operator->() { return &std::get<0>(content_); }
    const T* operator->() const { return &std::get<0>(content_); }
    const Errors& errors() const { return std::get<1>(content_); }

private:
    std::variant<T, Errors> content_;
};

/// For functions that return nothing but may fail.
struct Done {};

}  // namespace passung
