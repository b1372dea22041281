#include <nlohmann/json.hpp>
#include <tuple>

#include "daemon/gateway/serve/api/api.hpp"
#include "daemon/gateway/serve/api/json_answer.hpp"
#include "daemon/gateway/serve/api/parameters.hpp"
#include "daemon/gateway/serve/api/shapes.hpp"

namespace recald::daemon {
namespace {

using Json = nlohmann::ordered_json;
using metering::Month;

/// The request and where to start: meters are in the order of the site file.
struct MonthQuery {
  const MeterConfig* meter = nullptr;  ///< Null: all.
  std::optional<Month> from;
  std::optional<Month> to;
  int limit = 0;
  std::size_t first_meter = 0;
  std::optional<Month> first_month;  ///< For the first meter.
};

/// "METER/2026-03": the first figure not yet sent.
Checked<void> take_cursor(MonthQuery& query, const Served& served, const http::Request& request) {
  const auto cursor = text_of(request, "cursor");
  if (!cursor) return {};
  const std::size_t slash = cursor->rfind('/');
  const auto meter = served.site.meter_index(cursor->substr(0, slash));
  const auto month = slash == std::string::npos ? Result<Month>{failure(ErrorCode::malformed, "")}
                                                : metering::parse_month(cursor->substr(slash + 1));
  if (!meter || !month) {
    return refusal(400, "invalid_value", "'cursor' is not one from a 'next' of this list",
                   "cursor");
  }
  query.first_meter = *meter;
  query.first_month = *month;
  return {};
}

Checked<MonthQuery> parse(const Served& served, const http::Request& request) {
  TRY(has_only(request, {"meter", "from", "to", "limit", "cursor"}));
  MonthQuery query;
  const auto meter = TRY(queried_meter(served.site, request));
  const auto from = TRY(month_of(request, "from"));
  const auto to = TRY(month_of(request, "to"));
  const auto limit = TRY(limit_of(request));
  query.meter = meter;
  query.from = from;
  query.to = to;
  query.limit = limit;
  TRY(take_cursor(query, served, request));
  return query;
}

}  // namespace

http::Response get_months(const Served& served, const http::Request& request) {
  const auto query = parse(served, request);
  if (!query) return query.error();
  Json months = Json::array();
  for (std::size_t m = query->first_meter; m < served.site.meters.size(); ++m) {
    const MeterConfig& meter = served.site.meters[m];
    if (!meter.is_stored() || (query->meter != nullptr && query->meter != &meter)) continue;
    const auto number = served.store.meter_number(meter.meter.id, meter.meter.interval);
    if (!number) return refusal(number.error()).value();
    const auto stored = served.store.months(*number);
    if (!stored) return refusal(stored.error()).value();
    for (const StoredMonth& one : *stored) {
      const metering::MonthlyFigure& figure = one.figure;
      if (query->from && figure.month < *query->from) continue;
      if (query->to && figure.month >= *query->to) continue;
      if (m == query->first_meter && query->first_month && figure.month < *query->first_month) {
        continue;
      }
      if (std::ssize(months) == query->limit) {
        return json_answer({{"months", months},
                            {"next", meter.meter.id + "/" + metering::to_string(figure.month)}});
      }
      months.push_back(month_json(meter.meter.id, figure));
    }
  }
  return json_answer({{"months", months}, {"next", nullptr}});
}

}  // namespace recald::daemon
