#include "study/questionnaire/presented_order.h"

#include "core/base/random.h"

namespace passung::questionnaire {

std::vector<std::size_t> presentedOrder(const Definition& definition, std::uint64_t seed) {
    Random random(seed);
    std::vector<std::size_t> order;
    const auto& items = definition.items;
    while (order.size() < items.size()) {
        std::vector<std::size_t> run;
        const AnswerKind kind = items[order.size()].response.kind;
        for (std::size_t i = order.size(); i < items.size() && items[i].response.kind == kind; ++i) run.push_back(i);
        if (definition.shuffled) shuffle(run, random);
        order.insert(order.end(), run.begin(), run.end());
    }
    return order;
}

}  // namespace passung::questionnaire
