#include "daemon/site/setup/joined_exports.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace recald::daemon {
namespace {

bool is_guessed(const Guess<csv::Stamps>& stamps) { return stamps.because.starts_with("guessed"); }

bool is_same_meter(const SurveyedMeter& a, const SurveyedMeter& b) {
  return a.name == b.name && a.name_in_file == b.name_in_file && a.column == b.column &&
         a.further_names == b.further_names && a.further_columns == b.further_columns &&
         a.unit.value == b.unit.value && a.utility.value == b.utility.value &&
         a.interval == b.interval && a.is_register == b.is_register &&
         (a.stamps.value == b.stamps.value || is_guessed(a.stamps) || is_guessed(b.stamps));
}

bool follows(const metering::TimeSpan& later, const metering::TimeSpan& earlier) {
  constexpr auto kSeam = std::chrono::hours{48};
  return later.begin > earlier.begin && later.end > earlier.end &&
         later.begin + kSeam >= earlier.end;
}

/// Whether `later` goes on where `earlier` ends.
bool goes_on(const SurveyedExport& later, const SurveyedExport& earlier) {
  if (later.table.has_value() != earlier.table.has_value()) return false;
  if (later.table && later.table->shape != earlier.table->shape) return false;
  return std::ranges::equal(later.meters, earlier.meters,
                            [](const SurveyedMeter& b, const SurveyedMeter& a) {
                              return is_same_meter(a, b) && follows(b.span, a.span);
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
  if (is_guessed(meter.stamps)) meter.stamps = more.stamps;
  meter.rated_kW = std::max(meter.rated_kW, more.rated_kW);
  meter.readings += more.readings;
  meter.refused += more.refused;
  meter.span.end = more.span.end;
  for (const auto& [start, mean_kW] : more.samples.kept()) meter.samples.take(start, mean_kW);
}

void join(SurveyedExport& one, SurveyedExport more) {
  one.files.insert(one.files.end(), more.files.begin(), more.files.end());
  one.notes.insert(one.notes.end(), more.notes.begin(), more.notes.end());
  for (std::size_t i = 0; i < one.meters.size(); ++i) join(one.meters[i], more.meters[i]);
}

metering::Instant first_start(const SurveyedExport& one) {
  return std::ranges::min(one.meters, {},
                          [](const SurveyedMeter& meter) { return meter.span.begin; })
      .span.begin;
}

}  // namespace

std::vector<SurveyedExport> joined_exports(std::vector<SurveyedExport> exports) {
  std::vector<std::size_t> by_time(exports.size());
  std::iota(by_time.begin(), by_time.end(), std::size_t{0});
  std::ranges::stable_sort(by_time, {}, [&](std::size_t i) { return first_start(exports[i]); });
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
  return joined;
}

}  // namespace recald::daemon
