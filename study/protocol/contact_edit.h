#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace passung::protocol {

/// A key of [scene.contact] and what it is to say.
struct ContactKey {
    std::string name;            // "method"
    std::string value;           // as TOML writes it; empty: the key goes
    bool holds_already = false;  // what is read has this value: if a level sets it, it need not be written
};

/// What became of a change.
struct ContactEdit {
    enum class Outcome { Changed, Unchanged, SetElsewhere, Refused };
    Outcome outcome = Outcome::Refused;
    std::string text;  // of the file from now on; Changed, Unchanged
    Error error;       // SetElsewhere: what sets the key, at its place; Refused: why
};

/// The text of the study file `path` with these keys of its [scene.contact]. Every byte that is not of their values
/// stays: comments, order, ends of lines. A key that is not there takes the place of one
/// that goes, or comes after the last one of the table; the comment of one that goes stays. SetElsewhere: a factor's
/// levels, a block or a staircase sets a key, which what is written here would not change. Refused: the text cannot be
/// read, or the table stands in a file that it includes.
ContactEdit editContact(const std::string& text, const std::string& path, std::span<const ContactKey> keys);

}  // namespace passung::protocol
