#pragma once

#include <array>

#include "study/protocol/key_table.h"

namespace passung::protocol {

// Rows of the key table for questionnaires: their table in a study, their files and the lab's texts for them.
// clang-format off
inline constexpr std::array kQuestionnaireKeys{
    Key{"questionnaire", "file", KeyType::Text, {}, "", "!", "The questionnaire's file, relative to this one."},
    Key{"questionnaire", "texts", KeyType::Text, {}, "", "(none)", "File with the lab's texts for a template, relative to this one."},
    Key{"questionnaire", "language", KeyType::Text, {}, "", "en", "Language in which the questionnaire is shown. In a study with texts in several languages, of which this is one, it is shown in the session's, and has to have them all; a template then needs a table for the texts in each."},
    Key{"questionnaire", "moment", KeyType::Choice, {}, "session_start|before_block|after_block|after_trial|after_condition|session_end", "!", "Moment at which the questionnaire is asked. `after_condition`: after the last trial of each condition in a block."},
    Key{"questionnaire", "block", KeyType::Name, {}, "", "(every main block)", "Block that `moment` is about."},

    Key{"questionnaire_file", "questionnaire", KeyType::Name, {}, "", "!", "Key of the questionnaire: the column in exports, and part of the stream of its item order."},
    Key{"questionnaire_file", "version", KeyType::Text, {}, "", "!", "Version of items and texts; stored with every answer."},
    Key{"questionnaire_file", "scoring_version", KeyType::Integer, {1, 1e6}, "", "1", "Version of the formulas; stored with every score."},
    Key{"questionnaire_file", "languages", KeyType::Texts, {}, "", "!", "Languages in which every text is given."},
    Key{"questionnaire_file", "title", KeyType::Any, {}, "", "!", "Title above the items; a text for each language."},
    Key{"questionnaire_file", "instruction", KeyType::Any, {}, "", "!", "Instruction before the items; a text for each language."},
    Key{"questionnaire_file", "licence", KeyType::Text, {}, "", "!", "Right by which the texts stand here, or that they are the lab's."},
    Key{"questionnaire_file", "citation", KeyType::Text, {}, "", "!", "Source of items and scoring."},
    Key{"questionnaire_file", "order", KeyType::Choice, {}, "fixed|random", "fixed", "Order of the items: as listed, or neighbours with one kind of answer shuffled among themselves for every showing."},
    Key{"questionnaire_file", "slot", KeyType::Boolean, {}, "", "false", "Template: the items have no texts here; the lab supplies them in a file of its own."},
    Key{"questionnaire_file", "polarity_from_texts", KeyType::Boolean, {}, "", "false", "Permission for a template: the lab's file says which items are reversed as printed."},
    Key{"questionnaire_file", "response", KeyType::Tables, {}, "", "!", "Ways of answering."},
    Key{"questionnaire_file", "item", KeyType::Tables, {}, "", "!", "The items in the order of the instrument."},
    Key{"questionnaire_file", "scale", KeyType::Tables, {}, "", "(none)", "Scores that are computed from the answers."},
    Key{"questionnaire_file", "golden", KeyType::Tables, {}, "", "!", "Answers whose scores are known: at least one."},

    Key{"questionnaire_response", "name", KeyType::Name, {}, "", "!", "Name by which items call the way of answering."},
    Key{"questionnaire_response", "kind", KeyType::Choice, {}, "rating|choice|number|text|pair", "!", "A scale with anchors, labelled options, a typed number, a typed text, or which of two items mattered more."},
    Key{"questionnaire_response", "low", KeyType::Number, {}, "", "0", "Least answer of a rating or number."},
    Key{"questionnaire_response", "high", KeyType::Number, {}, "", "0", "Largest answer of a rating or number."},
    Key{"questionnaire_response", "step", KeyType::Number, {.low = 0}, "", "1", "Step between answers, counted from `low`; 0: any value."},
    Key{"questionnaire_response", "low_anchor", KeyType::Any, {}, "", "(none)", "Label of the low end."},
    Key{"questionnaire_response", "high_anchor", KeyType::Any, {}, "", "(none)", "Label of the high end."},
    Key{"questionnaire_response", "options", KeyType::Tables, {}, "", "(none)", "Options of a choice."},

    Key{"questionnaire_option", "value", KeyType::Number, {}, "", "!", "Value of the option that is stored and scored."},
    Key{"questionnaire_option", "text", KeyType::Any, {}, "", "!", "Label of the option."},

    Key{"questionnaire_item", "id", KeyType::Name, {}, "", "!", "Name in exports."},
    Key{"questionnaire_item", "text", KeyType::Any, {}, "", "(none)", "Question; required unless the questionnaire is a template or the item a pair."},
    Key{"questionnaire_item", "response", KeyType::Name, {}, "", "!", "Name of the way of answering."},
    Key{"questionnaire_item", "reversed", KeyType::Boolean, {}, "", "false", "True for an item that is scored as `low` + `high` - answer."},
    Key{"questionnaire_item", "pair", KeyType::Texts, {}, "", "(none)", "Ids of the two items of the kind `pair`."},
    Key{"questionnaire_item", "low_anchor", KeyType::Any, {}, "", "(the response's)", "Label of the low end."},
    Key{"questionnaire_item", "high_anchor", KeyType::Any, {}, "", "(the response's)", "Label of the high end."},
    Key{"questionnaire_item", "felt", KeyType::Choice, {}, "force|time|failure|success|depth|hardness", "(none)", "Quantity of the trials that a simulated participant answers by: more of it, a higher answer as printed. People do not see it."},

    Key{"questionnaire_scale", "name", KeyType::Name, {}, "", "!", "The column in exports."},
    Key{"questionnaire_scale", "label", KeyType::Text, {}, "", "(the name)", "Quantity that the scale measures, for the codebook."},
    Key{"questionnaire_scale", "formula", KeyType::Choice, {}, "mean|sum|pair_weighted|laterality|most_identical|wide_scales", "mean", "Over the items or scales. laterality: 100 (R - L) / (R + L) of choices from 2 (always right) to -2. Two find careless answers: most_identical counts the most frequent answer as given, wide_scales the scales in which aligned answers differ by more than `spread`."},
    Key{"questionnaire_scale", "spread", KeyType::Number, {.low = 0}, "", "(none)", "Difference that wide_scales counts from."},
    Key{"questionnaire_scale", "items", KeyType::Texts, {}, "", "(none)", "Ids of the items that enter."},
    Key{"questionnaire_scale", "scales", KeyType::Texts, {}, "", "(none)", "Names of scales that stand before, in place of items."},
    Key{"questionnaire_scale", "shift", KeyType::Number, {}, "", "0", "Number that is added to every aligned answer."},
    Key{"questionnaire_scale", "factor", KeyType::Number, {}, "", "1", "Factor of the mean or sum."},
    Key{"questionnaire_scale", "max_missing", KeyType::Integer, {.low = 0}, "", "0", "Number of missing items that the mean of the others replaces; with more there is no score."},
    Key{"questionnaire_scale", "classes", KeyType::Tables, {}, "", "(none)", "Named ranges of the score, ascending."},

    Key{"questionnaire_class", "label", KeyType::Text, {}, "", "!", "Name of the class."},
    Key{"questionnaire_class", "from", KeyType::Number, {}, "", "!", "Least score of the class, which ends where the next begins."},

    Key{"questionnaire_golden", "answers", KeyType::Levels, {}, "", "!", "An answer for every item in the order of the items; \"NA\" for a skipped one."},
    Key{"questionnaire_golden", "scores", KeyType::Any, {}, "", "(none)", "Name of a scale = what it must be to four decimals, or \"NA\" for no score."},
    Key{"questionnaire_golden", "classes", KeyType::Any, {}, "", "(none)", "Name of a scale = label of the class that its score is in."},

    Key{"questionnaire_texts", "texts_for", KeyType::Name, {}, "", "!", "Key of the questionnaire that the texts are of."},
    Key{"questionnaire_texts", "language", KeyType::Text, {}, "", "!", "Language of all texts in this file."},
    Key{"questionnaire_texts", "source", KeyType::Text, {}, "", "!", "Origin of the texts, and the right by which the lab uses them."},
    Key{"questionnaire_texts", "low", KeyType::Number, {}, "", "!", "Least answer as printed; must be the questionnaire's."},
    Key{"questionnaire_texts", "high", KeyType::Number, {}, "", "!", "Largest answer as printed; must be the questionnaire's."},
    Key{"questionnaire_texts", "instruction", KeyType::Text, {}, "", "(the questionnaire's)", "Instruction before the items."},
    Key{"questionnaire_texts", "item", KeyType::Tables, {}, "", "!", "Each item once, in the order in which they are shown."},

    Key{"questionnaire_text", "id", KeyType::Name, {}, "", "!", "The item's id in the questionnaire."},
    Key{"questionnaire_text", "text", KeyType::Text, {}, "", "!", "Question."},
    Key{"questionnaire_text", "low_anchor", KeyType::Text, {}, "", "(none)", "Label of the low end."},
    Key{"questionnaire_text", "high_anchor", KeyType::Text, {}, "", "(none)", "Label of the high end."},
    Key{"questionnaire_text", "reversed", KeyType::Boolean, {}, "", "false", "Direction: printed the other way round; only where the questionnaire leaves that to the texts."},
};
// clang-format on

}  // namespace passung::protocol
