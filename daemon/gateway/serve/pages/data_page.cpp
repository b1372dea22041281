#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "adapters/views/frame/format.hpp"
#include "core/display/id_words.hpp"
#include "daemon/gateway/serve/pages/page_frame.hpp"
#include "daemon/gateway/serve/pages/pages.hpp"

namespace recald::daemon {
namespace {

using metering::MonthlyFigure;
using metering::Validity;
using views::Cell;
using views::Html;
using views::Table;

constexpr std::size_t kMonthsShown = 12;
constexpr double kMeasuredWell = 0.9;

/// A meter's closed months.
using Figures = std::map<metering::Month, MonthlyFigure>;

struct MeterData {
  const MeterConfig* config;
  Figures figures;
};

Result<std::vector<MeterData>> read_months(const Served& served) {
  std::vector<MeterData> all;
  for (const MeterConfig& config : served.site.meters) {
    if (!config.is_stored()) continue;
    MeterData meter{&config, {}};
    const auto number = TRY(served.store.find_meter(config.meter.id));
    const auto months = TRY(number ? served.store.months(*number)
                                   : Result<std::vector<StoredMonth>>{std::vector<StoredMonth>{}});
    for (const StoredMonth& month : months) meter.figures[month.figure.month] = month.figure;
    all.push_back(std::move(meter));
  }
  return all;
}

/// The newest months that any meter has, in order of time.
std::vector<metering::Month> months_shown(const std::vector<MeterData>& meters) {
  std::set<metering::Month> known;
  for (const MeterData& meter : meters) {
    for (const auto& [month, figure] : meter.figures) known.insert(month);
  }
  std::vector<metering::Month> shown{known.begin(), known.end()};
  if (shown.size() > kMonthsShown) {
    shown.erase(shown.begin(), shown.end() - static_cast<std::ptrdiff_t>(kMonthsShown));
  }
  return shown;
}

Cell measured_cell(const Figures& figures, metering::Month month) {
  const auto found = figures.find(month);
  if (found == figures.end()) return {"–", "number"};
  const MonthlyFigure& figure = found->second;
  const std::string share = views::percent_text(figure.coverage);
  if (!figure.usable) return {"✖ " + share, "number bad"};
  if (figure.coverage < kMeasuredWell) return {"▲ " + share, "number warn"};
  return {share, "number"};
}

void write_measured(Html& html, const std::vector<MeterData>& meters) {
  const std::vector<metering::Month> months = months_shown(meters);
  if (months.empty()) {
    html.element("p", "No month has closed yet.", "muted");
    return;
  }
  Table table{"Share of each month that was measured"};
  std::vector<std::string> columns{"Meter"};
  for (const metering::Month month : months) columns.push_back(views::month_text(month));
  table.with_labels().columns(std::move(columns));
  for (const MeterData& meter : meters) {
    std::vector<Cell> row{{meter.config->meter.id, "", "/meters/" + meter.config->meter.id}};
    for (const metering::Month month : months) row.push_back(measured_cell(meter.figures, month));
    table.row(std::move(row));
  }
  table.write(html);
  html.element(
      "p",
      "▲ is less than 90 %; the rest was filled by what the meter read at the same time on "
      "other days. ✖ is too little to be used.",
      "muted");
}

/// What the intervals of the shown months are, over all of them.
void write_validity(Html& html, const std::vector<MeterData>& meters) {
  const std::vector<metering::Month> months = months_shown(meters);
  if (months.empty()) return;
  const auto share_of = [&](const MeterData& meter, Validity validity) {
    std::int64_t slots = 0;
    std::int64_t found = 0;
    for (const metering::Month month : months) {
      const auto figure = meter.figures.find(month);
      if (figure == meter.figures.end()) continue;
      slots += figure->second.slots;
      found += figure->second.slots_by_validity[static_cast<std::size_t>(validity)];
    }
    const double share = slots > 0 ? static_cast<double>(found) / static_cast<double>(slots) : 0.0;
    return Cell{slots > 0 ? views::percent_text(share) : "–", "number"};
  };
  Table table{"The intervals of these months"};
  table.with_labels().columns(
      {"Meter", "Measured", "Filled", "Scaled", "Doubtful", "Missing", "Recomputed"});
  for (const MeterData& meter : meters) {
    const auto corrected = std::ranges::count_if(months, [&](metering::Month month) {
      const auto found = meter.figures.find(month);
      return found != meter.figures.end() && found->second.revision > 0;
    });
    table.row({{meter.config->meter.id, "", "/meters/" + meter.config->meter.id},
               share_of(meter, Validity::ok),
               share_of(meter, Validity::filled),
               share_of(meter, Validity::scaled),
               share_of(meter, Validity::suspect),
               share_of(meter, Validity::missing),
               {std::to_string(corrected), "number"}});
  }
  table.write(html);
}

/// "counter reset 2, late readings 96"; "–": nothing.
std::string doubts_of(const MeterStatus& status) {
  std::string words;
  const auto add = [&](const std::string& what, std::uint64_t count) {
    if (count == 0) return;
    words += fmt::format("{}{} {}", words.empty() ? "" : ", ", what, count);
  };
  for (const auto& [kind, count] : status.counters.events) add(display::id_words(kind), count);
  add("late readings", status.counters.late);
  if (status.poll) {
    for (const RefusedRegisters& one : status.poll->refused) {
      words += fmt::format("{}registers from {} refused", words.empty() ? "" : ", ", one.address);
    }
  }
  return words.empty() ? "–" : words;
}

void write_now(Html& html, const Served& served) {
  const GatewayStatus status = served.status();
  Table table{"Since recald was started"};
  table.with_labels().columns(
      {"Meter", "Measured this month", "Intervals", "Of them valid", "What was noticed"});
  for (const MeterStatus& meter : status.meters) {
    const auto& intervals = meter.counters.intervals;
    const std::uint64_t all = std::accumulate(intervals.begin(), intervals.end(), std::uint64_t{0});
    const double coverage = meter.open_month_coverage;
    const double valid =
        all > 0 ? static_cast<double>(intervals[static_cast<std::size_t>(Validity::ok)]) /
                      static_cast<double>(all)
                : 0.0;
    table.row({{meter.id, "", "/meters/" + meter.id},
               {std::isnan(coverage) ? "–" : views::percent_text(coverage),
                coverage < kMeasuredWell ? "number warn" : "number"},
               {std::to_string(all), "number"},
               {all > 0 ? views::percent_text(valid) : "–", "number"},
               {doubts_of(meter)}});
  }
  table.write(html);
}

}  // namespace

http::Response data_page(const Served& served) {
  Html html;
  html.element("h1", "Data");
  const auto meters = read_months(served);
  if (!meters) {
    html.element("p", "✖ The months cannot be read: " + meters.error().message, "bad");
    return page_of(served, PageKind::data, "Data", html);
  }
  write_measured(html, *meters);
  write_validity(html, *meters);
  write_now(html, served);
  return page_of(served, PageKind::data, "Data", html);
}

}  // namespace recald::daemon
