#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>
#include <string_view>
#include <vector>

#include "daemon/gateway/serve/api/api.hpp"
#include "daemon/gateway/serve/api/csv_answer.hpp"
#include "daemon/gateway/serve/api/metrics.hpp"
#include "daemon/gateway/serve/api/readiness.hpp"
#include "daemon/gateway/serve/api/served.hpp"
#include "daemon/gateway/serve/openapi.hpp"
#include "daemon/gateway/serve/pages/pages.hpp"

namespace recald::daemon {
namespace {

using http::Method;
using http::Request;
using http::Response;

constexpr std::string_view kApi = "/api/v1/";

/// The handlers of a path. `id` is the part after the path's last '/', if the route has one.
struct Route {
  std::string_view path;
  bool has_id;
  Response (*get)(const Served&, const Request&, const std::string& id);
  Response (*post)(const Served&, const Request&);
  Response (*remove)(const Served&, const std::string& id) = nullptr;
  std::span<const CsvColumn> columns = {};  ///< Of a list that may be asked for as CSV.
};

template <Response (*list)(const Served&, const Request&)>
Response without_id(const Served& served, const Request& request, const std::string&) {
  return list(served, request);
}

template <Response (*one)(const Served&, const std::string& id)>
Response with_id(const Served& served, const Request&, const std::string& id) {
  return one(served, id);
}

template <Response (*page)(const Served&)>
Response plain(const Served& served, const Request&, const std::string&) {
  return page(served);
}

Response get_openapi(const Served&) { return http::json_response(std::string{kOpenApi}); }

constexpr std::array kApiRoutes{
    Route{"openapi.json", false, plain<get_openapi>, nullptr},
    Route{"sites", false, without_id<get_sites>, nullptr},
    Route{"meters", false, without_id<get_meters>, nullptr},
    Route{"meters", true, with_id<get_meter>, nullptr},
    Route{"intervals", false, without_id<get_intervals>, nullptr, nullptr, kIntervalColumns},
    Route{"history", false, without_id<get_history>, nullptr, nullptr, kHistoryColumns},
    Route{"months", false, without_id<get_months>, nullptr, nullptr, kMonthColumns},
    Route{"events", false, without_id<get_events>, nullptr, nullptr, kEventColumns},
    Route{"forecasts", false, without_id<get_forecasts>, nullptr, nullptr, kForecastColumns},
    Route{"drift", false, without_id<get_drift>, nullptr},
    Route{"calibrations", false, without_id<get_jobs<JobKind::calibration>>,
          post_job<JobKind::calibration>},
    Route{"calibrations", true, with_id<get_job<JobKind::calibration>>, nullptr,
          cancel_job<JobKind::calibration>},
    Route{"diagnoses", false, without_id<get_jobs<JobKind::diagnosis>>,
          post_job<JobKind::diagnosis>},
    Route{"diagnoses", true, with_id<get_job<JobKind::diagnosis>>, nullptr,
          cancel_job<JobKind::diagnosis>},
    Route{"model", false, without_id<get_model>, post_model},
    Route{"readings", false, nullptr, post_readings},
};

Response get_health(const Served&) { return health(); }

/// Browsers ask for it on their own, and would note a failure.
Response no_icon(const Served&) {
  return {.status = 204, .headers = {{"Cache-Control", "private, max-age=86400"}}};
}

Response show_meter(const Served& served, const Request& request, const std::string& id) {
  return meter_page(served, request, id);
}

constexpr std::array kPages{
    Route{"", false, plain<now_page>, nullptr},
    Route{"meters", true, show_meter, nullptr},
    Route{"months", false, plain<months_page>, nullptr},
    Route{"model", false, plain<model_page>, nullptr},
    Route{"jobs", true, with_id<job_file>, nullptr},
    Route{"data", false, plain<data_page>, nullptr},
    Route{"events", false, without_id<events_page>, nullptr},
    Route{"style.css", false, plain<page_style>, nullptr},
    Route{"page.js", false, plain<page_script>, nullptr},
    Route{"charts.js", false, plain<charts_script>, nullptr},
    Route{"favicon.ico", false, plain<no_icon>, nullptr},
    Route{"healthz", false, plain<get_health>, nullptr},
    Route{"readyz", false, plain<readiness>, nullptr},
    Route{"metrics", false, plain<metrics>, nullptr},
};

Response not_allowed(const Route& route) {
  Response response =
      http::error_response(405, "method_not_allowed", "this route does not support that method");
  std::vector<std::string_view> allowed;
  if (route.get != nullptr) allowed.emplace_back("GET, HEAD");
  if (route.post != nullptr) allowed.emplace_back("POST");
  if (route.remove != nullptr) allowed.emplace_back("DELETE");
  response.headers.emplace_back("Allow", fmt::format("{}", fmt::join(allowed, ", ")));
  return response;
}

/// A list that may be asked for as CSV.
Response list_of(const Route& route, const Served& served, const Request& request) {
  const auto is_csv = wants_csv(request);
  if (!is_csv) return is_csv.error();
  Request plain = request;
  plain.query.erase("format");
  Response response = route.get(served, plain, "");
  if (*is_csv && response.status == 200) response = as_csv(request, response, route.columns);
  response.headers.emplace_back("Vary", "Accept");
  return response;
}

Response take(const Route& route, const Served& served, const Request& request,
              const std::string& id) {
  const bool reads = request.method == Method::get || request.method == Method::head;
  if (reads && !route.columns.empty()) return list_of(route, served, request);
  if (reads && route.get != nullptr) return route.get(served, request, id);
  if (request.method == Method::post && route.post != nullptr) return route.post(served, request);
  if (request.method == Method::remove && route.remove != nullptr) return route.remove(served, id);
  return not_allowed(route);
}

Response nothing_here(const Request& request) {
  return http::error_response(
      404, "not_found",
      fmt::format("there is nothing at {}; daemon/gateway/serve/README.md lists the routes",
                  request.path),
      "path");
}

}  // namespace

Response answer(const Served& served, const Request& request) {
  std::string_view rest = request.path;
  const bool is_api = rest.starts_with(kApi);
  rest.remove_prefix(is_api ? kApi.size() : std::min<std::size_t>(rest.size(), 1));
  const std::size_t slash = rest.find('/');
  const bool has_id = slash != std::string_view::npos;
  const std::string id{has_id ? rest.substr(slash + 1) : std::string_view{}};
  const std::span<const Route> routes = is_api ? std::span<const Route>{kApiRoutes} : kPages;
  const auto route = std::ranges::find_if(routes, [&](const Route& one) {
    return one.has_id == has_id && one.path == rest.substr(0, slash);
  });
  if (route == routes.end() || (has_id && id.empty())) return nothing_here(request);
  return take(*route, served, request, id);
}

}  // namespace recald::daemon
