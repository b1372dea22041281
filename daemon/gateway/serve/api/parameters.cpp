#include "daemon/gateway/serve/api/parameters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "adapters/csv/fields.hpp"
#include "core/text/nearest.hpp"

namespace recald::daemon {
namespace {

using metering::Instant;

Checked<std::optional<Instant>> instant_of(const http::Request& request, const std::string& name,
                                           const metering::LocalCalendar& calendar) {
  const auto text = text_of(request, name);
  if (!text) return std::optional<Instant>{};
  if (const auto day = metering::parse_day(*text)) {
    return std::optional{calendar.day_span(*day).begin};
  }
  const auto instant = csv::parse_timestamp(*text);
  if (!instant) {
    return refusal(400, "invalid_value",
                   fmt::format("'{}' is {}; write a date such as 2026-03-01, or a time such as "
                               "2026-03-01T00:00:00Z (write a + in an offset as %2B in a URL)",
                               name, csv::in_quotes(*text)),
                   name);
  }
  return std::optional{*instant};
}

}  // namespace

tl::unexpected<http::Response> refusal(int status, std::string_view code, std::string_view message,
                                       std::string_view field) {
  return tl::unexpected<http::Response>(http::error_response(status, code, message, field));
}

tl::unexpected<http::Response> refusal(const Error& error) {
  return refusal(503, "store_unavailable", "the store cannot be read: " + error.message);
}

http::Response not_taken(std::string_view message) {
  http::Response response = http::error_response(503, "store_unavailable", message);
  response.headers.emplace_back("Retry-After", "60");
  return response;
}

Checked<void> has_only(const http::Request& request,
                       std::initializer_list<std::string_view> names) {
  for (const auto& [name, value] : request.query) {
    if (std::ranges::find(names, name) != names.end()) continue;
    return refusal(400, "unknown_parameter",
                   fmt::format("there is no parameter {} on this route{}{}", csv::in_quotes(name),
                               names.size() == 0 ? "" : "; it accepts: ", fmt::join(names, ", ")),
                   name);
  }
  return {};
}

Checked<metering::TimeSpan> span_of(const http::Request& request,
                                    const metering::LocalCalendar& calendar) {
  const auto from = TRY(instant_of(request, "from", calendar));
  const auto to = TRY(instant_of(request, "to", calendar));
  const metering::TimeSpan span{from.value_or(Instant{}), to.value_or(metering::kLatestInstant)};
  if (span.end < span.begin) {
    return refusal(400, "invalid_value", "'to' is before 'from'", "to");
  }
  return span;
}

Checked<std::optional<std::int64_t>> whole_number_of(const http::Request& request,
                                                     const std::string& name,
                                                     std::string_view what) {
  const auto text = text_of(request, name);
  if (!text) return std::optional<std::int64_t>{};
  std::int64_t number = 0;
  const char* end = text->data() + text->size();
  const auto [stop, error] = std::from_chars(text->data(), end, number);
  if (error != std::errc{} || stop != end) {
    return refusal(400, "invalid_value",
                   fmt::format("'{}' is {}; write {}", name, csv::in_quotes(*text), what), name);
  }
  return std::optional{number};
}

Checked<std::optional<metering::Month>> month_of(const http::Request& request,
                                                 const std::string& name) {
  const auto text = text_of(request, name);
  if (!text) return std::optional<metering::Month>{};
  const auto month = metering::parse_month(*text);
  if (!month) {
    return refusal(
        400, "invalid_value",
        fmt::format("'{}' is {}; write a month such as 2026-03", name, csv::in_quotes(*text)),
        name);
  }
  return std::optional{*month};
}

Checked<int> limit_of(const http::Request& request) {
  constexpr std::string_view kWhat = "a whole number from 1 to 10000";
  const auto limit = TRY(whole_number_of(request, "limit", kWhat));
  const std::int64_t value = limit.value_or(kLimitUsual);
  if (value < 1 || value > kLimitMax) {
    return refusal(400, "invalid_value", fmt::format("'limit' is {}; write {}", value, kWhat),
                   "limit");
  }
  return static_cast<int>(value);
}

std::optional<std::string> text_of(const http::Request& request, const std::string& name) {
  const auto found = request.query.find(name);
  return found == request.query.end() ? std::nullopt : std::optional{found->second};
}

Checked<const MeterConfig*> meter_of(const SiteConfig& site, const std::string& id) {
  if (const auto index = site.meter_index(id)) return &site.meters[*index];
  if (const MeterConfig* const sensor = site.find_sensor(id)) return sensor;
  return refusal(404, "not_found",
                 fmt::format("site '{}' has no meter {}; GET /api/v1/meters lists the meters",
                             site.id, csv::in_quotes(id)),
                 "meter");
}

Checked<const MeterConfig*> queried_meter(const SiteConfig& site, const http::Request& request) {
  const auto id = text_of(request, "meter");
  if (!id) return nullptr;
  return meter_of(site, *id);
}

}  // namespace recald::daemon
