// Error against time as an SVG picture.
#pragma once

#include <span>
#include <string>

#include "apps/trade/curves.h"

namespace mote::apps::trade {

/// Log-log: for every curve its mean over seeds with the range as a band, the Pareto front behind them, and
/// the smallest error that the reference can judge (`floor`, 0 for none) as a line. Curves are told apart by
/// colour, marker and a label at their end. Text is escaped.
std::string plot_svg(std::span<const Curve> curves, double floor, const std::string& title);

/// Colour of the curve at this index, as in the plot (Okabe and Ito 2008: safe for the colour-blind).
std::string curve_colour(std::size_t index);

/// Text made safe for XML and HTML.
std::string escaped(const std::string& text);

}  // namespace mote::apps::trade
