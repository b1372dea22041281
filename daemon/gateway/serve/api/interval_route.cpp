#include <fmt/format.h>

#include <algorithm>

#include "adapters/csv/fields.hpp"
#include "daemon/gateway/serve/api/api.hpp"
#include "daemon/gateway/serve/api/history.hpp"
#include "daemon/gateway/serve/api/parameters.hpp"
#include "daemon/gateway/serve/api/shapes.hpp"
#include "daemon/site/config/weather_sensors.hpp"

namespace recald::daemon {
namespace {

using metering::Instant;
using metering::TimeSpan;

constexpr int kPointsUsual = 500;
constexpr int kPointsMax = 5'000;
/// A query of the store cannot be stopped within a span, so the span is read in pieces.
constexpr int kPieceMin = 1'000;  // intervals; a gap of years takes few steps

struct Page {
  std::string intervals;  ///< JSON objects, separated by commas.
  int count = 0;
  std::optional<Instant> next;  ///< Start of the first interval that did not fit.
};

/// The span from the cursor on, if there is one: the start of the first interval not yet sent.
Checked<TimeSpan> span_from_cursor(const Served& served, const http::Request& request) {
  auto span = span_of(request, served.calendar);
  const auto cursor = text_of(request, "cursor");
  if (!span || !cursor) return span;
  const auto at = csv::parse_timestamp(*cursor);
  if (!at)
    return refusal(400, "invalid_value", "'cursor' is not one from a 'next' of this list",
                   "cursor");
  span->begin = std::max(span->begin, *at);
  return span;
}

/// The meter, or the quantity of a weather sensor, whose intervals a query asks for.
struct Queried {
  metering::Meter meter;  ///< As stored.
  const weather::SensorQuantity* quantity = nullptr;
  bool is_stored = false;
};

Checked<Queried> queried(const SiteConfig& site, const http::Request& request) {
  const std::string id = text_of(request, "meter").value_or("");
  if (id.empty()) {
    return refusal(400, "missing_parameter",
                   "'meter' is needed; GET /api/v1/meters lists the meters", "meter");
  }
  if (const auto channel = find_channel(site, id)) {
    return Queried{stored_meter(*site.find_sensor(channel->sensor), *channel), channel->quantity,
                   true};
  }
  const auto meter = TRY(meter_of(site, id));
  if (meter->role == MeterRole::weather) {
    return refusal(400, "invalid_value",
                   fmt::format("'{}' is a weather sensor and has separate intervals for each "
                               "quantity; ask for {}.dry_bulb_C, for example",
                               id, id),
                   "meter");
  }
  return Queried{meter->meter, nullptr, meter->is_stored()};
}

Result<Page> read_page(Store& store, std::uint32_t number, const Queried& asked, TimeSpan span,
                       int limit) {
  const metering::Meter& meter = asked.meter;
  Page page;
  const auto extent = TRY(store.interval_extent(number));
  if (!extent) return page;
  span.begin = std::max(span.begin, extent->begin);
  span.end = std::min(span.end, extent->end + meter.interval);
  const auto piece = meter.interval * std::max(limit, kPieceMin);
  for (Instant at = span.begin; at < span.end && !page.next; at += piece) {
    TRY(store.for_each_interval(
        number, {at, std::min(at + piece, span.end)}, [&](const StoredInterval& interval) {
          if (page.next) return;
          if (page.count == limit) {
            page.next = interval.reading.start;
            return;
          }
          if (page.count++ > 0) page.intervals += ',';
          page.intervals += asked.quantity != nullptr ? weather_interval_json(interval)
                                                      : interval_json(interval, meter.interval);
        }));
  }
  return page;
}

}  // namespace

http::Response get_intervals(const Served& served, const http::Request& request) {
  if (const auto checked = has_only(request, {"meter", "from", "to", "limit", "cursor"});
      !checked) {
    return checked.error();
  }
  const auto asked = queried(served.site, request);
  if (!asked) return asked.error();
  const auto span = span_from_cursor(served, request);
  if (!span) return span.error();
  const auto limit = limit_of(request);
  if (!limit) return limit.error();

  const metering::Meter& described = asked->meter;
  Page page;
  // Looking it up would register a meter that is read from a file; its imported readings
  // are for replays.
  if (asked->is_stored) {
    const auto number = served.store.meter_number(described.id, described.interval);
    if (!number) return refusal(number.error()).value();
    auto read = read_page(served.store, *number, *asked, *span, *limit);
    if (!read) return refusal(read.error()).value();
    page = std::move(*read);
  }
  const std::string unit =
      asked->quantity == nullptr ? "" : fmt::format(R"("unit":"{}",)", asked->quantity->unit);
  return http::json_response(
      fmt::format(R"({{"meter":"{}","interval_s":{},{}"intervals":[{}],"next":{}}})"
                  "\n",
                  described.id, described.interval.count(), unit, page.intervals,
                  page.next ? "\"" + metering::to_string(*page.next) + "\"" : "null"));
}

http::Response get_history(const Served& served, const http::Request& request) {
  if (const auto checked = has_only(request, {"meter", "from", "to", "points"}); !checked) {
    return checked.error();
  }
  const auto asked = queried(served.site, request);
  if (!asked) return asked.error();
  const auto span = span_of(request, served.calendar);
  if (!span) return span.error();
  constexpr std::string_view kWhat = "a whole number from 1 to 5000";
  const auto points = whole_number_of(request, "points", kWhat);
  if (!points) return points.error();
  const std::int64_t points_max = points->value_or(kPointsUsual);
  if (points_max < 1 || points_max > kPointsMax) {
    return refusal(400, "invalid_value", fmt::format("'points' is {}; write {}", points_max, kWhat),
                   "points")
        .value();
  }
  History history{asked->meter.interval, {}};
  if (asked->is_stored) {
    const auto number = served.store.meter_number(asked->meter.id, asked->meter.interval);
    if (!number) return refusal(number.error()).value();
    auto read = read_history(served.store, *number, asked->meter.interval, *span,
                             static_cast<int>(points_max));
    if (!read) return refusal(read.error()).value();
    history = std::move(*read);
  }
  const std::string unit = asked->quantity == nullptr ? "kW" : std::string{asked->quantity->unit};
  std::string list;
  for (const HistoryPoint& point : history.points) {
    if (!list.empty()) list += ',';
    list += history_point_json(point);
  }
  return http::json_response(
      fmt::format(R"({{"meter":"{}","step_s":{},"unit":"{}","points":[{}],"next":null}})"
                  "\n",
                  asked->meter.id, history.step.count(), unit, list));
}

}  // namespace recald::daemon
