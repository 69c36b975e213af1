#include "analysis/power/planted_effect.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <string_view>
#include <utility>

#include "core/base/random.h"

namespace passung::power {
namespace {

Error wrong(const char* key, const std::string& value, const std::string& requirement) {
    return {.message = requirement, .key = key, .value = value};
}

std::optional<double> numberIn(std::string_view text) {
    if (text.starts_with('+')) text.remove_prefix(1);
    double number = 0.0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (problem != std::errc() || end != text.data() + text.size() || !std::isfinite(number)) return std::nullopt;
    return number;
}

template <class Items, class Name>
std::string listed(const Items& items, Name name) {
    std::string text;
    for (const auto& item : items) text += (text.empty() ? "" : ", ") + name(item);
    return text;
}

bool hasLevel(const plan::Factor& factor, const std::string& label) {
    return std::any_of(factor.levels.begin(), factor.levels.end(),
                       [&](const plan::Level& level) { return level.label == label; });
}

/// Sets scale or shift.
bool readMiddle(std::string_view text, PlantedEffect& effect) {
    if (text.starts_with('x')) {
        const auto scale = numberIn(text.substr(1));
        effect.scale = scale.value_or(0.0);
        return scale && *scale > 0.0;
    }
    const auto shift = numberIn(text);
    effect.shift = shift.value_or(0.0);
    return shift && (text.starts_with('+') || text.starts_with('-'));
}

std::string_view deltaOf(std::string_view text) { return text.substr(text.rfind('=') + 1); }

/// DELTA, and of "DELTA~SPREAD" what stands behind the mark.
std::pair<std::string_view, std::optional<std::string_view>> parted(std::string_view delta) {
    const std::size_t mark = delta.find('~');
    if (mark == std::string_view::npos) return {delta, std::nullopt};
    return {delta.substr(0, mark), delta.substr(mark + 1)};
}

bool readSpread(std::string_view text, bool multiplied, PlantedEffect& effect) {
    const auto spread = numberIn(text);
    (multiplied ? effect.log_scale_spread : effect.shift_spread) = spread.value_or(0.0);
    return spread && *spread >= 0.0;
}

}  // namespace

Result<PlantedEffect> readEffect(const std::string& text, const std::string& against, const std::string& measure,
                                 const plan::StudyPlan& plan) {
    const std::size_t colon = text.find(':'), equals = text.rfind('=');
    if (colon == std::string::npos || equals == std::string::npos || equals < colon)
        return wrong("--effect", text, "must be FACTOR:LEVEL=DELTA");
    PlantedEffect effect;
    effect.factor = text.substr(0, colon);
    effect.level = text.substr(colon + 1, equals - colon - 1);
    effect.measure = measure;
    const auto [middle, spread] = parted(deltaOf(text));
    if (!readMiddle(middle, effect))
        return wrong("--effect", text, "DELTA must be +NUMBER or -NUMBER, added, or xNUMBER > 0, multiplied");
    if (spread && !readSpread(*spread, middle.starts_with('x'), effect))
        return wrong("--effect", text, "SPREAD behind ~ must be a number of at least 0");
    const auto factor = std::find_if(plan.factors.begin(), plan.factors.end(),
                                     [&](const plan::Factor& f) { return f.name == effect.factor; });
    if (factor == plan.factors.end())
        return wrong("--effect", effect.factor,
                     "must be a factor: " + listed(plan.factors, [](const auto& f) { return f.name; }));
    if (factor->kind == plan::FactorKind::Nuisance)
        return wrong("--effect", effect.factor, "is a nuisance factor: its levels are assigned, not compared");
    const std::string levels = "must be a level of " + factor->name + ": " +
                               listed(factor->levels, [](const auto& level) { return level.label; });
    if (!hasLevel(*factor, effect.level)) return wrong("--effect", effect.level, levels);
    effect.against = against;
    if (against.empty()) effect.against = factor->levels[factor->levels[0].label == effect.level ? 1 : 0].label;
    if (!hasLevel(*factor, effect.against)) return wrong("--against", against, levels);
    if (effect.against == effect.level) return wrong("--against", against, "must be another level than the effect's");
    if (std::find(plan.measures.begin(), plan.measures.end(), measure) == plan.measures.end())
        return wrong("--measure", measure,
                     "must be a measure of the protocol: " + listed(plan.measures, [](const auto& m) { return m; }));
    return effect;
}

std::optional<double> addedBy(const std::string& text) {
    const std::string_view middle = parted(deltaOf(text)).first;
    return middle.starts_with('x') ? std::nullopt : numberIn(middle);
}

bool saysSpread(const std::string& text) { return parted(deltaOf(text)).second.has_value(); }

void plant(const PlantedEffect& effect, std::uint64_t seed, exporter::StudyData& study) {
    std::map<std::string, double> deviations;  // from everybody's effect, in standard deviations, by person
    const auto deviationOf = [&](const std::string& code) {
        const auto [found, is_new] = deviations.try_emplace(code, 0.0);
        if (is_new) found->second = Random(streamSeed("", code, "power", "effect", seed)).normal();
        return found->second;
    };
    for (store::AttemptRow& attempt : study.attempts) {
        if (exporter::levelOf(attempt.levels, effect.factor) != effect.level) continue;
        const auto found = attempt.measures.find(effect.measure);
        if (found == attempt.measures.end()) continue;
        const double own = deviationOf(attempt.participant_id);
        found->second = effect.scale * std::exp(effect.log_scale_spread * own) * found->second + effect.shift +
                        effect.shift_spread * own;
    }
}

}  // namespace passung::power
