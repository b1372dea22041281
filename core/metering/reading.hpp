/// A meter, a reading, and how far to trust it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/metering/civil_time.hpp"
#include "core/result.hpp"

namespace recald::metering {

enum class Utility : std::uint8_t { electricity, chilled_water, heating, steam, gas, water };

[[nodiscard]] std::string_view to_string(Utility utility);
[[nodiscard]] Result<Utility> parse_utility(std::string_view text);

/// How an interval's value may be used; IEEE 2030.5 quality flags have the same meanings.
enum class Validity : std::uint8_t {
  ok,       ///< Measured, all checks passed: counts in energy and peak.
  missing,  ///< Nothing usable.
  filled,   ///< Estimated from like times: counts in energy, with a variance, never in a peak.
  scaled,   ///< Shape estimated, sum known from a counter: counts in energy, never in a peak.
  suspect,  ///< Failed a check, value kept: treated as missing until confirmed.
};

[[nodiscard]] std::string_view to_string(Validity validity);
[[nodiscard]] Result<Validity> parse_validity(std::string_view text);

/// Why an interval has its validity. A set of bits: an interval may have several reasons, or none.
/// They are for people and exports; no code branches on them.
enum class Reason : std::uint32_t {
  none = 0,
  timeout = 1u << 0,
  exception = 1u << 1,
  crc = 1u << 2,
  mismatch = 1u << 3,
  sentinel = 1u << 4,
  nan = 1u << 5,
  range = 1u << 6,
  spike = 1u << 7,
  stuck = 1u << 8,
  negative = 1u << 9,
  zero_run = 1u << 10,
  sum_check = 1u << 11,
  rollover = 1u << 12,
  wrap = 1u << 13,
  reset = 1u << 14,
  jump = 1u << 15,
  bounce = 1u << 16,
  clock = 1u << 17,
  partial = 1u << 18,
  coarse = 1u << 19,
  replay = 1u << 20,
  manual = 1u << 21,
  estimated = 1u << 22,  ///< By the source, which says so.
};

constexpr Reason operator|(Reason a, Reason b) {
  return static_cast<Reason>(static_cast<std::uint32_t>(a) | static_cast<std::uint32_t>(b));
}
constexpr Reason& operator|=(Reason& a, Reason b) { return a = a | b; }
constexpr bool has(Reason set, Reason reason) {
  return (static_cast<std::uint32_t>(set) & static_cast<std::uint32_t>(reason)) != 0;
}

/// "negative|range"; empty for none.
[[nodiscard]] std::string to_string(Reason reasons);
[[nodiscard]] Result<Reason> parse_reasons(std::string_view text);

/// One interval's mean power from a source: start-stamped, UTC, already in kW.
struct Reading {
  std::uint32_t meter;  ///< Index into the site's list of meters.
  Instant start;        ///< Interval start; a multiple of the meter's interval.
  double mean_kW;       ///< NaN when the source lists the interval as blank.
  /// The source's own flag; `ok` from a meter or a plain file. A `filled` value is treated as
  /// missing (it is estimated again, with a variance); a `scaled` one counts in energy.
  Validity validity = Validity::ok;
  Reason reasons = Reason::none;
  bool late = false;  ///< The source had already closed the month.
};

/// How a month's peak demand is defined. The contract names the method, so the result does too.
enum class PeakMethod : std::uint8_t {
  block,  ///< Largest mean over fixed blocks of `window`, from the local hour on.
};

struct PeakRule {
  PeakMethod method = PeakMethod::block;
  std::chrono::seconds window{900};  ///< A multiple of the meter's interval, else the interval.
};

/// The description of a meter.
struct Meter {
  std::string id;
  Utility utility = Utility::electricity;
  std::chrono::seconds interval{900};
  /// Offset of interval starts from multiples of `interval` since 1970. Not 0 only for meters
  /// coarser than their zone's offset (hourly values on the local hour at UTC+5:30).
  std::chrono::seconds phase{0};
  std::optional<double> rated_kW;  ///< Largest plausible mean power; absent: no such check.
  /// Longest run of exact zeros that counts as load; a longer one is a dead meter. Absent:
  /// any run is load. Neither this nor `stuck_max` applies to a counter.
  std::optional<std::chrono::seconds> zero_run_max;
  /// A run of equal non-zero values this long means a frozen meter. Absent: 12
  /// intervals; 0 s: never.
  std::optional<std::chrono::seconds> stuck_max;
  bool negative_is_valid = false;
  bool is_counted = false;  ///< Readings are differences of a cumulative register.
  PeakRule peak;
};

}  // namespace recald::metering
