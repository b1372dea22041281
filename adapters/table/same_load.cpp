#include "adapters/table/same_load.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "adapters/table/cells/words.hpp"
#include "core/metering/units.hpp"

namespace recald::table {
namespace {

constexpr double kShareAgreeing = 0.98;
constexpr double kTolerance = 0.02;    // of a mean that is written with few digits
constexpr double kRounding_kW = 0.05;  // of the coarser of two
constexpr std::size_t kRowsMin = 24;   // that agree, where names do not say it

std::optional<metering::UnitConversion> conversion_of(const LoadColumn& column) {
  const auto conversion = metering::find_unit(column.unit, metering::Utility::electricity, {});
  return conversion ? std::optional{*conversion} : std::nullopt;
}

/// The name without the words that tell energy from power.
std::string bare_name(const std::string& name) {
  std::string text = folded(name);
  constexpr auto kWords = std::to_array<std::string_view>(
      {"energy",       "power",     "demand",   "load",        "use",     "usage",
       "max",          "maximum",   "peak",     "consumption", "active",  "average",
       "avg",          "mean",      "energie",  "leistung",    "arbeit",  "wirkarbeit",
       "wirkleistung", "verbrauch", "mittlere", "puissance",   "energia", "potencia",
       "consumo",      "potenza",   "vermogen", "verbruik",    "effekt",  "forbrug",
       "foerbrukning", "teho",      "kulutus",  "moc",         "zuzycie", "in",
       "kw",           "kwh",       "w",        "wh"});
  for (const std::string_view word : kWords) {
    const std::string whole = " " + std::string{word} + " ";
    for (std::size_t at = text.find(whole); at != std::string::npos; at = text.find(whole, at)) {
      text.replace(at, whole.size(), " ");
    }
  }
  return text;
}

/// A register: it hardly ever falls.
bool is_rising(const std::vector<double>& values) {
  std::size_t rises = 0;
  std::size_t falls = 0;
  for (std::size_t i = 1; i < values.size(); ++i) {
    if (values[i] > values[i - 1]) ++rises;
    if (values[i] < values[i - 1]) ++falls;
  }
  return rises >= 20 && 100 * falls <= rises;
}

struct Comparison {
  std::size_t compared = 0;  ///< Rows with a load in both.
  std::size_t agreeing = 0;
  std::optional<std::size_t> first_other;
};

Comparison compare(const LoadColumn& a, const LoadColumn& b, const metering::UnitConversion& of_a,
                   const metering::UnitConversion& of_b, std::chrono::seconds interval,
                   double rounding_kW) {
  Comparison found;
  const std::size_t count = std::min(a.values.size(), b.values.size());
  for (std::size_t i = 0; i < count; ++i) {
    if (std::isnan(a.values[i]) || std::isnan(b.values[i])) continue;
    const double first = of_a.mean_kW(a.values[i], interval);
    const double second = of_b.mean_kW(b.values[i], interval);
    const double most = std::max(std::abs(first), std::abs(second));
    if (most <= rounding_kW) continue;
    ++found.compared;
    if (std::abs(first - second) <= kTolerance * most + rounding_kW) {
      ++found.agreeing;
    } else if (!found.first_other) {
      found.first_other = i;
    }
  }
  return found;
}

}  // namespace

std::optional<SameLoad> same_load_of(std::span<const LoadColumn> columns, std::size_t index,
                                     std::chrono::seconds interval) {
  const auto own = conversion_of(columns[index]);
  if (!own || interval.count() <= 0) return {};
  for (std::size_t other = 0; other < columns.size(); ++other) {
    if (other == index) continue;
    const auto taken = conversion_of(columns[other]);
    // Energy rather than power; of two energies the first.
    const bool is_better = taken && !taken->is_rate && (own->is_rate || other < index);
    if (!is_better || (!own->is_rate && taken->factor == own->factor)) continue;
    const bool is_named_so = bare_name(columns[index].name) == bare_name(columns[other].name);
    if (is_named_so && is_rising(columns[other].values)) return SameLoad{other, true, 0};
    const Comparison found = compare(columns[index], columns[other], *own, *taken, interval,
                                     is_named_so ? kRounding_kW : kRounding_kW / 10.0);
    const bool agrees =
        found.compared > 0 &&
        static_cast<double>(found.agreeing) >= kShareAgreeing * static_cast<double>(found.compared);
    if (agrees && (is_named_so || found.compared >= kRowsMin)) return SameLoad{other, true, 0};
    if (is_named_so) return SameLoad{other, false, found.first_other.value_or(0)};
  }
  return {};
}

}  // namespace recald::table
