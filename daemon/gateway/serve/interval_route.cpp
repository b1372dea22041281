#include <fmt/format.h>

#include <algorithm>

#include "adapters/csv/fields.hpp"
#include "daemon/gateway/serve/api.hpp"
#include "daemon/gateway/serve/parameters.hpp"
#include "daemon/gateway/serve/shapes.hpp"

namespace recald::daemon {
namespace {

using metering::Instant;
using metering::TimeSpan;

/// The store cannot be stopped in the middle of a span, so it is asked for pieces of it.
constexpr int kPieceMin = 1'000;  // intervals: a gap of years is passed in few steps

struct Page {
  std::string intervals;  ///< JSON objects, separated by commas.
  int count = 0;
  std::optional<Instant> next;  ///< Start of the first that did not fit.
};

/// From the cursor on, where there is one: it is the start of the first interval not yet sent.
Checked<TimeSpan> span_from_cursor(const http::Request& request) {
  auto span = span_of(request);
  const auto cursor = text_of(request, "cursor");
  if (!span || !cursor) return span;
  const auto at = csv::parse_timestamp(*cursor);
  if (!at) return refusal(400, "invalid_value", "'cursor' is none that was given out", "cursor");
  span->begin = std::max(span->begin, *at);
  return span;
}

Result<Page> read_page(Store& store, std::uint32_t number, const metering::Meter& meter,
                       TimeSpan span, int limit) {
  Page page;
  const auto extent = store.interval_extent(number);
  if (!extent) return tl::unexpected(extent.error());
  if (!*extent) return page;
  span.begin = std::max(span.begin, (*extent)->begin);
  span.end = std::min(span.end, (*extent)->end + meter.interval);
  const auto piece = meter.interval * std::max(limit, kPieceMin);
  for (Instant at = span.begin; at < span.end && !page.next; at += piece) {
    const auto read = store.for_each_interval(
        number, {at, std::min(at + piece, span.end)}, [&](const StoredInterval& interval) {
          if (page.next) return;
          if (page.count == limit) {
            page.next = interval.reading.start;
            return;
          }
          if (page.count++ > 0) page.intervals += ',';
          page.intervals += interval_json(interval, meter.interval);
        });
    if (!read) return tl::unexpected(read.error());
  }
  return page;
}

}  // namespace

http::Response get_intervals(const Served& served, const http::Request& request) {
  if (const auto checked = has_only(request, {"meter", "from", "to", "limit", "cursor"});
      !checked) {
    return checked.error();
  }
  const auto meter = queried_meter(served.site, request);
  if (!meter) return meter.error();
  if (*meter == nullptr) {
    return http::error_response(400, "missing_parameter",
                                "'meter' is needed; GET /api/v1/meters lists the meters", "meter");
  }
  const auto span = span_from_cursor(request);
  if (!span) return span.error();
  const auto limit = limit_of(request);
  if (!limit) return limit.error();

  const metering::Meter& described = (*meter)->meter;
  Page page;
  // Asking would enter a meter that is read from its file; what was imported of it is for replays.
  if ((*meter)->is_stored()) {
    const auto number = served.store.meter_number(described.id, described.interval);
    if (!number) return refusal(number.error()).value();
    auto read = read_page(served.store, *number, described, *span, *limit);
    if (!read) return refusal(read.error()).value();
    page = std::move(*read);
  }
  return http::json_response(
      fmt::format(R"({{"meter":"{}","interval_s":{},"intervals":[{}],"next":{}}})"
                  "\n",
                  described.id, described.interval.count(), page.intervals,
                  page.next ? "\"" + metering::to_string(*page.next) + "\"" : "null"));
}

}  // namespace recald::daemon
