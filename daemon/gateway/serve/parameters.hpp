/// What a request's query says, checked; each mistake is an answer that says what to write instead.
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

/// A value, or the answer that refuses.
template <class T>
using Checked = tl::expected<T, http::Response>;

inline constexpr int kLimitMax = 10'000;
inline constexpr int kLimitUsual = 1'000;

[[nodiscard]] tl::unexpected<http::Response> refusal(int status, std::string_view code,
                                                     std::string_view message,
                                                     std::string_view field = "");
/// A failure of the store: 503, since it is tried again.
[[nodiscard]] tl::unexpected<http::Response> refusal(const Error& error);
/// 503 for what the store cannot take at present, with the time after which to send it again.
[[nodiscard]] http::Response not_taken(std::string_view message);

/// A query of no other names than these; a misspelt one would otherwise be taken for everything.
[[nodiscard]] Checked<void> has_only(const http::Request& request,
                                     std::initializer_list<std::string_view> names);

/// `from` and `to`, half open; absent ends are as early and as late as can be.
[[nodiscard]] Checked<metering::TimeSpan> span_of(const http::Request& request);

/// `name` as a month; nothing where it is absent.
[[nodiscard]] Checked<std::optional<metering::Month>> month_of(const http::Request& request,
                                                               const std::string& name);

/// `limit`, 1 to 10 000; 1 000 where it is absent.
[[nodiscard]] Checked<int> limit_of(const http::Request& request);

/// `name` as a whole number; absent where it is. @param what  What a valid value looks like.
[[nodiscard]] Checked<std::optional<std::int64_t>> whole_number_of(const http::Request& request,
                                                                   const std::string& name,
                                                                   std::string_view what);

/// A parameter as it was sent; nothing where it was not.
[[nodiscard]] std::optional<std::string> text_of(const http::Request& request,
                                                 const std::string& name);

/// The site's meter or weather sensor of that id, or 404.
[[nodiscard]] Checked<const MeterConfig*> meter_of(const SiteConfig& site, const std::string& id);

/// The `meter` of the query; nothing where it is absent.
[[nodiscard]] Checked<const MeterConfig*> queried_meter(const SiteConfig& site,
                                                        const http::Request& request);

}  // namespace recald::daemon
