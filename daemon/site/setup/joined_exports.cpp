#include "daemon/site/setup/joined_exports.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include "adapters/csv/fields.hpp"

namespace recald::daemon {
namespace {

bool is_guessed(const Guess<csv::Stamps>& stamps) { return stamps.because.starts_with("guessed"); }

bool are_multiples(std::chrono::seconds a, std::chrono::seconds b) {
  return std::max(a, b) % std::min(a, b) == std::chrono::seconds{0};
}

bool is_same_meter(const SurveyedMeter& a, const SurveyedMeter& b) {
  const bool is_called_alike = a.name == b.name || (a.is_named_by_file && b.is_named_by_file);
  return is_called_alike && a.name_in_file == b.name_in_file && a.column == b.column &&
         a.further_names == b.further_names && a.further_columns == b.further_columns &&
         a.unit.value == b.unit.value && a.utility.value == b.utility.value &&
         are_multiples(a.interval, b.interval) && a.is_register == b.is_register &&
         (a.stamps.value == b.stamps.value || is_guessed(a.stamps) || is_guessed(b.stamps));
}

/// Of the values that both have at a stamp, the share that is the same; nothing: they share none.
std::optional<double> share_alike(const SampledReadings& a, const SampledReadings& b) {
  std::size_t common = 0;
  std::size_t alike = 0;
  for (const auto& [start, value] : a.kept()) {
    const auto other = b.kept().find(start);
    if (other == b.kept().end()) continue;
    if (value == 0.0 && other->second == 0.0) continue;  // many meters rest at night
    ++common;
    const double apart = std::abs(value - other->second);
    if (apart <= 1e-6 * std::max(std::abs(value), std::abs(other->second))) ++alike;
  }
  if (common == 0) return {};
  return static_cast<double>(alike) / static_cast<double>(common);
}

/// One after the other, a day at the seam in both or neither; or a time that both have, where
/// corrections make for less than half of it.
bool continues(const SurveyedMeter& later, const SurveyedMeter& earlier) {
  constexpr auto kSeam = std::chrono::hours{48};
  constexpr double kCorrectedMax = 0.5;
  const bool is_near =
      later.span.begin <= earlier.span.end + kSeam && earlier.span.begin <= later.span.end + kSeam;
  if (!is_near) return false;
  // Of the days at the seam of two downloads all may have been corrected since.
  constexpr int kShort = 4;  // times in the shorter of the two
  const auto common =
      std::min(later.span.end, earlier.span.end) - std::max(later.span.begin, earlier.span.begin);
  constexpr auto kFewDays = std::chrono::hours{72};
  const auto shorter = std::min(later.span.length(), earlier.span.length());
  if (common <= kFewDays || kShort * common <= shorter) return true;
  if (const auto alike = share_alike(later.samples, earlier.samples)) {
    return *alike >= kCorrectedMax;
  }
  return later.span.begin + kSeam >= earlier.span.end ||
         earlier.span.begin + kSeam >= later.span.end;
}

/// Whether two exports are of the same meters.
bool goes_on(const SurveyedExport& later, const SurveyedExport& earlier) {
  if (later.table.has_value() != earlier.table.has_value()) return false;
  if (later.table && later.table->shape != earlier.table->shape) return false;
  return std::ranges::equal(later.meters, earlier.meters,
                            [](const SurveyedMeter& b, const SurveyedMeter& a) {
                              return is_same_meter(a, b) && continues(b, a);
                            });
}

void join(SurveyedMeter& meter, const SurveyedMeter& more) {
  const auto before = static_cast<double>(meter.readings);
  const auto added = static_cast<double>(more.readings);
  const auto mean = [&](double& share, double other) {
    share = (before * share + added * other) / (before + added);
  };
  mean(meter.zero_share, more.zero_share);
  mean(meter.frozen_share, more.frozen_share);
  mean(meter.negative_share, more.negative_share);
  const auto hours = [](const SurveyedMeter& one) {
    return static_cast<double>(one.values) * metering::in_hours(one.interval);
  };
  const double hours_before = hours(meter);
  const double hours_added = hours(more);
  meter.mean_kW = (hours_before * meter.mean_kW + hours_added * more.mean_kW) /
                  std::max(hours_before + hours_added, 1e-9);
  if (is_guessed(meter.stamps)) meter.stamps = more.stamps;
  meter.as_register.rated_kW = std::max(meter.as_register.rated_kW, more.as_register.rated_kW);
  if (meter.interval != more.interval) meter.is_of_other_steps = true;
  meter.interval = std::max(meter.interval, more.interval);
  meter.values =
      static_cast<std::uint64_t>((hours_before + hours_added) / metering::in_hours(meter.interval));
  meter.grid_tolerance = std::max(meter.grid_tolerance, more.grid_tolerance);
  meter.readings += more.readings;
  meter.refused += more.refused;
  meter.span.begin = std::min(meter.span.begin, more.span.begin);
  meter.span.end = std::max(meter.span.end, more.span.end);
  for (const auto& [start, mean_kW] : more.samples.kept()) meter.samples.take(start, mean_kW);
}

/// That a meter's files come at different steps; empty: they do not.
std::string step_note(const SurveyedExport& one, const SurveyedExport& more) {
  for (std::size_t i = 0; i < one.meters.size(); ++i) {
    const auto before = one.meters[i].interval;
    const auto now = more.meters[i].interval;
    if (before == now) continue;
    return fmt::format(
        "'{}' has {} every {} min, earlier files every {} min; the longer step counts.",
        more.files.front().string(), csv::in_quotes(one.meters[i].name), now.count() / 60,
        before.count() / 60);
  }
  return {};
}

/// What two files say of the same days; empty: the same, or none.
std::string overlap_note(const SurveyedExport& one, const SurveyedExport& more) {
  for (std::size_t i = 0; i < one.meters.size(); ++i) {
    const auto alike = share_alike(more.meters[i].samples, one.meters[i].samples);
    if (!alike || *alike == 1.0) continue;
    return fmt::format(
        "'{}' has other values than earlier files for some days of {}; those of the file that is "
        "later in the list count.",
        more.files.front().string(), csv::in_quotes(one.meters[i].name));
  }
  return {};
}

void join(SurveyedExport& one, SurveyedExport more) {
  std::string note = overlap_note(one, more);
  if (!note.empty()) one.notes.push_back(std::move(note));
  if (std::string steps = step_note(one, more); !steps.empty()) {
    one.notes.push_back(std::move(steps));
  }
  one.files.insert(one.files.end(), more.files.begin(), more.files.end());
  one.notes.insert(one.notes.end(), more.notes.begin(), more.notes.end());
  for (std::size_t i = 0; i < one.meters.size(); ++i) join(one.meters[i], more.meters[i]);
}

/// Meters of several files that are called alike, as "Reading" in each, are called by their files.
void name_by_files(std::vector<SurveyedExport>& exports) {
  std::map<std::string, int> called;
  for (const SurveyedExport& one : exports) {
    if (one.meters.size() == 1) ++called[one.meters.front().name];
  }
  for (SurveyedExport& one : exports) {
    if (one.meters.size() != 1 || called[one.meters.front().name] < 2) continue;
    one.meters.front().name = one.files.front().stem().string();
  }
}

metering::Instant last_end(const SurveyedExport& one) {
  return std::ranges::max(one.meters, {}, [](const SurveyedMeter& meter) { return meter.span.end; })
      .span.end;
}

}  // namespace

std::vector<SurveyedExport> joined_exports(std::vector<SurveyedExport> exports) {
  // What was downloaded later ends later; of files that end together, what is named later.
  std::vector<std::size_t> by_time(exports.size());
  std::iota(by_time.begin(), by_time.end(), std::size_t{0});
  std::ranges::stable_sort(by_time, {}, [&](std::size_t i) { return last_end(exports[i]); });
  std::vector<std::size_t> heads;  // that others are joined to
  for (const std::size_t i : by_time) {
    const auto head = std::ranges::find_if(
        heads, [&](std::size_t other) { return goes_on(exports[i], exports[other]); });
    if (head == heads.end()) {
      heads.push_back(i);
    } else {
      join(exports[*head], std::move(exports[i]));
    }
  }
  std::ranges::sort(heads);
  std::vector<SurveyedExport> joined;
  for (const std::size_t i : heads) joined.push_back(std::move(exports[i]));
  name_by_files(joined);
  return joined;
}

}  // namespace recald::daemon
