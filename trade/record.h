// One measurement of a trade: how far a method was from the reference after so many passes and seconds.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace mote::trade {

inline constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// One row of trade.csv; the columns have these names, with units: wall_s, cpu_s, build_s, peak_memory_mb.
struct Record {
    std::string method, integrator, settings;  ///< settings: "bound=2 paths=256"
    std::uint64_t seed = 0;
    std::uint32_t passes = 0;
    double wall = 0.0;          ///< seconds for build, passes and one finish
    double cpu = 0.0;           ///< processor time [s], all threads together
    double build = 0.0;         ///< the part of wall that was spent before the first pass
    double error = unknown;     ///< of core/metrics/relative_error.h, without the noise of the reference
    double error_se = unknown;  ///< its standard error, from the noise of the reference
    double stated_low = unknown, stated_high = unknown;  ///< interval of 95 % that the picture states of it
    double relmse = unknown,
           relmse_trimmed = unknown;  ///< what other programs give, see core/metrics/metrics.h
    double bias = unknown;            ///< of core/metrics/relative_error.h
    double bias_se = unknown;         ///< its standard error, from the spread of the passes' biases
    std::uint64_t non_finite = 0;
    double peak_memory_mb = 0.0;   ///< of the process so far, all methods alive
    bool final = false;            ///< the last of its method and seed
    bool below_reference = false;  ///< less than the reference distinguishes from none
};

/// RFC 4180, with a header row. Numbers read back as the same numbers; empty for unknown.
std::string to_csv(std::span<const Record> records);
/// Columns are found by their names; `path` is its name in messages. Throws InputError with the line of what
/// is missing, unknown or no number.
std::vector<Record> records_from_csv(const std::string& text, const std::string& path);

}  // namespace mote::trade
