#include "study/protocol/session_rules.h"

namespace passung::protocol {
namespace {

plan::Repeat repeatNamed(const std::string& name) {
    return name == "repeat_now"            ? plan::Repeat::Now
           : name == "repeat_at_block_end" ? plan::Repeat::AtBlockEnd
                                           : plan::Repeat::Never;
}

}  // namespace

void readRepeats(const TableReader& read, plan::Block& block) {
    block.on_failure = repeatNamed(read.text("on_failure"));
    block.on_timeout = read.has("on_timeout") ? repeatNamed(read.text("on_timeout")) : block.on_failure;
    block.on_invalid = repeatNamed(read.text("on_invalid"));
    block.max_attempts = static_cast<int>(read.integer("max_attempts"));
}

plan::ResumePolicy readResume(const TableReader& root, Errors& errors) {
    const Node* table = root.node("resume");
    plan::ResumePolicy policy;
    if (table == nullptr) return policy;
    const TableReader read(*table, {"resume"}, "resume", errors);
    policy.max_age = read.number("max_age_h");
    policy.redo_practice = read.text("practice") == "redo";
    policy.restart_block = read.text("block") == "restart";
    return policy;
}

}  // namespace passung::protocol
