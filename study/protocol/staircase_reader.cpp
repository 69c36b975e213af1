#include "study/protocol/staircase_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "study/protocol/table_reader.h"

namespace passung::protocol {
namespace {

constexpr std::size_t kMaxLevels = 200;

std::string staircasePath(const Node& table) {
    const Node* name = table.find("name");
    const bool named = name != nullptr && name->kind == Node::Kind::Text && isName(name->text);
    return named ? "staircase." + name->text : "staircase";
}

/// Reads one table.
class StaircaseReader {
public:
    StaircaseReader(const Node& table, Errors& errors)
        : table_(table),
          path_(staircasePath(table)),
          before_(errors.size()),
          read_(table, {"staircase"}, path_, errors),
          errors_(errors) {}

    const TableReader& table() const { return read_; }

    StaircaseContent content() {
        plan::Staircase& staircase = content_.staircase;
        staircase.name = read_.text("name");
        staircase.unit = read_.text("unit");
        staircase.key = read_.text("key");
        if (const Node* key = read_.node("key")) content_.key_place = key->place;
        if (const Node* measure = read_.node("measure")) content_.measure_place = measure->place;
        if (errors_.size() > before_) return content_;
        readLevels();
        if (errors_.size() > before_) return content_;
        readRule();
        readTracks();
        if (errors_.size() > before_) return content_;
        for (const plan::StaircaseTrack& track : staircase.tracks) {
            const auto faults = track.params.validate();
            if (!faults.empty()) return read_.fail(keyOf(faults.front()), faults.front()), content_;
        }
        if (!psi()) checkSteps();
        readCatches();
        return content_;
    }

private:
    /// Whether it is sound or not.
    bool isWritten(const char* key) const { return table_.find(key) != nullptr; }
    bool psi() const { return read_.text("rule") == "psi"; }

    /// The key that a sentence of AdaptiveParams::validate() is about: it begins with its name.
    static const char* keyOf(const std::string& fault) {
        for (const char* key : {"sigma_low", "guess", "start"})
            if (fault.starts_with(key)) return key == std::string_view("start") ? "tracks" : key;
        return "levels";
    }

    void readLevels() {
        const bool listed = isWritten("levels");
        if (listed && !read_.has("levels")) return;
        for (const char* key : {"low", "high", "count"}) {
            if (listed && read_.has(key)) return read_.fail(key, "is for a staircase without levels");
            if (!listed && !isWritten(key)) return read_.fail(key, "required without levels");
            if (!listed && !read_.has(key)) return;
        }
        if (listed)
            content_.values = read_.items("levels");
        else
            spreadLevels();
        std::vector<double>& levels = content_.staircase.levels;
        for (const Node& value : content_.values) {
            const bool number = value.kind == Node::Kind::Integer || value.kind == Node::Kind::Number;
            if (!number || !std::isfinite(value.number)) return refuse(value, "must be a finite number");
            if (!levels.empty() && !(value.number > levels.back()))
                return refuse(value, fmt::format("must be above {:.6g}: levels ascend", levels.back()));
            if (read_.boolean("logarithmic") && !(value.number > 0.0))
                return refuse(value, "must be > 0 on a logarithmic axis");
            levels.push_back(value.number);
        }
        if (levels.size() < 2 || levels.size() > kMaxLevels)
            read_.fail("levels", fmt::format("must be from 2 to {}", kMaxLevels));
    }

    void refuse(const Node& value, std::string message) {
        errors_.push_back(errorAt(value.place, read_.pathOf("levels"), valueText(value), std::move(message)));
    }

    void spreadLevels() {
        const Node& low = *read_.node("low");
        const Node& high = *read_.node("high");
        const bool logarithmic = read_.boolean("logarithmic");
        if (!(low.number < high.number)) return read_.fail("high", "must be above low");
        if (logarithmic && !(low.number > 0.0)) return read_.fail("low", "must be > 0 on a logarithmic axis");
        const auto count = static_cast<std::size_t>(read_.integer("count"));
        for (std::size_t i = 0; i < count; ++i) {
            const double share = static_cast<double>(i) / static_cast<double>(count - 1);
            Node value = i == 0 ? low : high;
            const bool inner = i > 0 && i + 1 < count;
            if (inner) value.kind = Node::Kind::Number;
            if (inner)
                value.number = logarithmic ? low.number * std::pow(high.number / low.number, share)
                                           : low.number + (high.number - low.number) * share;
            content_.values.push_back(std::move(value));
        }
    }

