/// How much wider or narrower an output's months scatter than forecast, learnt from those before.
#pragma once

#include <vector>

#include "core/assessment/forecast.hpp"

namespace recald::assessment {

/// The data model has one error for all months of an output (eq. 5 of the seed), and it is not so:
/// a model of whole months misses little where hardly anything is used and most where a building is
/// between heating and cooling. Standardised surprises z of an output therefore are not standard
/// normal, but
///
///     z_t ~ sqrt(g(level_t)) s(level_t) e_t,   g(l) = least_share + l
///
/// where g has the variance grow in proportion to the use, s^2 is learnt
/// from the surprises at levels near this one, which stand in for a month of the same kind, and
/// drawn towards that of all months while there are few, and e is normal or has heavier tails: how
/// likely either is, is learnt too. A forecast is widened or narrowed about its mean; that s is not
/// known makes its tails Student's.
class Spread {
 public:
  struct Prior {
    double months = 6.0;           ///< What the forecast's own spread is worth for all months …
    double months_at_level = 4.0;  ///< … and theirs for those at one level.
    double level_width = 0.1;      ///< Of what is near, on the scale of `adapt`.
    double least_share = 0.05;     ///< Of the variance at full use, where nothing is used.
    double tail_freedom = 4.0;  ///< Degrees of freedom of the heavier tails, > 2; as likely as not.
    double surprise_max = 3.0;  ///< A change must not pass for scatter: sds that count at most.
  };

  Spread() : Spread(Prior{}) {}
  explicit Spread(const Prior& prior) : prior_(prior) {}

  /// @param level  What the month is expected to use, as a share of the largest month that the
  ///               output's scale holds; beyond twice that counts as twice.
  [[nodiscard]] Forecast adapt(const Forecast& forecast, double level) const;

  /// @param standardised  Surprise of the forecast before it was adapted.
  void take(double level, double standardised);

  /// E z^2 at a level, and what it is worth in months.
  struct Variance {
    double mean;
    double months;
  };
  [[nodiscard]] Variance variance_at(double level) const;

  /// That e has the heavier tails.
  [[nodiscard]] double heavy_probability() const;

 private:
  struct Seen {
    double level;
    double square;  ///< Of z / sqrt(g).
  };

  [[nodiscard]] double shape(double level) const;
  /// What the variance is worth where e has the heavier tails: a scatter of its own, added to
  /// that of not knowing s.
  [[nodiscard]] Variance heavy(const Variance& variance) const;

  Prior prior_;
  std::vector<Seen> seen_;
  double log_odds_ = 0.0;  ///< Heavier tails against normal ones.
};

}  // namespace recald::assessment
