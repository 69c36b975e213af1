#include <algorithm>
#include <map>
#include <tuple>

#include "analysis/export/columns.h"
#include "analysis/export/counted_forms.h"
#include "analysis/export/questionnaire_tables.h"
#include "study/plan/participant.h"
#include "study/questionnaire/cronbach_alpha.h"

namespace passung::exporter {
namespace {

using questionnaire::Definition;
using store::QuestionnaireRunRow;

using Answers = std::vector<double>;  // aligned, by item of a scale

/// A form about a scale: nothing where an item is missing.
struct ScaleForm {
    std::string participant;
    Answers answers;
};

/// What is one instrument, asked at one kind of moment: kind of participant, questionnaire, version, moment.
using Asked = std::tuple<std::string, std::string, std::string, std::string>;

/// Which of the occasions of that moment; each person has one form there.
struct RatingMoment {
    std::optional<std::int64_t> block_index, condition_position;
    std::optional<std::string> block, condition;
    std::int64_t number = 1;  // of this person's forms about the same
    friend auto operator<=>(const RatingMoment&, const RatingMoment&) = default;
};

/// The forms of one scale.
struct ScaleForms {
    std::size_t items = 0;
    std::map<RatingMoment, std::vector<ScaleForm>> occasions;
};

/// The aligned answers to a scale's items; nothing if one is missing.
std::optional<Answers> alignedAnswers(const Definition& definition, const questionnaire::Scale& scale,
                                      const QuestionnaireRunRow& run) {
    Answers values;
    for (const std::size_t i : scale.items) {
        const questionnaire::Item& item = definition.items[i];
        const auto found = std::find_if(run.responses.begin(), run.responses.end(),
                                        [&](const auto& response) { return response.item == item.id; });
        if (found == run.responses.end() || !found->value_num) return std::nullopt;
        values.push_back(item.reversed ? item.response.low + item.response.high - *found->value_num
                                       : *found->value_num);
    }
    return values;
}

using AllForms = std::map<std::pair<Asked, std::string>, ScaleForms>;  // by scale

AllForms formsOf(const StudyData& study) {
    AllForms all;
    Definitions definitions;
    std::map<std::tuple<std::string, Asked, RatingMoment>, std::int64_t> numbers;  // of a person's forms about the same
    for (const QuestionnaireRunRow* run : countedRuns(study)) {
        const Definition* definition = definitions.of(*run);
        if (definition == nullptr) continue;
        const Asked asked{run->kind, run->questionnaire, run->version, run->moment};
        RatingMoment occasion{run->block_index, run->condition_position, run->block, run->condition, 0};
        occasion.number = ++numbers[{run->participant_id, asked, occasion}];
        for (const questionnaire::Scale& scale : definition->scales) {
            using questionnaire::Formula;
            const bool averages = scale.formula == Formula::Mean || scale.formula == Formula::Sum;
            if (scale.items.size() < 2 || !averages) continue;
            ScaleForms& forms = all[{asked, scale.name}];
            forms.items = scale.items.size();
            auto& occasion_forms = forms.occasions[occasion];
            if (auto answers = alignedAnswers(*definition, scale, *run))
                occasion_forms.push_back({run->participant_id, *std::move(answers)});
        }
    }
    return all;
}

/// Mean answers of each person over all occasions, and every form's difference from them, of whoever has several.
struct Parted {
    std::vector<Answers> between, within;
    std::size_t persons_within = 0, forms = 0;
};

Parted partedByPerson(const ScaleForms& scale) {
    std::map<std::string, std::vector<Answers>> people;
    for (const auto& [occasion, forms] : scale.occasions)
        for (const ScaleForm& form : forms) people[form.participant].push_back(form.answers);
    Parted parted;
    for (const auto& [code, forms] : people) {
        Answers mean(scale.items, 0.0);
        for (const Answers& form : forms)
            for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += form[i] / static_cast<double>(forms.size());
        parted.forms += forms.size();
        if (forms.size() > 1) {
            ++parted.persons_within;
            for (Answers form : forms) {
                for (std::size_t i = 0; i < mean.size(); ++i) form[i] -= mean[i];
                parted.within.push_back(std::move(form));
            }
        }
        parted.between.push_back(std::move(mean));
    }
    return parted;
}

/// Forms, or what is made of them, over which alpha is taken.
struct Agreement {
    const char* level;
    std::optional<RatingMoment> occasion;
    std::size_t forms, people;
    std::vector<Answers> answers;
};

/// Lists agreement at each occasion, and between and within persons where anybody filled in several forms.
std::vector<Agreement> agreementsOf(const ScaleForms& scale) {
    std::vector<Agreement> all;
    for (const auto& [occasion, forms] : scale.occasions) {
        all.push_back({"occasion", occasion, forms.size(), forms.size(), {}});
        for (const ScaleForm& form : forms) all.back().answers.push_back(form.answers);
    }
    Parted parted = partedByPerson(scale);
    if (parted.within.empty()) return all;
    const std::size_t within = parted.within.size(), people = parted.between.size();
    all.push_back({"between", std::nullopt, parted.forms, people, std::move(parted.between)});
    all.push_back({"within", std::nullopt, within, parted.persons_within, std::move(parted.within)});
    return all;
}

/// How well the items of a scale agree, at one level.
struct ReliabilityRow {
    std::string kind, questionnaire, version, moment;
    std::string scale;
    std::int64_t items;
    Agreement agreement;
};

std::vector<ReliabilityRow> reliabilityRows(const StudyData& study) {
    std::vector<ReliabilityRow> rows;
    for (const auto& [key, scale] : formsOf(study)) {
        const auto& [asked, name] = key;
        const auto& [kind, questionnaire, version, moment] = asked;
        for (Agreement& agreement : agreementsOf(scale))
            rows.push_back({kind, questionnaire, version, moment, name, static_cast<std::int64_t>(scale.items),
                            std::move(agreement)});
    }
    return rows;
}

/// A member of the occasion; NA: the row is about several.
template <class Member>
auto ofOccasion(Member member) {
    return [member](const Agreement& agreement) {
        return agreement.occasion ? cell((*agreement.occasion).*member) : kMissing;
    };
}

ColumnsOf<Agreement> agreementColumns() {
    return {
        {"level",
         "occasion: one form a person, at this occasion; between: each person's mean answers over all occasions of the "
         "moment; within: each form's difference from these means",
         "text",
         &Agreement::level,
         {.levels = {"occasion", "between", "within"}}},
        {"block", "Block of the occasion", "text", ofOccasion(&RatingMoment::block)},
        {"condition", "Condition of the occasion", "text", ofOccasion(&RatingMoment::condition)},
        {"number", "Which of a person's forms about the same occasion, from 1", "integer",
         ofOccasion(&RatingMoment::number)},
        {"n_forms", "Counted forms without a missing item in the scale", "integer",
         [](const Agreement& agreement) { return static_cast<std::int64_t>(agreement.forms); }},
        {"n_participants", "Participants whose forms these are", "integer",
         [](const Agreement& agreement) { return static_cast<std::int64_t>(agreement.people); }}};
}

ColumnsOf<ReliabilityRow> reliabilityColumns() {
    ColumnsOf<ReliabilityRow> columns = {
        {"kind",
         "Real people, pilots or simulated participants",
         "text",
         &ReliabilityRow::kind,
         {.levels = plan::participantKindNames()}},
        {"questionnaire", "Key of the questionnaire", "text", &ReliabilityRow::questionnaire},
        {"version", "Version of its items and texts", "text", &ReliabilityRow::version},
        {"moment", "When it was asked", "text", &ReliabilityRow::moment},
        {"scale", "Name of the scale", "text", &ReliabilityRow::scale}};
    append(columns, agreementColumns(), [](const ReliabilityRow& row) -> const Agreement& { return row.agreement; });
    append(columns, {{"n_items", "Items of the scale", "integer", &ReliabilityRow::items},
                     {"cronbach_alpha",
                      "Internal consistency; forms of one person are never taken for those of several",
                      "number",
                      [](const ReliabilityRow& row) { return questionnaire::cronbachAlpha(row.agreement.answers); },
                      {.formula = "k/(k-1) (1 - sum of the items' variances / variance of their sum), k items, over "
                                  "participants; within: over the differences",
                       .formula_version = 2}}});
    return columns;
}

}  // namespace

Table makeReliability(const StudyData& study) {
    return makeTable("questionnaire_reliability.csv",
                     "One row per scale of at least two items and occasion, and, where forms were repeated, between "
                     "and within persons: how well the items agree.",
                     reliabilityColumns(), reliabilityRows(study));
}

}  // namespace passung::exporter
