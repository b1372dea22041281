#include <fmt/format.h>

#include <charconv>
#include <nlohmann/json.hpp>
#include <optional>

#include "adapters/csv/fields.hpp"
#include "adapters/results/job_result_json.hpp"
#include "daemon/gateway/serve/api/api.hpp"
#include "daemon/gateway/serve/api/json_answer.hpp"
#include "daemon/gateway/serve/api/parameters.hpp"
#include "daemon/gateway/serve/api/shapes.hpp"

namespace recald::daemon {
namespace {

using Json = nlohmann::ordered_json;

std::string_view plural(JobKind kind) {
  return kind == JobKind::calibration ? "calibrations" : "diagnoses";
}

std::string location(const StoredJob& job) {
  return fmt::format("/api/v1/{}/{}", plural(job.kind), job.number);
}

Json linked(const StoredJob& job) {
  Json json = job_json(job);
  json["location"] = location(job);
  return json;
}

std::optional<std::int64_t> number_in(const std::string& id) {
  std::int64_t number = 0;
  const char* end = id.data() + id.size();
  const auto [stop, error] = std::from_chars(id.data(), end, number);
  return error == std::errc{} && stop == end ? std::optional{number} : std::nullopt;
}

/// A body is not needed; one with content is an error, since it would be ignored.
bool asks_for_nothing_more(std::string body) {
  std::erase_if(body, [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; });
  return body.empty() || body == "{}";
}

http::Response refused_job(const Error& error) {
  if (error.code == ErrorCode::io_failed) {
    return not_taken(error.message);
  }
  return http::error_response(409, "not_possible", error.message);
}

/// The job of that kind with this id, or a response that there is none.
tl::expected<StoredJob, http::Response> find_job(JobKind kind, const Served& served,
                                                 const std::string& id) {
  const auto number = number_in(id);
  auto job = number ? served.store.job(*number) : Result<std::optional<StoredJob>>{};
  if (!job) return tl::unexpected(refusal(job.error()).value());
  if (!*job || (*job)->kind != kind) {
    return tl::unexpected(
        http::error_response(404, "not_found",
                             fmt::format("there is no {} {}; GET /api/v1/{} lists them",
                                         name_of(kind), csv::in_quotes(id), plural(kind)),
                             "id"));
  }
  return std::move(**job);
}

}  // namespace

http::Response get_jobs_of(JobKind kind, const Served& served, const http::Request& request) {
  if (const auto checked = has_only(request, {"limit", "cursor"}); !checked) {
    return checked.error();
  }
  const auto limit = limit_of(request);
  if (!limit) return limit.error();
  const auto cursor = whole_number_of(request, "cursor", "the number from a 'next' of this list");
  if (!cursor) return cursor.error();
  const auto jobs = served.store.jobs(kind, kLimitMax);
  if (!jobs) return refusal(jobs.error()).value();
  Json list = Json::array();
  Json next;
  for (const StoredJob& job : *jobs) {
    if (*cursor && job.number > **cursor) continue;
    if (std::ssize(list) == *limit) {
      next = std::to_string(job.number);
      break;
    }
    list.push_back(linked(job));
  }
  return json_answer({{plural(kind), list}, {"next", next}});
}

http::Response get_job_of(JobKind kind, const Served& served, const std::string& id) {
  const auto job = find_job(kind, served, id);
  if (!job) return job.error();
  http::Response response = json_answer(linked(*job));
  // The document is sent unchanged, inserted before the brace that closes the job.
  const std::string& document = job->result.document;
  response.body.resize(response.body.rfind('}'));
  response.body += ",\"result\":" + (document.empty() ? "null" : document) + "}\n";
  return response;
}

http::Response cancel_job_of(JobKind kind, const Served& served, const std::string& id) {
  const auto job = find_job(kind, served, id);
  if (!job) return job.error();
  if (!served.cancel_job) {
    return http::error_response(409, "not_possible",
                                fmt::format("this daemon does not run {}", plural(kind)));
  }
  if (const auto cancelled = served.cancel_job(job->number); !cancelled) {
    return refused_job(cancelled.error());
  }
  // A running job is cancelled in a moment.
  const auto now = find_job(kind, served, id);
  return now ? json_answer(linked(*now), 202) : now.error();
}

http::Response post_job_of(JobKind kind, const Served& served, const http::Request& request) {
  if (const auto checked = has_only(request, {}); !checked) return checked.error();
  if (!asks_for_nothing_more(request.body)) {
    return http::error_response(
        400, "invalid_value",
        fmt::format(
            "to request a {}, send an empty body or {{}}; its settings are in the site file",
            name_of(kind)),
        "body");
  }
  if (!served.ask_job) {
    return http::error_response(409, "not_possible",
                                fmt::format("this daemon does not run {}", plural(kind)));
  }
  if (!served.no_store.empty()) {
    return not_taken(
        fmt::format("no {} was started, try again later: the store cannot be opened: {}",
                    name_of(kind), served.no_store));
  }
  const auto number = served.ask_job(kind);
  if (!number) return refused_job(number.error());
  const auto job = served.store.job(*number);
  if (!job) return refusal(job.error()).value();
  const StoredJob known = job->value_or(StoredJob{.number = *number, .kind = kind});
  http::Response response = json_answer(linked(known), 202);
  response.headers.emplace_back("Location", location(known));
  return response;
}

http::Response get_drift(const Served& served, const http::Request& request) {
  if (const auto checked = has_only(request, {}); !checked) return checked.error();
  const auto job = served.store.last_accepted(JobKind::calibration);
  if (!job) return refusal(job.error()).value();
  Json drift;
  Json alarms;
  Json calibration;
  if (*job) {
    calibration = location(**job);
    if (const auto& found = (*job)->result.drift) {
      drift = results::outputs_json(*found);
      alarms = results::alarms_json(*found);
    }
  }
  return json_answer({{"calibration", calibration}, {"drift", drift}, {"alarms", alarms}});
}

}  // namespace recald::daemon
