/// How much wider or narrower an output's months scatter than forecast, learnt from those before.
#pragma once

#include <vector>

#include "core/drift/forecast.hpp"

namespace recald::drift {

/// The data model has one error for all months of an output (eq. 5 of the seed), and it is not so:
/// a model of whole months misses more where a building is between heating and cooling than in the
/// depth of a season. Standardised surprises z of an output therefore are not standard normal, but
///
///     z_t ~ N(0, s^2(level_t)),   s^2 ~ inverse gamma
///
/// with s learnt from the surprises at levels near this one, which stand in for a month of the same
/// kind, and drawn towards that of all months while there are few. A forecast is widened or
/// narrowed by s about its mean; that s is not known makes its tails Student's.
class Spread {
 public:
  struct Prior {
    /// What the forecast's own spread is worth for all months, and theirs for those at one level.
    double months = 6.0;
    double level_width = 0.15;  ///< Of what is near, in the output's range.
    double surprise_max = 3.0;  ///< A change must not pass for scatter: larger ones count as this.
  };

  Spread() : Spread(Prior{}) {}
  explicit Spread(const Prior& prior) : prior_(prior) {}

  /// @param level  Where in the output's range the month is expected, 0 to 1 and beyond.
  [[nodiscard]] Forecast adapt(const Forecast& forecast, double level) const;

  /// @param standardised  Surprise of the forecast before it was adapted.
  void take(double level, double standardised);

  /// E s^2 at a level, and what it is worth in months.
  struct Variance {
    double mean;
    double months;
  };
  [[nodiscard]] Variance variance_at(double level) const;

 private:
  struct Seen {
    double level;
    double square;
  };

  Prior prior_;
  std::vector<Seen> seen_;
};

}  // namespace recald::drift
