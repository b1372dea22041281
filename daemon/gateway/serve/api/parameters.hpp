/// Checks the query of a request; each mistake gives a response that says what to write instead.
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "adapters/http/message.hpp"
#include "core/metering/civil_time.hpp"
#include "daemon/site/config/site_config.hpp"

namespace recald::daemon {

/// A value, or the response that refuses the request.
template <class T>
using Checked = tl::expected<T, http::Response>;

inline constexpr int kLimitMax = 10'000;
inline constexpr int kLimitUsual = 1'000;

[[nodiscard]] tl::unexpected<http::Response> refusal(int status, std::string_view code,
                                                     std::string_view message,
                                                     std::string_view field = "");
/// A failure of the store: 503, since a retry may work.
[[nodiscard]] tl::unexpected<http::Response> refusal(const Error& error);
/// 503 for what cannot be stored at present, with the time after which to send it again.
[[nodiscard]] http::Response not_taken(std::string_view message);

/// Refuses other names than these; a misspelt filter would otherwise return everything.
[[nodiscard]] Checked<void> has_only(const http::Request& request,
                                     std::initializer_list<std::string_view> names);

/// `from` and `to`, half open; absent ends mean the earliest and latest times. Each is a time, or a
/// date, which means where that day begins at the site.
[[nodiscard]] Checked<metering::TimeSpan> span_of(const http::Request& request,
                                                  const metering::LocalCalendar& calendar);

/// `name` as a month; nothing if absent.
[[nodiscard]] Checked<std::optional<metering::Month>> month_of(const http::Request& request,
                                                               const std::string& name);

/// `limit`, 1 to 10 000; 1 000 if absent.
[[nodiscard]] Checked<int> limit_of(const http::Request& request);

/// `name` as a whole number; nothing if absent. @param what  What a valid value looks like.
[[nodiscard]] Checked<std::optional<std::int64_t>> whole_number_of(const http::Request& request,
                                                                   const std::string& name,
                                                                   std::string_view what);

/// A parameter as sent; nothing if it was not.
[[nodiscard]] std::optional<std::string> text_of(const http::Request& request,
                                                 const std::string& name);

/// The site's meter or weather sensor with this id, or 404.
[[nodiscard]] Checked<const MeterConfig*> meter_of(const SiteConfig& site, const std::string& id);

/// The `meter` of the query; nothing if absent.
[[nodiscard]] Checked<const MeterConfig*> queried_meter(const SiteConfig& site,
                                                        const http::Request& request);

}  // namespace recald::daemon
