// The table of a trade for a terminal and for mails.
#pragma once

#include <string>

#include "apps/trade/draw.h"

namespace mote::apps::trade {

/// One line a method: passes, seconds, error, bias, times to errors, and the front. Columns are aligned.
std::string text_table(const Results& results);

}  // namespace mote::apps::trade
