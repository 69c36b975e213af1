#include "analysis/export/samples.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

#include "analysis/export/status_bits.h"
#include "study/measures/period_clock.h"
#include "study/store/samples/sample_codec.h"

namespace passung::exporter {
namespace {

std::string padded(std::int64_t number) {
    std::string digits = std::to_string(number);
    if (digits.size() < 3) digits.insert(0, 3 - digits.size(), '0');
    return digits;
}

/// Appends numbers to a text without a string of their own: a study has tens of millions of them.
class NumberText {
public:
    explicit NumberText(std::string& text) : text_(text) {}

    template <class Number>
    void add(Number value) {
        if constexpr (std::is_floating_point_v<Number>) {
            if (!std::isfinite(value)) {
                text_ += kMissing;
                text_ += ',';
                return;
            }
        }
        // A program that knows doubles only must read the exact value of a float, not the double next to its decimal.
        using Exact = std::conditional_t<std::is_same_v<Number, float>, double, Number>;
        std::array<char, 32> digits;
        const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), Exact{value});
        text_.append(digits.data(), end);
        text_ += ',';
    }
    void endRow() { text_.back() = '\n'; }

private:
    std::string& text_;
};

/// What a row of a samples file is made from.
struct Sample {
    const TickRecord& record;
    std::int64_t period;  // after the attempt's first tick
    const SampleSignals& commanded;
    measures::CueCommands commands;
    bool lit;  // the secondary task's stimulus
};

/// Appends a cell; `offset`: of the value in the record, where the column is a recorded channel.
using AddCell = void (*)(NumberText&, const Sample&, std::size_t offset);

struct SampleColumn {
    Column column;
    AddCell add;
    std::size_t offset = 0;
};

template <class Number>
void addRecorded(NumberText& row, const Sample& sample, std::size_t offset) {
    Number value;
    std::memcpy(&value, reinterpret_cast<const std::byte*>(&sample.record) + offset, sizeof value);
    row.add(value);
}

AddCell adderOf(const store::Channel& channel) {
    if (channel.type == "float64") return addRecorded<double>;
    if (channel.type == "float32") return addRecorded<float>;
    if (channel.type == "uint32") return addRecorded<std::uint32_t>;
    if (channel.type == "int32") return addRecorded<std::int32_t>;
    return addRecorded<std::int64_t>;
}

SampleColumn channelColumn(const store::Channel& channel) {
    const bool integer = channel.type.find("int") != std::string::npos;
    return {{channel.name,
             channel.label,
             channel.unit == "1" ? "" : channel.unit,
             integer ? "integer" : "number",
             channel.name == "status" ? statusBitsText() : "",
             1,
             {}},
            adderOf(channel),
            channel.offset};
}

/// A command; NA where the condition does not have it.
void addCommand(NumberText& row, bool has, double command) {
    row.add(has ? command : std::numeric_limits<double>::quiet_NaN());
}

/// Which files have its columns.
const char* whereExtra(store::Extra extra) {
    switch (extra) {
        case store::Extra::Navigation:
            return "only in files of conditions with effects.clutch, position_scale or drift";
        case store::Extra::Bodies:
            return "only in files of conditions with effects.pick";
        case store::Extra::Effects:
            return "only in files of conditions with effects.record";
    }
    return "";
}

