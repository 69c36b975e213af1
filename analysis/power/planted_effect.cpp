#include "analysis/power/planted_effect.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <string_view>
#include <utility>

#include "analysis/power/planned_analysis.h"
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

/// "FACTOR:LEVEL" in two parts; the second is empty where there is no colon.
std::pair<std::string, std::string> sides(std::string_view text) {
    const std::size_t colon = std::min(text.find(':'), text.size());
    return {std::string(text.substr(0, colon)), std::string(text.substr(std::min(colon + 1, text.size())))};
}

/// "FACTOR:LEVEL*FACTOR:LEVEL" in two, at the star with levels of the plan on both sides: a star may be part of a
/// level.
std::vector<std::string_view> crossed(std::string_view text, const plan::StudyPlan& plan) {
    const auto isThere = [&](std::string_view side) {
        const auto [name, level] = sides(side);
        const plan::Factor* factor = factorNamed(name, plan);
        return factor != nullptr && hasLevel(*factor, level);
    };
    for (std::size_t star = text.find('*'); star != std::string_view::npos; star = text.find('*', star + 1))
        if (isThere(text.substr(0, star)) && isThere(text.substr(star + 1)))
            return {text.substr(0, star), text.substr(star + 1)};
    return {text};
}

Result<LevelPair> readLevel(std::string_view text, const std::string& against, const plan::StudyPlan& plan) {
    const auto [name, level] = sides(text);
    const plan::Factor* factor = factorNamed(name, plan);
    if (factor == nullptr)
        return wrong("--effect", name,
                     "must be a factor: " + listed(plan.factors, [](const auto& f) { return f.name; }));
    if (factor->kind == plan::FactorKind::Nuisance)
        return wrong("--effect", name, "is a nuisance factor: its levels are assigned, not compared");
    const std::string levels =
        "must be a level of " + name + ": " + listed(factor->levels, [](const auto& l) { return l.label; });
    if (!hasLevel(*factor, level)) return wrong("--effect", level, levels);
    LevelPair pair{name, level, against};
    if (against.empty()) pair.against = factor->levels[factor->levels[0].label == level ? 1 : 0].label;
    if (!hasLevel(*factor, pair.against)) return wrong("--against", against, levels);
    if (pair.against == level) return wrong("--against", against, "must be another level than the effect's");
    return pair;
}

/// Measures that a trial's time-out cuts off.
bool isTime(const std::string& measure) {
    return measure == "time_s" || measure == "completion_time_s" || measure == "trial_time_s";
}

void letTimeOut(double timeout_s, store::AttemptRow& attempt) {
    attempt.outcome = "timeout";
    attempt.measures.erase("completion_time_s");
    for (const auto& [measure, value] :
         {std::pair{"time_s", timeout_s}, {"trial_time_s", timeout_s}, {"finished", 0.0}, {"success", 0.0}})
        if (const auto found = attempt.measures.find(measure); found != attempt.measures.end()) found->second = value;
}

}  // namespace

Result<PlantedEffect> readEffect(const std::string& text, const std::string& against, const std::string& measure,
                                 const plan::StudyPlan& plan) {
    const std::size_t colon = text.find(':'), equals = text.rfind('=');
    if (colon == std::string::npos || equals == std::string::npos || equals < colon)
        return wrong("--effect", text, "must be FACTOR:LEVEL=DELTA");
    PlantedEffect effect;
    effect.measure = measure;
    const auto [middle, spread] = parted(deltaOf(text));
    if (!readMiddle(middle, effect))
        return wrong("--effect", text, "DELTA must be +NUMBER or -NUMBER, added, or xNUMBER > 0, multiplied");
    if (spread && !readSpread(*spread, middle.starts_with('x'), effect))
        return wrong("--effect", text, "SPREAD behind ~ must be a number of at least 0");
    for (const std::string_view where : crossed(std::string_view(text).substr(0, equals), plan)) {
        auto pair = readLevel(where, effect.at.empty() ? against : "", plan);
        if (!pair) return pair.errors();
        effect.at.push_back(*std::move(pair));
    }
    if (effect.at.size() == 2 && effect.at[0].factor == effect.at[1].factor)
        return wrong("--effect", text, "an interaction must be of two factors");
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
    const bool of_time = isTime(effect.measure);
    std::map<std::string, double> timeouts;
    for (const store::ConditionRow& condition : study.conditions)
        if (condition.timeout_s) timeouts[condition.condition] = *condition.timeout_s;
    std::map<std::string, double> deviations;  // from everybody's effect, in standard deviations, by person
    const auto deviationOf = [&](const std::string& code) {
        const auto [found, is_new] = deviations.try_emplace(code, 0.0);
        if (is_new) found->second = Random(streamSeed("", code, "power", "effect", seed)).normal();
        return found->second;
    };
    for (store::AttemptRow& attempt : study.attempts) {
        const auto found = attempt.measures.find(effect.measure);
        if (found == attempt.measures.end() || (of_time && attempt.outcome == "timeout")) continue;
        if (std::all_of(effect.at.begin(), effect.at.end(), [&](const LevelPair& pair) {
                return exporter::levelOf(attempt.levels, pair.factor) == pair.level;
            })) {
            const double own = deviationOf(attempt.participant_id);
            found->second = effect.scale * std::exp(effect.log_scale_spread * own) * found->second + effect.shift +
                            effect.shift_spread * own;
        }
        if (!of_time) continue;
        const auto timeout = timeouts.find(attempt.condition);
        if (timeout != timeouts.end() && found->second > timeout->second) letTimeOut(timeout->second, attempt);
    }
}

}  // namespace passung::power
