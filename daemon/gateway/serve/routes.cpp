#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

#include "daemon/gateway/serve/api.hpp"
#include "daemon/gateway/serve/metrics.hpp"
#include "daemon/gateway/serve/readiness.hpp"
#include "daemon/gateway/serve/served.hpp"
#include "daemon/gateway/serve/status_page.hpp"

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

constexpr std::array kApiRoutes{
    Route{"sites", false, without_id<get_sites>, nullptr},
    Route{"meters", false, without_id<get_meters>, nullptr},
    Route{"meters", true, with_id<get_meter>, nullptr},
    Route{"intervals", false, without_id<get_intervals>, nullptr},
    Route{"months", false, without_id<get_months>, nullptr},
    Route{"events", false, without_id<get_events>, nullptr},
    Route{"forecasts", false, without_id<get_forecasts>, nullptr},
    Route{"drift", false, without_id<get_drift>, nullptr},
    Route{"calibrations", false, without_id<get_jobs<JobKind::calibration>>,
          post_job<JobKind::calibration>},
    Route{"calibrations", true, with_id<get_job<JobKind::calibration>>, nullptr,
          cancel_job<JobKind::calibration>},
    Route{"diagnoses", false, without_id<get_jobs<JobKind::diagnosis>>,
          post_job<JobKind::diagnosis>},
    Route{"diagnoses", true, with_id<get_job<JobKind::diagnosis>>, nullptr,
          cancel_job<JobKind::diagnosis>},
    Route{"readings", false, nullptr, post_readings},
};

Response get_health(const Served&) { return health(); }

constexpr std::array kOtherRoutes{
    Route{"/", false, plain<status_page>, nullptr},
    Route{"/style.css", false, plain<status_style>, nullptr},
    Route{"/healthz", false, plain<get_health>, nullptr},
    Route{"/readyz", false, plain<readiness>, nullptr},
    Route{"/metrics", false, plain<metrics>, nullptr},
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

Response take(const Route& route, const Served& served, const Request& request,
              const std::string& id) {
  const bool reads = request.method == Method::get || request.method == Method::head;
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
  if (!rest.starts_with(kApi)) {
    const auto route = std::ranges::find(kOtherRoutes, rest, &Route::path);
    return route == kOtherRoutes.end() ? nothing_here(request) : take(*route, served, request, "");
  }
  rest.remove_prefix(kApi.size());
  const std::size_t slash = rest.find('/');
  const bool has_id = slash != std::string_view::npos;
  const std::string id{has_id ? rest.substr(slash + 1) : std::string_view{}};
  const auto route = std::ranges::find_if(kApiRoutes, [&](const Route& one) {
    return one.has_id == has_id && one.path == rest.substr(0, slash);
  });
  if (route == kApiRoutes.end() || (has_id && id.empty())) return nothing_here(request);
  return take(*route, served, request, id);
}

}  // namespace recald::daemon
