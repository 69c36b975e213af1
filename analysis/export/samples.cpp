#include "analysis/export/samples.h"

#include <array>
#include <charconv>
#include <cmath>
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
class RowText {
public:
    explicit RowText(std::string& text) : text_(text) {}

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
    template <class Number, std::size_t count>
    void add(const std::array<Number, count>& values) {
        for (const Number value : values) add(value);
    }
    void endRow() { text_.back() = '\n'; }

private:
    std::string& text_;
};

}  // namespace

std::vector<Column> sampleColumns() {
    std::vector<Column> columns = {
        {"tick", "Number of the tick in the attempt, from 0", "", "integer", "", 1, {}},
        {"t_s",
         "Time since the attempt's first tick",
         "s",
         "number",
         "0.001 s x sum of periods over the ticks after the first; a tick that was not recorded counts as one period",
         2,
         {}}};
    for (const store::Channel& channel : store::tickChannels()) {
        const bool integer = channel.type == "uint32";
        columns.push_back({channel.name,
                           channel.label,
                           channel.unit == "1" ? "" : channel.unit,
                           integer ? "integer" : "number",
                           channel.name == "status" ? statusBitsText() : "",
                           1,
                           {}});
    }
    const auto add = [&](const char* name, const char* label, const char* formula) {
        columns.push_back({name, label, "", "number", formula, 1, {}});
    };
    add("cue_visual", "Command of the visual cue, 0 to 1", "min(1, hand_depth_m / feedback.cue_full_depth_mm)");
    add("cue_vibration", "Command of the vibrotactile cue, 0 to 1",
        "min(1, hand_depth_m / feedback.cue_full_depth_mm)");
    add("cue_sound", "Command of the audio cue, 0 to 1",
        "at an impact min(1, speed of the hand / feedback.cue_full_speed_mm_per_s), falling by "
        "exp(-t / feedback.cue_sound_decay_ms)");
    add("cue_masking", "Command of the masking noise: 1", "1 where feedback.masking_noise = true");
    add("secondary_stimulus", "Command of the secondary task's stimulus, 0 or 1",
        "1 from onset_s to before off_s of a row of secondary.csv");
    return columns;
}

std::string samplesFile(const store::AttemptRow& attempt) {
    return "samples/" + attempt.participant_id + "_" + std::to_string(attempt.session_ordinal) + "_t" +
           padded(attempt.trial_index) + "_a" + std::to_string(attempt.attempt_no) + ".csv.gz";
}

SampleSignals sampleSignals(const StudyData& study, const store::AttemptRow& attempt) {
    SampleSignals signals{attempt.cues, attempt.stimulus != "none", {}};
    for (const store::DetectionRow& row : study.detections)
        if (row.attempt_id == attempt.attempt_id && row.detection.stimulus)
            signals.stimuli.emplace_back(*row.detection.stimulus, row.detection.off.value_or(*row.detection.stimulus));
    return signals;
}

std::string samplesCsv(std::span<const TickRecord> records, const SampleSignals& commanded) {
    const measures::CueSettings& cues = commanded.cues;
    constexpr std::size_t kTypicalRow = 400;
    std::string text = toCsv(Table{{}, {}, sampleColumns(), {}});
    text.reserve(text.size() + records.size() * kTypicalRow);
    RowText row(text);
    measures::PeriodClock clock;
    measures::CueSignals signals(cues);
    const auto orMissing = [](bool has, double command) {
        return has ? command : std::numeric_limits<double>::quiet_NaN();
    };
    std::size_t shown = 0;  // stimuli that are over
    for (const TickRecord& r : records) {
        const std::int64_t time = clock.at(r);
        row.add(r.tick);
        row.add(static_cast<double>(time) / 1000.0);
        row.add(r.device_position_m);
        row.add(r.device_quaternion);
        row.add(r.input_flags);
        row.add(r.periods);
        row.add(r.hand_position_m);
        row.add(r.hand_quaternion);
        row.add(r.proxy_position_m);
        row.add(r.proxy_quaternion);
        row.add(r.force_N);
        row.add(r.torque_Nm);
        row.add(r.hand_depth_m);
        row.add(r.proxy_depth_m);
        row.add(r.energy_J);
        row.add(r.quality);
        row.add(r.status);
        row.add(r.contacts);
        row.add(r.iterations);
        row.add(r.nodes_visited);
        row.add(r.hand_energy_J);
        const measures::CueCommands commands = signals.at(r);
        row.add(orMissing(cues.visual, commands.visual));
        row.add(orMissing(cues.vibration, commands.vibration));
        row.add(orMissing(cues.sound, commands.sound));
        row.add(orMissing(cues.masking, 1.0));
        while (shown < commanded.stimuli.size() && commanded.stimuli[shown].second <= time) ++shown;
        const bool lit = shown < commanded.stimuli.size() && commanded.stimuli[shown].first <= time;
        row.add(orMissing(commanded.secondary, lit ? 1.0 : 0.0));
        row.endRow();
    }
    return text;
}

}  // namespace passung::exporter
