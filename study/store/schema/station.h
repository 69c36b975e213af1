#pragma once

#include <string>

namespace passung::store {

/// One of several places where a study runs, each with a database of its own. Each takes only its own replicates of the
/// square, beginning with another row than the others (see design::firstRow()), and has codes of its own, so that the
/// databases can be merged.
struct Station {
    std::string name = "local";  // of several: a capital letter
    int index = 0;               // from 0
    int count = 1;
};

}  // namespace passung::store