    /// The key is there if and only if the rule has it.
    void allow(const char* key, bool wanted) {
        if (read_.has(key) && !wanted) read_.fail(key, fmt::format("is not for the rule {}", read_.text("rule")));
    }

    void require(const char* key) {
        if (!isWritten(key)) read_.fail(key, fmt::format("required by the rule {}", read_.text("rule")));
    }

    void readRule() {
        for (const char* key : {"step_down", "step_up", "late_factor", "late_after", "max_reversals", "skip_reversals"})
            allow(key, !psi());
        for (const char* key : {"guess", "lapse", "sigma_low", "sigma_high"}) allow(key, psi());
        for (const char* key : {"guess", "sigma_low", "sigma_high"})
            if (psi()) require(key);
        if (!psi()) require("step_down");
        params_.method = psi() ? design::AdaptiveMethod::Psi : design::AdaptiveMethod::UpDown;
        if (!psi()) params_.down_after = read_.text("rule")[5] - '0';
        params_.levels = content_.staircase.levels;
        params_.low = params_.start = params_.levels.front();
        params_.high = params_.levels.back();
        params_.logarithmic = read_.boolean("logarithmic");
        params_.step_down = read_.number("step_down");
        params_.step_up = read_.numberOr("step_up", params_.step_down);
        params_.late_factor = read_.number("late_factor");
        params_.late_after = static_cast<int>(read_.integer("late_after"));
        params_.max_trials = static_cast<int>(read_.integer("max_trials"));
        params_.max_reversals = static_cast<int>(read_.integer("max_reversals"));
        params_.skip_reversals = static_cast<int>(read_.integer("skip_reversals"));
        params_.guess = read_.number("guess");
        params_.lapse = read_.number("lapse");
        params_.sigma_low = read_.number("sigma_low");
        params_.sigma_high = read_.number("sigma_high");
    }

    void readTracks() {
        std::set<std::string> names;
        for (const Node& item : read_.items("tracks")) {
            const TableReader track(item, {"staircase_track"}, read_.pathOf("tracks"), errors_);
            design::AdaptiveParams params = params_;
            if (psi() && track.has("start")) track.fail("start", "is not for the rule psi");
            if (!psi() && !track.has("start"))
                track.fail("start", fmt::format("required by the rule {}", read_.text("rule")));
            params.start = track.numberOr("start", params.low);
            if (!(params.start >= params.low && params.start <= params.high))
                track.fail("start",
                           fmt::format("must be from {:.6g} to {:.6g}, the levels' ends", params.low, params.high));
            if (track.has("name") && !names.insert(track.text("name")).second)
                track.fail("name", "two tracks have this name");
            content_.staircase.tracks.push_back({track.text("name"), params});
        }
        if (read_.has("tracks") && names.empty()) read_.fail("tracks", "needs at least one track");
    }

    /// A step that leads from a level back to the same one would never move.
    void checkSteps() {
        const auto axis = [&](double level) { return params_.logarithmic ? std::log10(level) : level; };
        const auto& levels = params_.levels;
        for (std::size_t i = 1; i < levels.size(); ++i) {
            const double gap = axis(levels[i]) - axis(levels[i - 1]);
            for (const char* key : {"step_down", "step_up"}) {
                const double step = key == std::string_view("step_up") ? params_.step_up : params_.step_down;
                if (step * params_.late_factor > 0.5 * gap) continue;
                return read_.fail(read_.has(key) ? key : "step_down",
                                  fmt::format("leads nowhere from level {:.6g}: the next one is {:.6g}, {:.6g}{} away, "
                                              "and a late step is {:.6g}",
                                              levels[i - 1], levels[i], gap, params_.logarithmic ? " decades" : "",
                                              step * params_.late_factor));
            }
        }
    }

    void readCatches() {
        plan::Staircase& staircase = content_.staircase;
        const double share = read_.number("catch_share");
        if (share > 0.0 && !isWritten("catch_level")) return read_.fail("catch_level", "required with catch_share");
        if (!read_.has("catch_level") || (isWritten("catch_share") && !(share > 0.0))) return;
        if (!isWritten("catch_share")) return read_.fail("catch_level", "is for a staircase with catch_share");
        staircase.catch_level = read_.number("catch_level");
        if (std::find(staircase.levels.begin(), staircase.levels.end(), staircase.catch_level) ==
            staircase.levels.end())
            return read_.fail("catch_level", "must be one of the levels");
        const double others = static_cast<double>(staircase.trials());
        staircase.catch_trials = static_cast<std::size_t>(std::llround(others * share / (1.0 - share)));
        if (staircase.catch_trials == 0)
            read_.fail("catch_share", fmt::format("makes not one of {} trials a catch trial", others));
    }

