#include "study/store/transfer/same_study.h"

#include <array>

namespace passung::store {
namespace {

/// What has to be the same in both wherever rows of `table` agree in `keys`. The first key is named between the words.
struct Agreement {
    const char* table;
    const char* keys;
    const char* differs;  // s: the other one's row, m: the main one's
    const char* before;
    const char* after;
};

// What the protocol's text alone does not say must not differ either. Times that were measured may.
constexpr std::array kAgreements = {
    Agreement{"protocol_version", "version, name", "s.protocol_sha256<>m.protocol_sha256", "its protocol of version ",
              " has another text"},
    Agreement{"protocol_version", "version, protocol_sha256",
              "json_extract(s.expanded_json, '$.seed')<>json_extract(m.expanded_json, '$.seed')",
              "its protocol of version ", " was run with another seed"},
    Agreement{"protocol_version", "version, protocol_sha256",
              "EXISTS(SELECT 1 FROM json_each(s.expanded_json, '$.conditions') a "
              "JOIN json_each(m.expanded_json, '$.conditions') b USING(key) WHERE "
              "coalesce(json_extract(a.value, '$.params.contact.geometry'), 'field')<>"
              "coalesce(json_extract(b.value, '$.params.contact.geometry'), 'field'))",
              "its protocol of version ", " was begun with another geometry of contact"},
    Agreement{"mesh_file", "mesh, protocol_sha256", "s.sha256<>m.sha256", "another file lies behind the mesh ", ""},
    Agreement{"picture_file", "picture, protocol_sha256", "s.sha256<>m.sha256", "another file lies behind the picture ",
              ""},
    Agreement{"stable_stiffness", "device, protocol_sha256",
              // not by equality: a server's text of a number may lose its last bit here
              "abs(s.stable_stiffness_N_per_m - m.stable_stiffness_N_per_m) > 1e-9*m.stable_stiffness_N_per_m OR "
              "abs(s.stable_rotational_stiffness_Nm_per_rad - m.stable_rotational_stiffness_Nm_per_rad) > "
              "1e-9*m.stable_rotational_stiffness_Nm_per_rad",
              "the device ", " has another stable stiffness there"},
    Agreement{"accuracy_candidate", "candidate, protocol_sha256",
              "(s.mode, s.budget_nodes)<>(m.mode, m.budget_nodes) OR "
              "abs(s.tolerance_um - m.tolerance_um) > 1e-9*m.tolerance_um OR "
              "abs(s.spacing_mm - m.spacing_mm) > 1e-9*m.spacing_mm",
              "candidate ", " of accuracy = \"auto\" has other settings there"},
    Agreement{"accuracy_pick", "budget_us, protocol_sha256", "s.candidate<>m.candidate", "for a budget of ",
              " us accuracy = \"auto\" picked another setting there"},
    Agreement{"measure", "measure", "s.formula_version<>m.formula_version", "its measure ",
              " follows another version of the formula"},
    Agreement{"participant", "participant_id",
              "s.kind<>m.kind OR s.created_utc<>m.created_utc OR s.identity<>m.identity", "participant code ",
              " stands for two people"},
};

}  // namespace

void requireSameStudy(const Database& database, const std::string& other,
                      const std::function<void(const std::string&)>& refuse) {
    Statement name = database.prepare("SELECT s.name FROM " + other +
                                      ".protocol_version s JOIN main.protocol_version m ON m.name<>s.name");
    if (name.step()) refuse("holds the study " + name.text(0) + ", which is another one than the rest");
    for (const Agreement& agreement : kAgreements) {
        const std::string keys = agreement.keys, table = agreement.table;
        Statement find =
            database.prepare("SELECT s." + keys.substr(0, keys.find(',')) + " FROM " + other + "." + table +
                             " s JOIN main." + table + " m USING(" + keys + ") WHERE " + agreement.differs);
        if (find.step()) refuse(agreement.before + find.text(0) + agreement.after);
    }
}

}  // namespace passung::store
