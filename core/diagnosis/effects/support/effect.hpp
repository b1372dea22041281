/// One entry of the catalogue: a physical effect that a building may have and its model lacks.
///
/// An entry is data and one small function. To add one, add a file to `effects/`: the file
/// `effects/<id>.cpp` defines `Effect recald::diagnosis::effects::<id>()`, and the build finds it.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/metering/reading.hpp"
#include "core/model/building.hpp"
#include "core/model/drivers.hpp"
#include "core/model/hourly/alteration.hpp"
#include "core/model/parameter.hpp"

namespace recald::diagnosis {

enum class EffectClass { schedule, outdoor_air, air_system, envelope, plant, electrical, meter };
[[nodiscard]] std::string_view to_string(EffectClass effect_class);

/// Facts about the site that the priors of effects may use.
struct SiteFacts {
  const model::Building& building;
  const model::Drivers& drivers;
  std::vector<metering::Utility> utilities;  ///< (m) of the model's meters.
  std::vector<double> mean_kW;               ///< (m) measured mean power of each.
  /// For the meter of this utility, or 0 if there is none. Gas and steam count as heating.
  [[nodiscard]] double mean_of_kW(metering::Utility utility) const;
};

struct EffectParameter {
  std::string name;  ///< snake_case
  std::string unit;
  Prior prior;     ///< With physical sign and bounds.
  double neutral;  ///< At this value the model equals its parent, bit for bit. Shape parameters
                   ///< have none: NaN.
  /// Values at which a shape is tried (threshold, hour, weekday); empty: an amount.
  std::vector<double> scan = {};
  /// Only the scanned values are possible (for example a calendar). Chosen, not fitted.
  bool choice = false;
};

/// What an effect needs in order to be a candidate.
struct EffectNeeds {
  bool air_system = false;
  bool reheat_boxes = false;
  bool humidity = false;
  bool wind = false;
  bool sun = false;
  bool own_chiller = false;
  bool heat_pump = false;
  bool economiser = false;
  bool night_set_back = false;  ///< Unoccupied set-points differ from occupied ones.
};

/// How an effect can be limited in time.
enum class Dating {
  always,      ///< A property of the building.
  may_begin,   ///< Either always, or from a date that is then a parameter.
  must_begin,  ///< From a date.
  window,      ///< From one date to another.
};

/// A rival effect, and how to distinguish the two.
struct Confusable {
  std::string_view effect;
  std::string_view separated_by;  ///< The measurement, as a building operator would order it.
};

struct Effect {
  std::string_view id;
  std::string_view title;      ///< "Night set-back missing"
  std::string_view meaning;    ///< For the people in the building, in one or two sentences.
  std::string_view physics;    ///< The equation as text, with units.
  std::string_view on_meters;  ///< What meters show of it, in one sentence.
  std::string_view check;      ///< Where in the building to look first.
  EffectClass effect_class;
  Dating dating = Dating::always;
  /// Changes what one meter records, not the building. There is one candidate per meter of these
  /// utilities (empty: every meter), and `bind` gets the meter.
  bool of_one_meter = false;
  std::vector<metering::Utility> meter_utilities = {};
  EffectNeeds needs = {};
  std::vector<Confusable> confusable = {};

  /// At most 3, without the dates that `dating` adds.
  std::vector<EffectParameter> (*parameters)(const SiteFacts&);
  /// @param values  In order of `parameters`, in the support of their priors.
  /// @param meter   Index among the model's meters; -1 unless `of_one_meter`.
  std::unique_ptr<model::hourly::Alteration> (*bind)(const SiteFacts&,
                                                     std::span<const double> values, int meter);
};

/// All entries, ordered by id.
[[nodiscard]] std::span<const Effect> catalogue();
/// @return nullptr if no entry has this id.
[[nodiscard]] const Effect* find_effect(std::string_view id);

/// Calls `inner` only in hours that start in [from_day, to_day), counted as `DriverHour::day_index`
/// with the hour as fraction. The building is as it rebuilds it between those days alone.
[[nodiscard]] std::unique_ptr<model::hourly::Alteration> within_dates(
    std::unique_ptr<model::hourly::Alteration> inner, double from_day, double to_day);

}  // namespace recald::diagnosis
