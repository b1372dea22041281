#include <fmt/format.h>

#include <sstream>

#include "adapters/system/files/write_file.hpp"
#include "daemon/commands/commands.hpp"
#include "daemon/commands/open_site.hpp"
#include "daemon/gateway/upkeep/export_csv.hpp"
#include "daemon/gateway/upkeep/stored_site.hpp"

namespace recald::daemon {
namespace {

using metering::Instant;
using metering::TimeSpan;

/// Whole local days; where one is not given, from or to the end of all times.
Result<TimeSpan> asked_span(const ExportArguments& arguments,
                            const metering::LocalCalendar& calendar) {
  TimeSpan span{Instant::min(), Instant::max()};
  const auto day_span = [&](const char* option, const std::string& text) -> Result<TimeSpan> {
    const auto day = metering::parse_day(text);
    if (day) return calendar.day_span(*day);
    return failure(ErrorCode::malformed, fmt::format("{}: {}", option, day.error().message));
  };
  if (!arguments.from.empty()) {
    const auto from = TRY(day_span("--from", arguments.from));
    span.begin = from.begin;
  }
  if (!arguments.to.empty()) {
    const auto to = TRY(day_span("--to", arguments.to));
    span.end = to.end;
  }
  if (span.begin < span.end) return span;
  return failure(ErrorCode::invalid_value,
                 fmt::format("--to {} is before --from {}", arguments.to, arguments.from));
}

}  // namespace

int run_export(const ExportArguments& arguments, const Console& console) {
  const auto site = open_site(arguments.site);
  if (!site) return console.fail(site.error());
  const auto span = asked_span(arguments, site->calendar);
  if (!span) return console.misused(span.error().message);
  auto store = open_to_read(site->config);
  if (!store) return console.fail(store.error());
  const auto meters = stored_meters(**store, site->config);
  if (!meters) return console.fail(meters.error());

  std::ostringstream text;  // a file is written whole or not at all
  std::ostream& out = arguments.out.empty() ? console.out : text;
  const auto written = arguments.months
                           ? export_months(**store, site->calendar, *meters, *span, out)
                           : export_readings(**store, *meters, *span, out);
  if (!written) return console.fail(written.error());
  if (arguments.out.empty()) return kSuccess;
  if (auto saved = system::write_file(arguments.out, text.str()); !saved) {
    return console.fail(saved.error());
  }
  return kSuccess;
}

}  // namespace recald::daemon
