#include "adapters/table/loads/meter_parts.hpp"

#include <algorithm>
#include <cmath>

#include "adapters/csv/fields.hpp"
#include "core/absent.hpp"

namespace recald::table {
namespace {

using metering::Instant;
using std::chrono::seconds;

constexpr std::size_t kRefusedListed = 3;

std::vector<std::string> with_first(const std::string& first,
                                    const std::vector<std::string>& further) {
  std::vector<std::string> all{first};
  all.insert(all.end(), further.begin(), further.end());
  return all;
}

/// Values of a meter's parts in the intervals that any of them has.
struct AlignedParts {
  std::vector<Instant> starts;  ///< In order of time.
  seconds interval;
  std::vector<std::vector<double>> values;  ///< By part and interval; NaN: none.
  std::vector<bool> are_estimates;          ///< Of each interval at least one value.

  [[nodiscard]] std::size_t intervals() const { return starts.size(); }
  [[nodiscard]] double at(std::size_t part, std::size_t i) const { return values[part][i]; }

  [[nodiscard]] std::size_t present(std::size_t i) const {
    return static_cast<std::size_t>(std::count_if(
        values.begin(), values.end(), [&](const auto& part) { return std::isfinite(part[i]); }));
  }

  /// Whether the part has a value before and behind an interval in which it has none.
  [[nodiscard]] bool is_hole(std::size_t part, std::size_t i) const {
    return i > 0 && i + 1 < intervals() && starts[i - 1] == starts[i] - interval &&
           starts[i + 1] == starts[i] + interval && !std::isfinite(at(part, i)) &&
           std::isfinite(at(part, i - 1)) && std::isfinite(at(part, i + 1));
  }

  /// Whether most intervals with a value have one of every part.
  [[nodiscard]] bool are_all_there() const {
    std::size_t any = 0;
    std::size_t all = 0;
    for (std::size_t i = 0; i < intervals(); ++i) {
      const std::size_t count = present(i);
      if (count > 0) ++any;
      if (count == values.size()) ++all;
    }
    return 2 * all >= any;
  }

