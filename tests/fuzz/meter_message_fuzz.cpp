// A message of a broker gives values that a counter can take, or a reason; nothing else.
#include <cmath>

#include "daemon/gateway/ingest/meter_message.hpp"
#include "daemon/gateway/ingest/sent_values.hpp"
#include "tests/fuzz/require.hpp"

namespace recald::fuzz {
namespace {

constexpr std::string_view kSite = R"([site]
id = "tower"
timezone = "Europe/Berlin"
[mqtt]
url = "mqtt://localhost"
[[meter]]
id = "timed"
source = "mqtt"
utility = "electricity"
rated_kW = 100
energy_from = { topic = "a", pointer = "/e/0", time_pointer = "/t", unit = "MWh" }
[[meter]]
id = "plain"
source = "mqtt"
utility = "electricity"
power_from = { topic = "a", unit = "W" }
)";

const metering::Instant kNow = std::chrono::sys_days{std::chrono::year{2026} / 3 / 1};

}  // namespace
}  // namespace recald::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace recald::fuzz;
  static const auto site = recald::daemon::parse_site(kSite, "/nowhere/site.toml").value();
  const auto message =
      recald::daemon::parse_meter_message(site, "a", text_of(data, size), false, kNow);
  for (const auto& value : message.values) {
    require(std::isfinite(value.value), "a value is finite");
    require(value.measured.has_value() == value.is_counter, "of the one that has a time");
    require(!value.measured || (*value.measured >= kNow - recald::daemon::kSentOldest &&
                                *value.measured <= kNow + std::chrono::minutes{5}),
            "it has happened");
  }
  for (const auto& refusal : message.refusals) require_sentence(refusal.why);
  return 0;
}
