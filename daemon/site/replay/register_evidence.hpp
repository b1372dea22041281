/// Whether the values of a meter are those of a cumulative register instead of amounts, and what
/// kind of register it is.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/metering/registers/counter.hpp"

namespace recald::daemon {

/// One step of a register to another value.
struct RegisterStep {
  metering::RegisterSample from;
  metering::RegisterSample to;
};

struct RegisterVerdict {
  bool is_register = false;
  std::string because = {};  ///< Of a register: what shows it.
  metering::Resets resets = metering::Resets::never;
  /// By whose midnights it is set to zero, if that is not the calendar that was asked: "Etc/GMT-1".
  std::string reset_zone = {};
  bool runs_back = false;
  std::uint64_t rises = 0;
  std::uint64_t falls = 0;
  /// Half as much again as it ever rose by: the most that its load can draw. Never from a rise that
  /// stands alone, for that is an exchange or a misread value.
  double rated_kW = 0.0;
  /// Rises and falls that no load explains, in order of time; up to twenty.
  std::vector<RegisterStep> exchanges = {};
};

/// Takes a meter's values as they pass; memory does not grow with their number.
class RegisterEvidence {
 public:
  /// @param value_kWh  In order of time; what is not later than the one before is left out.
  void take(metering::Instant time, double value_kWh);

  /// A total hardly ever falls, unless it is set to zero at midnight or when a month begins, while
  /// a building's consumption falls about as often as it rises. One that counts back what is
  /// delivered does, but moves far in small steps.
  /// Whether its values are none, or hardly ever one more and never less: those of a register that
  /// rests, if it is one.
  [[nodiscard]] bool may_rest() const;

  [[nodiscard]] RegisterVerdict verdict(const metering::LocalCalendar& calendar) const;

 private:
  /// The steps with the largest sizes.
  struct Largest {
    struct One {
      double size;
      RegisterStep step;
    };
    std::vector<One> heap = {};  ///< The smallest of them first.

    void take(double size, const RegisterStep& step);
    /// The largest size that three others come near to; 0 before the first step.
    [[nodiscard]] double confirmed() const;
    [[nodiscard]] bool reach_small(double range) const;
  };

  void take_fall(const RegisterStep& step);
  bool take_back_bounce(const metering::RegisterSample& sample);
  void take_rate(const metering::RegisterSample& sample);
  [[nodiscard]] bool hardly_falls() const;
  [[nodiscard]] metering::Resets resets_by(const metering::LocalCalendar& calendar) const;
  void find_resets(const metering::LocalCalendar& calendar, RegisterVerdict& verdict) const;
  void find_exchanges(RegisterVerdict& verdict) const;

  std::optional<metering::RegisterSample> first_;
  std::optional<metering::RegisterSample> last_;
  std::optional<metering::RegisterSample> rate_from_;
  std::uint64_t rises_ = 0;
  std::uint64_t falls_ = 0;
  int since_fall_ = 0;  ///< Samples; 0: the last step was no fall, nor were those before it.
  std::vector<RegisterStep> kept_falls_;
  double lowest_kWh_ = 0.0;
  double highest_kWh_ = 0.0;
  Largest rates_kW_;
  Largest steps_kWh_;
};

}  // namespace recald::daemon
