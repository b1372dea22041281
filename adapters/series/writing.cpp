#include "adapters/series/writing.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "adapters/series/line_protocol.hpp"
#include "adapters/series/remote_write.hpp"

namespace recald::series {
namespace {

/// InfluxDB answers with a JSON object, Prometheus with a line.
std::string reason_of(const std::string& body) {
  const auto json = nlohmann::json::parse(body, nullptr, false);
  if (json.is_object() && json.contains("error") && json["error"].is_string()) {
    return json["error"];
  }
  return body.substr(0, body.find_first_of("\r\n"));
}

Outcome outcome_of(const delivery::Answer& answer) {
  if (answer.status >= 200 && answer.status < 300) return Outcome::taken;
  if (answer.status == 400 && answer.body.find("partial write") != std::string::npos) {
    return Outcome::partly;
  }
  const bool is_refused = answer.status == 400 || answer.status == 413 || answer.status == 422;
  // Prometheus up to 2.48, for a sample before its out_of_order_time_window; 400 since then.
  const bool is_too_old =
      answer.status == 500 && answer.body.find("too old sample") != std::string::npos;
  return is_refused || is_too_old ? Outcome::refused : Outcome::later;
}

}  // namespace

delivery::Post message(Protocol protocol, delivery::Post to, std::span<const Point> points) {
  if (protocol == Protocol::influx) {
    to.content_type = "text/plain; charset=utf-8";
    to.body = line_protocol(points);
    return to;
  }
  to.content_type = "application/x-protobuf";
  to.headers.emplace_back("Content-Encoding: snappy");
  to.headers.emplace_back("X-Prometheus-Remote-Write-Version: 0.1.0");
  to.body = remote_write_body(points);
  return to;
}

Meaning meaning_of(const delivery::Answer& answer) {
  const Outcome outcome = outcome_of(answer);
  if (outcome == Outcome::taken) return {.outcome = outcome, .why = {}};
  const std::string reason = reason_of(answer.body);
  return {.outcome = outcome,
          .wait = answer.retry_after,
          .why = fmt::format("answered with status {}{}{}", answer.status,
                             reason.empty() ? "" : ": ", reason)};
}

}  // namespace recald::series
