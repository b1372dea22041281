#include "adapters/series/writing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
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
  // Anything may answer, and the body may have been cut within a character: others need UTF-8.
  const nlohmann::json line = body.substr(0, body.find_first_of("\r\n"));
  const auto replace = nlohmann::json::error_handler_t::replace;
  return nlohmann::json::parse(line.dump(-1, ' ', false, replace));
}

/// What Prometheus says of a sample from before those that it has.
bool is_of_a_sample_out_of_order(const std::string& body) {
  return std::ranges::any_of(std::array{"out of order sample", "out of bounds", "too old sample"},
                             [&](const char* text) { return body.find(text) != body.npos; });
}

Outcome outcome_of(const delivery::Answer& answer) {
  if (answer.status >= 200 && answer.status < 300) return Outcome::taken;
  if (answer.status == 400 && answer.body.find("partial write") != std::string::npos) {
    return Outcome::partly;
  }
  const bool is_refused = answer.status == 400 || answer.status == 413 || answer.status == 422;
  // Prometheus up to 2.48 answers so before its out_of_order_time_window, later ones with 400.
  const bool is_too_old = answer.status == 500 && is_of_a_sample_out_of_order(answer.body);
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
  return {
      .outcome = outcome,
      .wait = answer.retry_after,
      .why = fmt::format(
          "answered with status {}{}{}{}", answer.status, reason.empty() ? "" : ": ", reason,
          is_of_a_sample_out_of_order(answer.body)
              ? "; Prometheus takes older samples up to its storage.tsdb.out_of_order_time_window"
              : "")};
}

}  // namespace recald::series
