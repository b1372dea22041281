/// The figure of one effect's footprint: what it adds to each meter, by hour and by month.
#pragma once

#include <string>
#include <vector>

#include "simulators/footprint/means.hpp"
#include "simulators/scenario/scenario.hpp"

namespace recald::simulators {

/// One meter over the same intervals, without and with the effect.
struct MeterFootprint {
  Utility utility;
  std::string name;  ///< "chilled water"
  std::vector<double> plain_kW;
  std::vector<double> added_kW;  ///< By the effect; with it, the meter shows the sum.

  /// Added / plain; 0 if the meter shows nothing.
  [[nodiscard]] double share() const;
};

struct Footprint {
  HiddenChoice effect;
  std::string building;  ///< In a few words.
  metering::Instant begin;
  std::vector<MeterFootprint> meters;
  std::vector<double> outdoor_C = {};  ///< Of each interval; empty: not known.
};

/// "electricity +1.2 %", or "electricity unchanged" if nothing was added.
[[nodiscard]] std::string share_text(const MeterFootprint& meter);
/// For all meters, separated by commas.
[[nodiscard]] std::string share_text(const Footprint& footprint);
/// "Strength 3 hours later than planned …, from 2022-04-01."
[[nodiscard]] std::string strength_text(const HiddenChoice& effect);

/// Left: the mean day in the winter and in the summer half-year, working days and weekends
/// apart, over the days on which the effect is active. Right: each month relative to the
/// meter's mean month. Below, where the weather is known: means by outdoor temperature, Monday to
/// Friday from 8 to 18 h and at other times apart.
/// @return an SVG file
[[nodiscard]] std::string effect_figure(const Footprint& footprint,
                                        const metering::LocalCalendar& calendar);

}  // namespace recald::simulators
