// The fixed parts of trade.html.
#pragma once

namespace mote::apps::trade {

const char* page_style();   ///< CSS
const char* page_script();  ///< JavaScript: the flip book; expects `book` (page.cpp)

}  // namespace mote::apps::trade
