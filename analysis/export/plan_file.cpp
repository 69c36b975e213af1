#include "analysis/export/plan_file.h"

#include "core/base/json.h"

namespace passung::exporter {

std::string planJson(const StudyData& study) {
    std::string json = "{\n  \"producer\": \"passung\",\n  \"plans\": [";
    for (std::size_t i = 0; i < study.protocols.size(); ++i) {
        const store::ProtocolRow& protocol = study.protocols[i];
        json += (i > 0 ? ",\n    " : "\n    ");
        json += JsonObject()
                    .text("protocol_sha256", protocol.sha256)
                    .text("app_version", protocol.app_version)
                    .json("plan", protocol.expanded_json)
                    .str();
    }
    return json + "\n  ]\n}\n";
}

}  // namespace passung::exporter
