#include "core/diagnosis/evidence/locate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>

#include "core/diagnosis/evidence/false_discovery.hpp"
#include "core/display/unit.hpp"

namespace recald::diagnosis {
namespace {

constexpr Eigen::Index kLeastParts = 12;
constexpr std::array<const char*, kPartsPerDay> kPartNames = {"00-04 h", "04-08 h", "08-12 h",
                                                              "12-16 h", "16-20 h", "20-24 h"};
constexpr std::array<const char*, 7> kWeekdays = {"Sundays",   "Mondays", "Tuesdays", "Wednesdays",
                                                  "Thursdays", "Fridays", "Saturdays"};
constexpr std::array<const char*, model::kDayTypes> kDayWords = {"working days", "Saturdays",
                                                                 "Sundays and holidays"};

std::string number(double value, const display::Unit& unit) {
  char text[48];
  std::snprintf(text, sizeof text, "%.3g ", unit.shown(value));
  return text + unit.name;
}

/// How a family assigns a part to a bin; equal numbers share a bin, negative is none.
struct Family {
  std::string name;
  std::function<int(const DayPart&)> bin;
  std::function<std::string(int)> words;
};

struct Driver {
  const char* name;
  const char* phrase;
  display::Unit unit;
  double (*value)(const DayPart&);
};

Family quantile_family(const SiteProblem& site, const Driver& driver, int bins) {
  std::vector<double> values;
  for (const DayPart& part : site.day_parts.parts) values.push_back(driver.value(part));
  std::ranges::sort(values);
  std::vector<double> limits;
  for (int k = 1; k < bins; ++k) {
    limits.push_back(
        values[static_cast<std::size_t>(k) * values.size() / static_cast<std::size_t>(bins)]);
  }
  return {driver.name,
          [limits, value = driver.value](const DayPart& part) {
            return static_cast<int>(std::ranges::upper_bound(limits, value(part)) - limits.begin());
          },
          [limits, driver](int k) {
            const auto i = static_cast<std::size_t>(k);
            const auto at = [&](double limit) { return number(limit, driver.unit); };
            const std::string what{driver.phrase};
            if (i == 0) return what + " below " + at(limits.front());
            if (i == limits.size()) return what + " above " + at(limits.back());
            return what + " " + at(limits[i - 1]) + " to " + at(limits[i]);
          }};
}

std::vector<Family> families_of(const SiteProblem& site) {
  std::vector<Family> families;
  families.push_back({"part of the week", [](const DayPart& p) { return p.part_of_week; },
                      [](int k) {
                        return std::string{kWeekdays[static_cast<std::size_t>(k / kPartsPerDay)]} +
                               " " + kPartNames[static_cast<std::size_t>(k % kPartsPerDay)];
                      }});
  families.push_back(
      {"kind of day and hours",
       [](const DayPart& p) { return static_cast<int>(p.day) * kPartsPerDay + p.part; },
       [](int k) {
         return std::string{kDayWords[static_cast<std::size_t>(k / kPartsPerDay)]} + " " +
                kPartNames[static_cast<std::size_t>(k % kPartsPerDay)];
       }});
  families.push_back({"month", [](const DayPart& p) { return p.month; },
                      [&site](int k) {
                        return metering::to_string(
                            site.drivers->months[static_cast<std::size_t>(k)]);
                      }});
  families.push_back({"fortnight", [](const DayPart& p) { return p.day_index / 14; },
                      [&site](int k) {
                        const std::chrono::sys_days first{site.drivers->hours.front().date};
                        return "the fortnight from " + metering::to_string(metering::Day{
                                                           first + std::chrono::days{14 * k}});
                      }});
  const Driver temperature{"outdoor temperature", "outdoor temperature",
                           display::unit_of(site.units, "degC"),
                           [](const DayPart& p) { return p.dry_bulb_C; }};
  families.push_back(quantile_family(site, temperature, 12));
  if (site.drivers->has_humidity) {
    families.push_back(quantile_family(site,
                                       {"humidity",
                                        "outdoor air with",
                                        {"g/kg", 1e3},
                                        [](const DayPart& p) { return p.humidity_ratio; }},
                                       8));
  }
  if (site.drivers->has_wind) {
    families.push_back(quantile_family(site,
                                       {"wind", "wind", display::unit_of(site.units, "m/s"),
                                        [](const DayPart& p) { return p.wind_m_s; }},
                                       8));
  }
  if (site.has_sun) {
    families.push_back(quantile_family(
        site, {"sun", "sun", {"W/m²"}, [](const DayPart& p) { return p.global_horizontal_W_m2; }},
        8));
  }
  // Hours by temperature: three classes of equal count.
  Family warm = quantile_family(site, temperature, 3);
  families.push_back({"hours by outdoor temperature",
                      [bin = warm.bin](const DayPart& p) { return bin(p) * kPartsPerDay + p.part; },
                      [words = warm.words](int k) {
                        return std::string{kPartNames[static_cast<std::size_t>(k % kPartsPerDay)]} +
                               ", " + words(k / kPartsPerDay);
                      }});
  return families;
}

struct Bin {
  std::size_t meter;
  std::size_t family;
  int number;
};

/// One column per bin: ones in its parts.
struct BinColumns {
  std::vector<Bin> bins;
  Eigen::MatrixXd columns;
};

BinColumns columns_of(const FitContext& context, const Family& family, std::size_t family_index,
                      std::size_t meter) {
  const MeterRows& rows = context.observations.meters[meter];
  std::map<int, std::vector<Eigen::Index>> members;
  for (std::size_t i = 0; i < rows.rows.size(); ++i) {
    const int bin =
        family.bin(context.site.day_parts.parts[static_cast<std::size_t>(rows.rows[i])]);
    members[bin].push_back(rows.offset + static_cast<Eigen::Index>(i));
  }
  BinColumns result;
  std::vector<const std::vector<Eigen::Index>*> kept;
  for (const auto& [bin, indices] : members) {
    if (std::ssize(indices) < kLeastParts) continue;
    result.bins.push_back({meter, family_index, bin});
    kept.push_back(&indices);
  }
  result.columns.setZero(context.observations.count(), static_cast<Eigen::Index>(kept.size()));
  for (std::size_t k = 0; k < kept.size(); ++k) {
    for (const Eigen::Index i : *kept[k]) result.columns(i, static_cast<Eigen::Index>(k)) = 1.0;
  }
  return result;
}

/// Size of the disagreement in a bin, in the meter's own unit.
Misfit describe(const FitContext& context, const JointFit& none, const Family& family,
                const Bin& bin, double t) {
  const MeterRows& rows = context.observations.meters[bin.meter];
  const auto g = static_cast<Eigen::Index>(bin.meter);
  double difference_kWh = 0.0;
  double modelled_kWh = 0.0;
  std::map<int, int> months;
  for (const Eigen::Index row : rows.rows) {
    const DayPart& part = context.site.day_parts.parts[static_cast<std::size_t>(row)];
    ++months[part.month];
    if (family.bin(part) != bin.number) continue;
    difference_kWh += part.hours * (context.site.measured_parts_kW(row, g) - none.parts_kW(row, g));
    modelled_kWh += part.hours * none.parts_kW(row, g);
  }
  const double share = difference_kWh / std::max(std::abs(modelled_kWh), 1e-9);
  return {
      .meter = bin.meter,
      .family = family.name,
      .words = family.words(bin.number),
      .share = share,
      .share_se = t == 0.0 ? 0.0 : std::abs(share / t),
      .kWh_month = difference_kWh / static_cast<double>(std::max<std::size_t>(months.size(), 1)),
      .statistic = t,
      .adjusted_p = 1.0};
}

}  // namespace

Result<std::vector<Misfit>> locate(const FitContext& context, const JointFit& none, Rng& rng,
                                   const LocateOptions& options) {
  const std::vector<Family> families = families_of(context.site);
  const NoiseNode& node = context.grid[static_cast<std::size_t>(none.best_node)];
  const Eigen::Index q = none.jacobian.cols();
  std::vector<TestFamily> tests;
  std::vector<std::vector<Misfit>> described;
  for (std::size_t f = 0; f < families.size(); ++f) {
    for (std::size_t g = 0; g < context.observations.meters.size(); ++g) {
      const BinColumns bins = columns_of(context, families[f], f, g);
      if (bins.bins.size() < 2) continue;
      Eigen::MatrixXd columns(bins.columns.rows(), 1 + q + bins.columns.cols());
      columns << none.linear_residual(), none.jacobian, bins.columns;
      const auto system = TRY(
          marginalise(node.gram(context.observations, columns), Eigen::MatrixXd::Identity(q, q)));
      const Eigen::VectorXd t = score(system);
      const Eigen::VectorXd maxima = null_maxima(confusability(system), options.null_draws, rng);
      TestFamily test{exceedance(maxima, t.cwiseAbs().maxCoeff()), {}};
      std::vector<Misfit> found;
      for (std::size_t k = 0; k < bins.bins.size(); ++k) {
        const double statistic = t[static_cast<Eigen::Index>(k)];
        test.bin_p_values.push_back(normal_p_value(statistic));
        found.push_back(describe(context, none, families[f], bins.bins[k], statistic));
      }
      tests.push_back(std::move(test));
      described.push_back(std::move(found));
    }
  }
  const auto flags = findings(tests, options.rate);
  std::vector<Misfit> result;
  for (std::size_t i = 0; i < tests.size(); ++i) {
    const std::vector<double> adjusted = benjamini_yekutieli(tests[i].bin_p_values);
    for (std::size_t k = 0; k < described[i].size(); ++k) {
      if (!flags[i][k]) continue;
      described[i][k].adjusted_p = adjusted[k];
      result.push_back(std::move(described[i][k]));
    }
  }
  std::ranges::stable_sort(result, std::greater{},
                           [](const Misfit& finding) { return std::abs(finding.statistic); });
  return result;
}

}  // namespace recald::diagnosis
