#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace passung::questionnaire {

enum class AnswerKind {
    Rating,  // a point on a scale with two anchors
    Choice,  // one of labelled options
    Number,  // typed, e.g. an age
    Text,    // typed; never scored
    Pair,    // which of two other items mattered more: 0 the first, 1 the second
};

struct Option {
    double value = 0.0;
    std::string label;
};

/// How an item is answered.
struct Response {
    AnswerKind kind = AnswerKind::Rating;
    double low = 0.0, high = 0.0;  // Rating, Number: both admissible
    double step = 1.0;             // from low; 0: any value between
    std::string low_anchor, high_anchor;
    std::vector<Option> options;  // Choice
};

/// What of the trials a simulated participant answers an item by: more of it, a higher answer as printed. People answer
/// by what they please.
enum class Felt { Force, Time, Failure, Success, Depth, Hardness };

struct Item {
    std::string id;
    std::string text;  // empty in a template that has not got the lab's texts
    Response response;
    bool reversed = false;                   // scored as low + high - answer
    std::pair<std::size_t, std::size_t> of;  // Pair: the two items
    std::optional<Felt> felt;
};

/// Mean and Sum: factor · (mean or sum of answer + shift over the items; of the values over the scales).
/// PairWeighted: sum of weight · answer over the items, by the number of pairs; an item's weight is how many pairs it
/// won.
/// Laterality (Oldfield 1971): 100 (R - L) / (R + L) of marks for right and left: an answer of 2 or 1 gives so many to
/// the right, -1 or -2 to the left, 0 one to each.
/// Two that tell careless answers: MostIdentical: how many items have the most frequent answer, as given;
/// WideScales: in how many of the scales aligned answers differ by more than `spread`.
enum class Formula { Mean, Sum, PairWeighted, Laterality, MostIdentical, WideScales };

/// Everything from `from` up to the next class.
struct Class {
    std::string label;
    double from = 0.0;
};

/// Formula over items, or over scales that stand before it.
struct Scale {
    std::string name;
    std::string label;
    Formula formula = Formula::Mean;
    std::vector<std::size_t> items;
    std::vector<std::size_t> scales;
    double shift = 0.0;
    double factor = 1.0;
    double spread = 0.0;          // WideScales
    std::size_t max_missing = 0;  // so many missing items are replaced by the mean of the others; with more: no score
    std::vector<Class> classes;   // ascending; may be none
};

/// Neither a number nor a text: the item was skipped.
struct Answer {
    std::optional<double> number;
    std::string text;
    bool missing() const { return !number && text.empty(); }
};

/// Answers of all items and what every named scale must be, to four decimals.
struct Golden {
    struct Expected {
        std::size_t scale = 0;
        std::optional<double> value;  // empty: no score
        std::string class_label;      // empty: not claimed
    };
    std::vector<Answer> answers;
    std::vector<Expected> scores;
};

/// An instrument in one language.
struct Definition {
    std::string key;      // "nasa_tlx_raw"
    std::string version;  // of texts and items
    int scoring_version = 1;
    std::string language;
    std::string title;
    std::string instruction;
    std::string licence;   // under which the texts stand
    std::string citation;  // where instrument and scoring are from
    bool shuffled = false;
    bool is_template = false;          // the texts are the lab's
    bool polarity_from_texts = false;  // of a template: the lab's texts say which items are reversed
    std::vector<Item> items;
    std::vector<Scale> scales;
    std::vector<Golden> golden;
};

/// The index of the item or scale with this name.
std::optional<std::size_t> itemNamed(const Definition& definition, std::string_view id);
std::optional<std::size_t> scaleNamed(const Definition& definition, std::string_view name);

/// What is wrong with an answer to an item; empty if nothing. A skipped item is no fault.
std::string answerFault(const Item& item, const Answer& answer);

/// How a scale is computed, in words.
std::string formulaText(const Definition& definition, const Scale& scale);

}  // namespace passung::questionnaire
