#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "adapters/stores/open.hpp"
#include "adapters/system/files/write_file.hpp"
#include "daemon/commands/commands.hpp"
#include "daemon/gateway/replay/replay_recording.hpp"
#include "daemon/gateway/serve/api/shapes.hpp"
#include "daemon/gateway/upkeep/export_csv.hpp"
#include "daemon/gateway/upkeep/stored_site.hpp"

namespace recald::daemon {
namespace {

using metering::TimeSpan;
using Json = nlohmann::ordered_json;

constexpr TimeSpan kAllTimes{metering::Instant::min(), metering::Instant::max()};

/// As the API has them, a line each, in order of their numbers.
Result<std::string> events_text(Store& store) {
  constexpr int kAtATime = 1'000;
  std::string text;
  for (std::int64_t after = 0;;) {
    const auto events = TRY(store.events_after(after, kAtATime));
    if (events.empty()) return text;
    for (const StoreEvent& event : events) {
      text += event_json(event).dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
    }
    after = events.back().number;
  }
}

struct ReplayedTexts {
  std::string readings;
  std::string months;
  std::string events;
};

Result<ReplayedTexts> texts_of(Store& store, const SiteConfig& site) {
  const auto calendar = TRY(metering::LocalCalendar::open(site.timezone));
  const auto meters = TRY(stored_meters(store, site));
  std::ostringstream readings;
  std::ostringstream months;
  TRY(export_readings(store, meters, kAllTimes, readings));
  TRY(export_months(store, calendar, meters, kAllTimes, months));
  return ReplayedTexts{readings.str(), months.str(), TRY(events_text(store))};
}

Result<void> write_all(const std::filesystem::path& folder, const ReplayedTexts& texts) {
  TRY(system::make_folder(folder));
  TRY(system::write_file(folder / "readings.csv", texts.readings));
  TRY(system::write_file(folder / "months.csv", texts.months));
  return system::write_file(folder / "events.jsonl", texts.events);
}

std::string replayed_line(const ReplayedRecording& replayed) {
  return fmt::format("{} reads, {} pushes and {} values of a broker from {} to {}; {}\n",
                     replayed.reads, replayed.pushes, replayed.values,
                     metering::to_string(*replayed.begin), metering::to_string(*replayed.end),
                     replayed.different == 0
                         ? fmt::format("all {} intervals are as recorded", replayed.intervals)
                         : fmt::format("{} of {} intervals are not as recorded", replayed.different,
                                       replayed.intervals));
}

Json json_of(const ReplayedRecording& replayed) {
  return {{"site", replayed.site.id},
          {"recorded_by", replayed.program},
          {"begin", metering::to_string(*replayed.begin)},
          {"end", metering::to_string(*replayed.end)},
          {"reads", replayed.reads},
          {"pushes", replayed.pushes},
          {"values", replayed.values},
          {"intervals", replayed.intervals},
          {"different", replayed.different},
          {"first_difference", replayed.first_difference},
          {"remarks", replayed.remarks}};
}

}  // namespace

int run_replay_recording(const ReplayArguments& arguments, const Console& console) {
  if (!arguments.from.empty() || !arguments.to.empty()) {
    return console.misused("--from and --to belong to a site; a recording is replayed whole");
  }
  const std::string name = arguments.site.filename().string();
  auto source = csv::open_file(arguments.site, "recording");
  if (!source) return console.fail(source.error());
  auto store = stores::open_in_memory();
  if (!store) return console.fail(store.error());
  const auto replayed = replay_recording(*source, name, **store);
  if (!replayed) return console.fail(replayed.error());
  const auto texts = texts_of(**store, replayed->site);
  if (!texts) return console.fail(texts.error());
  if (!arguments.out.empty()) {
    if (const auto written = write_all(arguments.out, *texts); !written) {
      return console.fail(written.error());
    }
  }
  if (arguments.json) {
    console.out << json_of(*replayed).dump(2, ' ', false, Json::error_handler_t::replace) << "\n";
  } else if (arguments.out.empty()) {
    console.out << texts->readings;
  }
  for (const std::string& one : replayed->remarks) console.err << one << "\n";
  console.err << replayed_line(*replayed);
  if (replayed->different == 0) return kSuccess;
  return console.fail(
      fmt::format("{}: this recald does not make the intervals of the recording; "
                  "the first is {}",
                  name, replayed->first_difference));
}

}  // namespace recald::daemon
