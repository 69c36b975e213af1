#pragma once

#include "study/protocol/table_reader.h"
#include "study/protocol/view.h"

namespace passung::protocol {

/// [view] of the study `root`.
View readView(const TableReader& root, Errors& errors);

}  // namespace passung::protocol
