// A body of readings is refused with a reason, or every reading in it can be stored.
#include <cmath>
#include <nlohmann/json.hpp>

#include "daemon/gateway/serve/api/pushed_readings.hpp"
#include "tests/fuzz/require.hpp"

namespace recald::fuzz {
namespace {

constexpr std::string_view kSite = R"([site]
id = "tower"
name = "Tower"
timezone = "Europe/Berlin"

[[meter]]
id = "chw"
source = "http"
utility = "chilled_water"

[[meter]]
id = "old"
utility = "gas"
file = "old.csv"
)";

const metering::Instant kNow = std::chrono::sys_days{std::chrono::year{2026} / 3 / 1};

void require_refusal(const http::Response& answer) {
  require(answer.status >= 400 && answer.status < 500, "the sender is told, and nobody failed");
  const auto json = nlohmann::json::parse(answer.body, nullptr, false);
  require(json.is_object() && json.contains("error"), "a refusal is JSON");
  require_sentence(json["error"]["message"].get<std::string>());
}

}  // namespace
}  // namespace recald::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace recald::fuzz;
  static const auto site = recald::daemon::parse_site(kSite, "/nowhere/site.toml").value();
  const auto pushed = recald::daemon::parse_pushed(text_of(data, size), site, kNow);
  if (!pushed) {
    require_refusal(pushed.error());
    return 0;
  }
  require(pushed->meter->meter.id == "chw", "of the meter that takes readings");
  require(!pushed->readings.empty(), "there is something to store");
  for (const recald::metering::Reading& reading : pushed->readings) {
    const bool is_missing = reading.validity == recald::metering::Validity::missing;
    require(is_missing == std::isnan(reading.mean_kW), "what has no value is missing");
    require(is_missing || std::isfinite(reading.mean_kW), "a value is finite");
    require(reading.start.time_since_epoch() % std::chrono::seconds{900} == std::chrono::seconds{0},
            "on the grid");
    require(reading.start < kNow, "it has happened");
  }
  return 0;
}