    const Node& table_;
    std::string path_;
    std::size_t before_;  // errors of other tables
    TableReader read_;
    Errors& errors_;
    StaircaseContent content_;
    design::AdaptiveParams params_;
};

void readResponse(const TableReader& read, std::span<const std::string> known_measures, plan::Staircase& staircase) {
    const std::vector<std::string_view> known(known_measures.begin(), known_measures.end());
    staircase.measure = read.text("measure");
    if (read.has("measure") && std::find(known.begin(), known.end(), staircase.measure) == known.end()) {
        const auto close = closestWord(staircase.measure, known);
        read.fail("measure", close ? fmt::format("unknown measure; did you mean \"{}\"?", *close)
                                   : fmt::format("unknown measure; known measures: {}", fmt::join(known, ", ")));
    }
    if (read.has("above") && read.has("below")) return read.fail("below", "stands beside above: one of them decides");
    if (!read.has("above") && !read.has("below")) return read.fail("above", "required, or below");
    staircase.above = read.has("above");
    staircase.threshold = read.number(staircase.above ? "above" : "below");
}

/// The block that it governs, told so; what else the block says of its trials would contradict it.
void takeBlock(const TableReader& read, const std::vector<Node>& block_tables, std::vector<plan::Block>& blocks,
               plan::Staircase& staircase, Errors& errors) {
    const std::string name = read.text("block");
    const auto found =
        std::find_if(blocks.begin(), blocks.end(), [&](const plan::Block& block) { return block.name == name; });
    if (!read.has("block")) return;
    if (found == blocks.end()) {
        std::vector<std::string_view> names;
        for (const plan::Block& block : blocks) names.push_back(block.name);
        return read.fail("block", fmt::format("no block has this name; blocks: {}", fmt::join(names, ", ")));
    }
    if (found->phase != plan::Phase::Main) return read.fail("block", "must be a main block");
    if (found->adaptive) return read.fail("block", "has a staircase already");
    staircase.block = static_cast<std::size_t>(found - blocks.begin());
    found->adaptive = true;
    for (const char* key : {"repetitions", "trials", "catch_trials"})
        if (const Node* value = block_tables[staircase.block].find(key))
            errors.push_back(errorAt(value->place, fmt::format("block.{}.{}", name, key), valueText(*value),
                                     fmt::format("is decided by staircase {}", staircase.name)));
}

/// Whoever else changes the key would undo it.
void checkOverlaps(const StaircaseContent& content, const std::vector<Node>& block_tables,
                   const std::vector<FactorContent>& factors, Errors& errors) {
    const auto report = [&](std::string by) {
        errors.push_back(errorAt(content.key_place, "staircase." + content.staircase.name + ".key",
                                 content.staircase.key, fmt::format("is also changed by {}", by)));
    };
    for (const FactorContent& factor : factors)
        if (std::any_of(factor.overrides.begin(), factor.overrides.end(), [&](const auto& level) {
                return std::any_of(level.begin(), level.end(),
                                   [&](const Override& change) { return overlap(change.path, content.staircase.key); });
            }))
            report("factor " + factor.factor.name);
    if (content.staircase.block >= block_tables.size()) return;
    const Node* set = block_tables[content.staircase.block].find("set");
    if (set == nullptr) return;
    for (const Entry& entry : set->entries)
        if (overlap(entry.key, content.staircase.key)) report("the block's set");
}

}  // namespace

std::vector<StaircaseContent> readStaircases(const std::vector<Node>& tables, const std::vector<Node>& block_tables,
                                             const std::vector<FactorContent>& factors,
                                             std::span<const std::string> known_measures,
                                             std::vector<plan::Block>& blocks, Errors& errors) {
    std::vector<StaircaseContent> contents;
    std::set<std::string> names;
    for (const Node& table : tables) {
        const std::size_t before = errors.size();
        StaircaseReader reader(table, errors);
        StaircaseContent content = reader.content();
        const TableReader& read = reader.table();
        if (read.has("name") && !names.insert(content.staircase.name).second)
            read.fail("name", "two staircases have this name");
        readResponse(read, known_measures, content.staircase);
        takeBlock(read, block_tables, blocks, content.staircase, errors);
        if (errors.size() > before) continue;
        checkOverlaps(content, block_tables, factors, errors);
        blocks[content.staircase.block].repetitions = static_cast<int>(content.staircase.trials());
        contents.push_back(std::move(content));
    }
    return contents;
}

}  // namespace passung::protocol
