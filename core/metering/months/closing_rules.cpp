#include "core/metering/months/closing_rules.hpp"

#include <bit>
#include <concepts>
#include <cstdint>
#include <optional>

namespace recald::metering {
namespace {

/// Increase this when the program itself closes months differently.
constexpr int kVersion = 4;

/// FNV-1a, 64 bit, used to distinguish rules, not to protect them. @see RFC draft eastlake-fnv.
class Digest {
 public:
  void add(std::integral auto value) {
    auto bits = static_cast<std::uint64_t>(value);
    for (int byte = 0; byte < 8; ++byte, bits >>= 8) {
      hash_ = (hash_ ^ (bits & 0xFF)) * 0x100000001b3;
    }
  }
  void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
  void add(std::chrono::seconds value) { add(value.count()); }
  template <class T>
  void add(const std::optional<T>& value) {
    add(value.has_value());
    if (value) add(*value);
  }

  [[nodiscard]] std::string text() const {
    constexpr const char* digits = "0123456789abcdef";
    std::string text;
    for (int shift = 60; shift >= 0; shift -= 4) text += digits[(hash_ >> shift) & 0xF];
    return text;
  }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325;
};

void add(const ValidationOptions& options, Digest& digest) {
  digest.add(options.range_factor);
  digest.add(options.unrated_range_factor);
  digest.add(options.unrated_history_factor);
  digest.add(options.spike_rise);
  digest.add(options.spike_scales);
  digest.add(options.spike_days_around);
  digest.add(options.correction_window);
  digest.add(options.stuck_intervals);
}

void add(const FillOptions& options, Digest& digest) {
  digest.add(static_cast<int>(options.rule));
  digest.add(options.daytype);
  for (const Day day : options.holidays) {
    digest.add(std::chrono::sys_days{day}.time_since_epoch().count());
  }
  digest.add(options.line_max);
  digest.add(options.days_min);
  digest.add(options.by_slots_gap_max);
}

void add(const Meter& meter, Digest& digest) {
  digest.add(static_cast<int>(meter.utility));
  digest.add(meter.interval);
  digest.add(meter.phase);
  digest.add(meter.rated_kW);
  digest.add(meter.zero_run_max);
  digest.add(meter.stuck_max);
  digest.add(meter.negative_is_valid);
  digest.add(meter.is_counted);
  digest.add(static_cast<int>(meter.peak.method));
  digest.add(meter.peak.window);
}

}  // namespace

std::string closing_rules(const ClosingOptions& options, const Meter& meter) {
  Digest digest;
  digest.add(kVersion);
  add(options.validation, digest);
  add(options.fill, digest);
  digest.add(options.coverage_min);
  digest.add(options.gap_max);
  add(meter, digest);
  return digest.text();
}

}  // namespace recald::metering