std::vector<SampleColumn> makeSampleColumns(std::span<const store::Extra> extras) {
    std::vector<SampleColumn> columns = {
        {{"tick", "Number of the tick in the attempt, from 0", "", "integer", "", 1, {}},
         [](NumberText& row, const Sample& sample, std::size_t) { row.add(sample.record.tick); }},
        {{"t_s",
          "Time since the attempt's first tick",
          "s",
          "number",
          "0.001 s x sum of periods over the ticks after the first; a tick that was not recorded counts as one period",
          2,
          {}},
         [](NumberText& row, const Sample& sample, std::size_t) {
             row.add(static_cast<double>(sample.period) / 1000.0);
         }}};
    for (const store::Channel& channel : store::tickChannels()) columns.push_back(channelColumn(channel));
    columns.push_back({{"suspended",
                        "1 where the tick's work was cut short and went on in the next one, else 0",
                        "",
                        "integer",
                        "bit 18 of status",
                        1,
                        {}},
                       [](NumberText& row, const Sample& s, std::size_t) {
                           row.add((s.record.status & kSuspended) != 0 ? std::uint32_t{1} : std::uint32_t{0});
                       }});
    const auto add = [&](const char* name, const char* label, const char* formula, AddCell add_cell) {
        columns.push_back({{name, label, "", "number", formula, 1, {}}, add_cell});
    };
    add("cue_visual", "Command of the visual cue, 0 to 1", "min(1, hand_depth_m / feedback.cue_full_depth_mm)",
        [](NumberText& row, const Sample& s, std::size_t) {
            addCommand(row, s.commanded.cues.visual, s.commands.visual);
        });
    add("cue_vibration", "Command of the vibrotactile cue, 0 to 1", "min(1, hand_depth_m / feedback.cue_full_depth_mm)",
        [](NumberText& row, const Sample& s, std::size_t) {
            addCommand(row, s.commanded.cues.vibration, s.commands.vibration);
        });
    add("cue_sound", "Command of the audio cue, 0 to 1",
        "at an impact min(1, speed of the hand / feedback.cue_full_speed_mm_per_s), falling by "
        "exp(-t / feedback.cue_sound_decay_ms)",
        [](NumberText& row, const Sample& s, std::size_t) {
            addCommand(row, s.commanded.cues.sound, s.commands.sound);
        });
    add("cue_masking", "Command of the masking noise: 1", "1 where feedback.masking_noise = true",
        [](NumberText& row, const Sample& s, std::size_t) { addCommand(row, s.commanded.cues.masking, 1.0); });
    add("secondary_stimulus", "Command of the secondary task's stimulus, 0 or 1",
        "1 from onset_s to before off_s of a row of secondary.csv", [](NumberText& row, const Sample& s, std::size_t) {
            addCommand(row, s.commanded.secondary, s.lit ? 1.0 : 0.0);
        });
    for (const store::Extra extra : extras)
        for (const store::Channel& channel : store::extraChannels(extra)) {
            columns.push_back(channelColumn(channel));
            columns.back().column.formula = whereExtra(extra);
        }
    return columns;
}

}  // namespace

std::vector<Column> sampleColumns(std::span<const store::Extra> extras) {
    std::vector<Column> columns;
    for (const SampleColumn& column : makeSampleColumns(extras)) columns.push_back(column.column);
    return columns;
}

namespace {

/// Of another hand than the first: as the scene calls it; hand2 and so on if nothing tells.
std::string handName(const store::AttemptRow& attempt, std::size_t hand) {
    std::vector<std::string> names;
    for (const session::ContactEnergy& pair : attempt.contact_energy)
        if (!pair.hand.empty() && std::find(names.begin(), names.end(), pair.hand) == names.end())
            names.push_back(pair.hand);
    return hand <= names.size() ? names[hand - 1] : "hand" + std::to_string(hand + 1);
}

}  // namespace

std::string samplesFile(const store::AttemptRow& attempt, std::size_t hand) {
    return "samples/" + attempt.participant_id + "_" + std::to_string(attempt.session_ordinal) + "_t" +
           padded(attempt.trial_index) + "_a" + std::to_string(attempt.attempt_no) +
           (hand == 0 ? "" : "_" + handName(attempt, hand)) + ".csv.gz";
}

SampleSignals sampleSignals(const StudyData& study, const store::AttemptRow& attempt) {
    SampleSignals signals{attempt.cues, attempt.stimulus != "none", {}};
    for (const store::DetectionRow& row : study.detections)
        if (row.attempt_id == attempt.attempt_id && row.detection.stimulus)
            signals.stimuli.emplace_back(*row.detection.stimulus, row.detection.off.value_or(*row.detection.stimulus));
    return signals;
}

std::string samplesCsv(std::span<const TickRecord> records, const SampleSignals& commanded) {
    constexpr std::size_t kTypicalRow = 400;
    std::vector<store::Extra> extras;
    for (const store::Extra extra : store::kExtras)
        if (store::haveExtra(extra, records)) extras.push_back(extra);
    std::string text = toCsv(Table{{}, {}, sampleColumns(extras), {}});
    text.reserve(text.size() + records.size() * kTypicalRow);
    NumberText row(text);
    measures::PeriodClock clock;
    measures::CueSignals signals(commanded.cues);
    const std::vector<SampleColumn> columns = makeSampleColumns(extras);
    std::size_t shown = 0;  // stimuli that are over
    for (const TickRecord& record : records) {
        const std::int64_t period = clock.at(record);
        while (shown < commanded.stimuli.size() && commanded.stimuli[shown].second <= period) ++shown;
        const bool lit = shown < commanded.stimuli.size() && commanded.stimuli[shown].first <= period;
        const Sample sample{record, period, commanded, signals.at(record), lit};
        for (const SampleColumn& column : columns) column.add(row, sample, column.offset);
        row.endRow();
    }
    return text;
}

}  // namespace passung::exporter