  [[nodiscard]] double sum(std::size_t i, bool needs_all) const {
    double sum_kW = 0.0;
    bool has_value = false;
    for (std::size_t part = 0; part < values.size(); ++part) {
      const double value = at(part, i);
      if (std::isfinite(value)) {
        sum_kW += value;
        has_value = true;
      } else if (needs_all || is_hole(part, i)) {
        return kAbsent;
      }
    }
    return has_value ? sum_kW : kAbsent;
  }
};

}  // namespace

std::string part_words(const TableMeter& part) {
  return csv::in_quotes(part.rows.name.empty() ? part.column : part.rows.name);
}

MeterParts::MeterParts(std::span<const TableMeter> meters) : meters_(meters.begin(), meters.end()) {
  for (std::size_t i = 0; i < meters_.size(); ++i) {
    first_.push_back(parts_.size());
    const TableMeter& meter = meters_[i];
    for (const std::string& name : with_first(meter.rows.name, meter.further_names)) {
      for (const std::string& column : with_first(meter.column, meter.further_columns)) {
        TableMeter part{meter.rows, column, meter.unit};
        part.rows.name = name;
        parts_.push_back(std::move(part));
        kept_.push_back({.meter = i});
      }
    }
  }
  first_.push_back(parts_.size());
}

std::span<const MeterParts::Part> MeterParts::parts_of(std::size_t meter) const {
  return std::span{kept_}.subspan(first_[meter], first_[meter + 1] - first_[meter]);
}

csv::ReadingsSink MeterParts::sink(const csv::ReadingsSink& outer) {
  outer_ = &outer;
  if (parts_.size() == meters_.size()) return outer;
  csv::ReadingsSink inner;
  inner.on_meter = [this](const csv::MeterInFile& shown) {
    Part& part = kept_[shown.meter];
    part.shown = shown;
    if (parts_of(part.meter).size() > 1 || !outer_->on_meter) return;
    part.shown.meter = static_cast<std::uint32_t>(part.meter);
    outer_->on_meter(part.shown);
  };
  inner.on_reading = [this](const metering::Reading& reading) {
    Part& part = kept_[reading.meter];
    if (first_[part.meter + 1] - first_[part.meter] > 1) {
      const bool is_usable = reading.validity == metering::Validity::ok ||
                             reading.validity == metering::Validity::scaled;
      part.readings.push_back({reading.start, is_usable ? reading.mean_kW : kAbsent,
                               reading.validity == metering::Validity::scaled});
    } else if (outer_->on_reading) {
      metering::Reading of_meter = reading;
      of_meter.meter = static_cast<std::uint32_t>(part.meter);
      outer_->on_reading(of_meter);
    }
  };
  if (!outer.on_row) return inner;
  // What a meter's rows are like, its first part shows.
  inner.on_row = [this](const csv::RawRow& row) {
    const std::size_t meter = kept_[row.meter].meter;
    if (first_[meter] != row.meter) return;
    csv::RawRow of_meter = row;
    of_meter.meter = static_cast<std::uint32_t>(meter);
    outer_->on_row(of_meter);
  };
  return inner;
}

Result<void> MeterParts::require_one_grid(std::size_t meter) const {
  const auto all = parts_of(meter);
  const auto words = [&](std::size_t part) { return part_words(parts_[first_[meter] + part]); };
  for (std::size_t i = 0; i < all.size(); ++i) {
    const csv::MeterInFile& shown = all[i].shown;
    if (shown.interval == seconds{0}) {
      return failure(ErrorCode::not_enough_data,
                     "no usable row of " + words(i) + ", which is to be added to " +
                         words(i == 0 ? 1 : 0) + "; is it written as in the file?");
    }
    const csv::MeterInFile& first = all.front().shown;
    if (shown.interval == first.interval && shown.phase == first.phase) continue;
    return failure(ErrorCode::invalid_value,
                   words(0) + " reads every " + std::to_string(first.interval.count()) + " s and " +
                       words(i) + " every " + std::to_string(shown.interval.count()) +
                       " s, or at other times; they cannot be added up");
  }
  return {};
}

void MeterParts::hand_out(std::size_t meter, csv::MeterReport& report) const {
  const auto all = parts_of(meter);
  AlignedParts aligned{
      .starts = {}, .interval = report.shown.interval, .values = {}, .are_estimates = {}};
  for (const Part& part : all) {
    for (const KeptReading& one : part.readings) aligned.starts.push_back(one.start);
  }
  std::ranges::sort(aligned.starts);
  // clang 14 cannot compile what std::ranges::unique returns.
  aligned.starts.erase(std::unique(aligned.starts.begin(), aligned.starts.end()),
                       aligned.starts.end());
  aligned.values.assign(all.size(), std::vector<double>(aligned.starts.size(), kAbsent));
  aligned.are_estimates.assign(aligned.starts.size(), false);
  for (std::size_t part = 0; part < all.size(); ++part) {
    for (const KeptReading& one : all[part].readings) {
      const auto place = std::ranges::lower_bound(aligned.starts, one.start);
      const auto i = static_cast<std::size_t>(place - aligned.starts.begin());
      double& value = aligned.values[part][i];
      // As elsewhere, the first reading of an interval counts.
      if (std::isfinite(value)) continue;
      value = one.mean_kW;
      if (one.is_estimate) aligned.are_estimates[i] = true;
    }
  }
  if (outer_->on_meter) outer_->on_meter(report.shown);
  if (aligned.starts.empty()) return;
  const bool needs_all = aligned.are_all_there();
  for (std::size_t i = 0; i < aligned.intervals(); ++i) {
    metering::Reading reading{.meter = static_cast<std::uint32_t>(meter),
                              .start = aligned.starts[i],
                              .mean_kW = aligned.sum(i, needs_all)};
    if (aligned.are_estimates[i] && std::isfinite(reading.mean_kW)) {
      reading.validity = metering::Validity::scaled;
      reading.reasons = metering::Reason::estimated;
    }
    ++report.readings;
    if (std::isnan(reading.mean_kW)) ++report.blanks;
    if (outer_->on_reading) outer_->on_reading(reading);
  }
  report.span =
      metering::TimeSpan{aligned.starts.front(), aligned.starts.back() + report.shown.interval};
}

csv::MeterReport MeterParts::joined_report(std::size_t meter,
                                           std::span<csv::MeterReport> parts) const {
  csv::MeterReport joined;
  joined.shown = parts.front().shown;
  joined.shown.meter = static_cast<std::uint32_t>(meter);
  joined.steps = parts.front().steps;
  for (csv::MeterReport& part : parts) {
    joined.unsorted += part.unsorted;
    joined.duplicates += part.duplicates;
    joined.off_grid += part.off_grid;
    joined.refused += part.refused;
    joined.beside_max = std::max(joined.beside_max, part.beside_max);
    for (csv::LineIssue& issue : part.first_refused) {
      if (joined.first_refused.size() < kRefusedListed) {
        joined.first_refused.push_back(std::move(issue));
      }
    }
  }
  return joined;
}

Result<csv::ReadingsReport> MeterParts::finish(csv::ReadingsReport report) {
  std::vector<csv::MeterReport> of_parts = std::move(report.meters);
  report.meters.clear();
  report.readings = 0;
  for (std::size_t i = 0; i < meters_.size(); ++i) {
    const std::size_t count = first_[i + 1] - first_[i];
    if (count == 1) {
      csv::MeterReport one = std::move(of_parts[first_[i]]);
      one.shown.meter = static_cast<std::uint32_t>(i);
      report.meters.push_back(std::move(one));
    } else {
      TRY(require_one_grid(i));
      report.meters.push_back(joined_report(i, std::span{of_parts}.subspan(first_[i], count)));
      hand_out(i, report.meters.back());
    }
    report.readings += report.meters.back().readings;
  }
  return report;
}

}  // namespace recald::table
