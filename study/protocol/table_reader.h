#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/base/types.h"
#include "study/protocol/document.h"
#include "study/protocol/key_table.h"

namespace passung::protocol {

/// Reads one table by the rows of the key table. The constructor reports everything that one key alone can have wrong:
/// unknown keys, wrong types, numbers that are not finite or out of range, unknown words, missing keys. After that the
/// getters cannot fail: they give the value, or the default, or (after an error) something harmless.
class TableReader {
public:
    /// `tables`: ids in the key table whose keys may stand here. `path` names the table in messages ("scene.contact").
    TableReader(const Node& table, std::vector<std::string_view> tables, std::string path, Errors& errors);

    /// Present and sound.
    bool has(std::string_view name) const { return node(name) != nullptr; }
    /// The value if present and sound, else nullptr.
    const Node* node(std::string_view name) const;

    bool boolean(std::string_view name) const;
    std::int64_t integer(std::string_view name) const;
    double number(std::string_view name) const;  // SI, by the unit in the key's name
    double numberOr(std::string_view name, double absent) const;
    std::string text(std::string_view name) const;                // Text, Name, Choice
    Vec3 vector(std::string_view name) const;                     // zero if absent; as written
    const std::vector<Node>& items(std::string_view name) const;  // Tables, Texts, Levels; empty if absent

    /// Something is wrong with this key's value; placed at the value, or at the table where it is absent.
    void fail(std::string_view name, std::string message) const;
    /// Name of a key for messages.
    std::string pathOf(std::string_view name) const;

private:
    const Key& key(std::string_view name) const;
    std::string fallbackText(std::string_view name) const;
    void reportUnknown(const Entry& entry);
    bool check(const Key& key, const Node& value) const;

    const Node& table_;
    std::vector<std::string_view> tables_;
    std::string path_;
    Errors& errors_;
    std::vector<const Entry*> sound_;
    std::vector<std::string_view> meant_;  // keys that an unknown one is likely to be: their absence is told with it
};

/// True for a lower-case letter followed by lower-case letters, digits and underscores.
bool isName(std::string_view text);

/// A `Stiffness` string as a fraction of the device's maximum ("max" = 1); nothing if it is none in (0, 1].
std::optional<double> stiffnessFraction(std::string_view text);

}  // namespace passung::protocol
