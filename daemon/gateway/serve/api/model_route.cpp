#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "adapters/models/model_store.hpp"
#include "daemon/gateway/serve/api/api.hpp"
#include "daemon/gateway/serve/api/json_answer.hpp"
#include "daemon/gateway/serve/api/parameters.hpp"
#include "daemon/site/model/version_list.hpp"

namespace recald::daemon {
namespace {

models::ModelStore store_of(const Served& served) {
  return {served.site.versions_beside(), served.site.id};
}

http::Response refused_change(const Error& error) {
  switch (error.code) {
    case ErrorCode::not_found:
      return http::error_response(404, "not_found", error.message, "version");
    case ErrorCode::io_failed:
      return refusal(503, "store_unavailable", error.message).value();
    default:
      return http::error_response(409, "not_possible", error.message, "version");
  }
}

http::Response versions_of(const Served& served) {
  const auto list = store_of(served).list();
  return list ? json_answer(versions_json(*list)) : refused_change(list.error());
}

/// What a body asks for.
struct Change {
  bool is_revert;
  std::string version;  ///< Empty: the parent of the one in force.
};

Checked<Change> change_in(const std::string& body) {
  const auto json = nlohmann::json::parse(body, nullptr, false);
  const auto wrong = refusal(400, "invalid_value",
                             "send {\"activate\": \"VERSION\"}, or {\"revert\": \"VERSION\"}, or "
                             "{\"revert\": null} to go back by one",
                             "body");
  if (!json.is_object() || json.size() != 1) return wrong;
  const auto& value = json.begin().value();
  if (json.contains("activate") && value.is_string()) return Change{false, value};
  if (json.contains("revert") && value.is_string()) return Change{true, value};
  if (json.contains("revert") && value.is_null()) return Change{true, ""};
  return wrong;
}

}  // namespace

http::Response get_model(const Served& served, const http::Request& request) {
  if (const auto checked = has_only(request, {}); !checked) return checked.error();
  return versions_of(served);
}

http::Response post_model(const Served& served, const http::Request& request) {
  if (const auto checked = has_only(request, {}); !checked) return checked.error();
  const auto change = change_in(request.body);
  if (!change) return change.error();
  if (!served.ask_job) {
    return http::error_response(409, "not_possible", "this daemon does not run calibrations");
  }
  const std::string at = metering::to_string(served.now());
  const models::ModelStore store = store_of(served);
  const auto now_in_force =
      change->is_revert ? store.revert(change->version, at) : store.activate(change->version, at);
  if (!now_in_force) return refused_change(now_in_force.error());
  // The version is in force whether or not this is taken; the next month calibrates with it too.
  (void)served.ask_job(JobKind::calibration);
  return versions_of(served);
}

}  // namespace recald::daemon
