#include <cmath>
#include <cstddef>
#include <set>
#include <string>

#include "core/change_point/regression.hpp"
#include "core/display/unit.hpp"
#include "core/text/number_text.hpp"

namespace recald::change_point {
namespace {

constexpr std::array<const char*, model::kDayTypes> kKinds = {"workdays", "Saturdays",
                                                              "Sundays and holidays"};

/// Three significant digits, none of them as a power of ten: "2540", "39.7", "0.349".
std::string three_digits(double value) {
  if (value == 0.0) return "0";
  const double unit = std::pow(10.0, std::floor(std::log10(std::abs(value))) - 2.0);
  return number_text(std::round(value / unit) * unit, 9);
}

struct Shown {
  const display::MeterUnits& meter;
  const display::Unit& outdoor;
};

std::string slope_text(double slope_kWh_K, const char* side, double balance_C, const Shown& in) {
  const display::Unit& slope = in.meter.daily_per_degree;
  // "kWh/day per K": between them stands which way it goes.
  const std::size_t per = slope.name.find(" per ");
  return "; " + three_digits(std::abs(slope.shown(slope_kWh_K))) + " " + slope.name.substr(0, per) +
         (slope_kWh_K < 0.0 ? " less" : " more") + slope.name.substr(per) + " " + side + " " +
         number_text(in.outdoor.shown(balance_C), 3) + " " + in.outdoor.name;
}

/// " on workdays and Saturdays"; nothing where all kinds share the base load.
std::string kinds_text(const Regression& regression, int base) {
  std::string text;
  int kinds = 0;
  for (std::size_t type = 0; type < model::kDayTypes; ++type) {
    if (regression.base_number[type] != base) continue;
    text += (kinds++ == 0 ? " on " : " and ") + std::string{kKinds[type]};
  }
  return kinds == static_cast<int>(model::kDayTypes) ? "" : text;
}

/// "210 kWh/day on workdays, 80 on Saturdays".
std::string bases_text(const Regression& regression, std::size_t curve,
                       const display::Unit& daily) {
  std::string text;
  std::set<int> described;
  for (std::size_t type = 0; type < model::kDayTypes; ++type) {
    const int base = regression.base_number[type];
    if (regression.curve_of[type] != curve || !described.insert(base).second) continue;
    const std::string load = three_digits(daily.shown(regression.base_kWh[type]));
    text += (text.empty() ? load + " " + daily.name : ", " + load) + kinds_text(regression, base);
  }
  return text;
}

/// "No temperature", "4-parameter".
std::string form_text(Form form) {
  std::string text = kFormNames[static_cast<std::size_t>(form)];
  if (form == Form::no_temperature) text.front() = 'N';
  return text;
}

}  // namespace

std::string describe(const Regression& regression, const display::MeterUnits& units,
                     const display::Unit& outdoor) {
  const Shown in{units, outdoor};
  std::string text;
  for (std::size_t k = 0; k < regression.curves.size(); ++k) {
    const Curve& curve = regression.curves[k];
    text += (k == 0 ? "" : ". ") + form_text(curve.form) + ": " +
            bases_text(regression, k, units.daily);
    if (std::isfinite(curve.heating_balance_C)) {
      text += slope_text(curve.heating_slope_kWh_K, "below", curve.heating_balance_C, in);
    }
    if (std::isfinite(curve.cooling_balance_C)) {
      text += slope_text(curve.cooling_slope_kWh_K, "above", curve.cooling_balance_C, in);
    }
  }
  return text + ".";
}

}  // namespace recald::change_point
