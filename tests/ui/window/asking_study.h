#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "tests/ui/cli/small_study.h"

namespace passung::test {

/// A questionnaire with an item of every kind, in two languages.
inline constexpr const char* kEveryKind = R"(questionnaire = "every_kind"
version = "1.0"
languages = ["en", "de"]
licence = "ours"
citation = "ours"
title = { en = "About your work", de = "Zu Ihrer Arbeit" }
instruction = { en = "Please answer for the work that you have just done.", de = "Bitte antworten Sie für die gerade getane Arbeit." }

[[response]]
name = "agreement"
kind = "rating"
low = 1
high = 7
low_anchor = { en = "Strongly disagree", de = "Stimme gar nicht zu" }
high_anchor = { en = "Strongly agree", de = "Stimme voll zu" }

[[response]]
name = "ticks"
kind = "rating"
low = 0
high = 100
step = 5
low_anchor = { en = "Very low", de = "Sehr gering" }
high_anchor = { en = "Very high", de = "Sehr hoch" }

[[response]]
name = "line"
kind = "rating"
low = 0
high = 10
step = 0
low_anchor = { en = "No pain", de = "Kein Schmerz" }
high_anchor = { en = "Worst pain", de = "Schlimmster Schmerz" }

[[response]]
name = "words"
kind = "rating"
low = -3
high = 3

[[response]]
name = "side"
kind = "choice"
options = [{ value = 7, text = { en = "Left", de = "Links" } }, { value = 9, text = { en = "Right", de = "Rechts" } }]

[[response]]
name = "years"
kind = "number"
low = 16
high = 120

[[response]]
name = "text"
kind = "text"

[[response]]
name = "more"
kind = "pair"

[[item]]
id = "likert"
response = "agreement"
text = { en = "The surfaces felt hard.", de = "Die Oberflächen fühlten sich hart an." }

[[item]]
id = "load"
response = "ticks"
text = { en = "How mentally demanding was the task?", de = "Wie geistig anstrengend war die Aufgabe?" }

[[item]]
id = "pain"
response = "line"
text = { en = "How much does your arm hurt?", de = "Wie sehr schmerzt Ihr Arm?" }

[[item]]
id = "differential"
response = "words"
text = { en = "The device is", de = "Das Gerät ist" }
low_anchor = { en = "annoying", de = "lästig" }
high_anchor = { en = "enjoyable", de = "erfreulich" }

[[item]]
id = "hand"
response = "side"
text = { en = "With which hand did you work?", de = "Mit welcher Hand haben Sie gearbeitet?" }

[[item]]
id = "age"
response = "years"
text = { en = "How old are you, in years?", de = "Wie alt sind Sie, in Jahren?" }

[[item]]
id = "remarks"
response = "text"
text = { en = "Anything else?", de = "Sonst noch etwas?" }

[[item]]
id = "weight"
response = "more"
pair = ["likert", "load"]

[[scale]]
name = "load"
label = "Load"
items = ["load"]

[[golden]]
answers = [1, 5, 0, 0, 7, 20, "NA", 0]
scores = { load = 5 }
)";

inline constexpr const char* kAsks = R"(
[[consent]]
clause = "data_use"
text = { en = "Your answers and movements are stored under a code, not your name, and analysed together with those of others. May we use them for this study?", de = "Ihre Antworten und Bewegungen werden unter einem Code ohne Ihren Namen gespeichert und gemeinsam mit denen anderer ausgewertet. Dürfen wir sie für diese Studie verwenden?" }

[[consent]]
clause = "photos"
required = false
text = { en = "May we take photos of your hands?", de = "Dürfen wir Ihre Hände fotografieren?" }

[text.en]
welcome = "You will put a peg into a plate. Hold it at its start until the trial begins, then put it in as far as it goes."
thanks = "Thank you. Please stay seated."

[text.de]
welcome = "Sie stecken einen Zapfen in eine Platte. Halten Sie ihn am Anfang ruhig, bis der Durchgang beginnt, und stecken Sie ihn dann ganz hinein."
thanks = "Danke. Bitte bleiben Sie sitzen."

[[instruction]]
moment = "session_start"
text = "welcome"
picture = "task.png"

[[instruction]]
moment = "session_end"
text = "thanks"

[[questionnaire]]
file = "every_kind.toml"
moment = "session_start"
)";

inline void writeFile(const std::string& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
}

/// A study in `folder` that asks for consent, shows instructions with a picture and asks every kind of item before its
/// first trial. `more` is added to its text. Returns its path.
inline std::string writeAskingStudy(const std::string& folder, const std::string& more = "") {
    std::filesystem::create_directories(folder);
    std::filesystem::copy_file(PASSUNG_SOURCE_DIR "/protocols/real_vs_virtual/pictures/task.png", folder + "/task.png",
                               std::filesystem::copy_options::overwrite_existing);
    writeFile(folder + "/every_kind.toml", kEveryKind);
    writeFile(folder + "/study.toml", smallStudy("asking") + kAsks + more);
    return folder + "/study.toml";
}

}  // namespace passung::test
