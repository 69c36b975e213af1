#include "study/session/instruction_course.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/base/json.h"

namespace passung::session {
namespace {

constexpr std::int64_t kEnd = -1;

}  // namespace

InstructionCourse::InstructionCourse(const plan::StudyPlan& plan, std::string language, bool timing_measured,
                                     InstructionReader* reader, TrialSink& sink)
    : plan_(plan), language_(std::move(language)), timing_measured_(timing_measured), reader_(reader), sink_(sink) {}

bool InstructionCourse::show(const design::PlannedTrial* next, std::int64_t session_ns) {
    const std::int64_t block = next != nullptr ? next->block_index : kEnd;
    if (open_for_ != block) {
        open_for_ = block;
        read_ = 0;
    }
    const auto pages = due(next);
    for (; read_ < pages.size(); ++read_) {
        std::optional<PageRead> read;
        if (reader_ != nullptr) {
            read = reader_->read(pageOf(*pages[read_]));
            if (!read) return true;
        }
        log(*pages[read_], read, session_ns);
        ++pages_;
    }
    begun_ = begun_ || next != nullptr;
    block_ = block;
    read_ = 0;
    return false;
}

std::vector<const plan::Instruction*> InstructionCourse::due(const design::PlannedTrial* next) const {
    using plan::ShowAt;
    std::vector<const plan::Instruction*> pages;
    const auto add = [&](ShowAt moment) {
        for (const plan::Instruction& page : plan_.instructions)
            if (page.moment == moment && (page.block.empty() || page.block == next->block)) pages.push_back(&page);
    };
    if (next == nullptr) {
        if (block_ != kEnd) add(ShowAt::SessionEnd);
        return pages;
    }
    if (!begun_) add(ShowAt::SessionStart);
    if (block_ != next->block_index) add(ShowAt::BeforeBlock);
    return pages;
}

Page InstructionCourse::pageOf(const plan::Instruction& instruction) const {
    Page page{instruction, {}, {}, fmt::format("{}|{}|{}", *open_for_, read_, pages_)};
    for (const plan::StudyText& text : plan_.texts) {
        if (text.name != instruction.text || text.languages.empty()) continue;
        const auto chosen = std::find_if(text.languages.begin(), text.languages.end(),
                                         [&](const auto& each) { return each.first == language_; });
        page.text = chosen != text.languages.end() ? chosen->second : text.languages.front().second;
    }
    for (const plan::PictureSource& picture : plan_.pictures)
        if (picture.name == instruction.picture) page.picture = picture.path;
    return page;
}

void InstructionCourse::log(const plan::Instruction& instruction, const std::optional<PageRead>& read,
                            std::int64_t session_ns) const {
    JsonObject payload;
    payload.text("moment", plan::showAtName(instruction.moment))
        .text("text", instruction.text)
        .text("picture", instruction.picture);
    if (read) payload.text("language", language_);
    if (read && read->reading_ms && timing_measured_) payload.integer("reading_ms", *read->reading_ms);
    Event event;
    event.t_ns = session_ns;
    event.source = read ? read->read_by : "session";
    event.event = read ? "instruction" : "instruction_not_shown";
    event.payload_json = payload.str();
    sink_.appendEvent(event);
}

}  // namespace passung::session
