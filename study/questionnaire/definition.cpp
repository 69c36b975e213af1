#include "study/questionnaire/definition.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace passung::questionnaire {
namespace {

/// The names at `indices`, each by `name`, with commas.
template <class Named, class Name>
std::string listed(const std::vector<Named>& all, const std::vector<std::size_t>& indices, Name name) {
    std::string text;
    for (const std::size_t i : indices) text += fmt::format("{}{}", text.empty() ? "" : ", ", name(all[i]));
    return text;
}

bool isOnStep(const Response& response, double value) {
    if (!(response.step > 0.0)) return true;
    const double steps = (value - response.low) / response.step;
    return std::abs(steps - std::round(steps)) < 1e-9;
}

std::string nameOf(const Scale& scale) {
    switch (scale.formula) {
        case Formula::Mean:
            return "mean";
        case Formula::Sum:
            return "sum";
        case Formula::PairWeighted:
            return "sum of weight × answer, by the number of pairs; weight: pairs won";
        case Formula::Laterality:
            return "100 (R - L) / (R + L); R, L: marks for right and left, one each for both";
        case Formula::MostIdentical:
            return "number of items with the most frequent answer";
        case Formula::WideScales:
            return fmt::format("number with answers that differ by more than {},", scale.spread);
    }
    return "";
}

}  // namespace

std::optional<std::size_t> itemNamed(const Definition& definition, std::string_view id) {
    for (std::size_t i = 0; i < definition.items.size(); ++i)
        if (definition.items[i].id == id) return i;
    return std::nullopt;
}

std::optional<std::size_t> scaleNamed(const Definition& definition, std::string_view name) {
    for (std::size_t i = 0; i < definition.scales.size(); ++i)
        if (definition.scales[i].name == name) return i;
    return std::nullopt;
}

std::string answerFault(const Item& item, const Answer& answer) {
    if (answer.missing()) return "";
    const Response& response = item.response;
    if (response.kind == AnswerKind::Text) return answer.number ? "must be a text" : "";
    if (!answer.number) return "must be a number";
    const double value = *answer.number;
    switch (response.kind) {
        case AnswerKind::Choice: {
            const bool known = std::any_of(response.options.begin(), response.options.end(),
                                           [&](const Option& option) { return option.value == value; });
            return known ? "" : "is none of the options";
        }
        case AnswerKind::Pair:
            return value == 0.0 || value == 1.0 ? "" : "must be 0 (the first of the pair) or 1 (the second)";
        default:
            break;
    }
    if (!(value >= response.low && value <= response.high))
        return fmt::format("must be from {} to {}", response.low, response.high);
    return isOnStep(response, value) ? "" : fmt::format("must be {} and a multiple of {}", response.low, response.step);
}

std::string formulaText(const Definition& definition, const Scale& scale) {
    std::string text;
    if (scale.factor != 1.0) text += fmt::format("{} × ", scale.factor);
    text += nameOf(scale);
    if (!scale.scales.empty()) {
        const auto name = [](const Scale& other) { return other.name; };
        return text + " of the scales " + listed(definition.scales, scale.scales, name);
    }
    if (scale.shift != 0.0)
        text += fmt::format(" of answer {} {}", scale.shift < 0.0 ? '-' : '+', std::abs(scale.shift));
    const auto name = [](const Item& item) { return item.id + (item.reversed ? " (reversed)" : ""); };
    text += " over " + listed(definition.items, scale.items, name);
    if (scale.max_missing > 0)
        text += fmt::format("; up to {} missing, replaced by the mean of the others", scale.max_missing);
    return text;
}

}  // namespace passung::questionnaire
