#include "daemon/gateway/recording/recorder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "daemon/gateway/recording/known_state.hpp"
#include "daemon/site/config/portable_site.hpp"

namespace recald::daemon::recording {
namespace {

constexpr std::uint64_t kBytesPerMB = 1'000'000;

/// Calls each(part) for parts of a text that fit into a line; once for an empty one.
template <class Each>
void for_each_part(std::string_view text, Each each) {
  do {
    // Never within a character: a text that is no UTF-8 would be written differently.
    std::size_t length = std::min(text.size(), kTextMax_bytes);
    while (length < text.size() && length > kTextMax_bytes - 4 &&
           (static_cast<unsigned char>(text[length]) & 0xC0) == 0x80) {
      --length;
    }
    each(std::string{text.substr(0, length)});
    text.remove_prefix(length);
  } while (!text.empty());
}

}  // namespace

Result<std::unique_ptr<Recorder>> Recorder::create(const std::filesystem::path& file,
                                                   std::uint64_t limit_bytes, OnEnd on_end) {
  auto created = TRY(system::GrowingFile::create(file));
  return std::unique_ptr<Recorder>{
      new Recorder{std::move(created), limit_bytes, std::move(on_end)}};
}

Result<void> Recorder::begin(const Beginning& beginning, Store& store,
                             const metering::LocalCalendar& calendar,
                             std::span<const StoredMeter> meters) {
  is_on_ = true;
  write(Head{kFormat, beginning.program, beginning.time_zone_release});
  auto written = write_site(beginning.site_file);
  if (written) {
    written = for_each_known(store, calendar, meters, [&](const Line& line) { write(line); });
  }
  if (!written) is_on_ = false;
  return written;
}

Result<void> Recorder::write_site(const std::filesystem::path& file) {
  const auto site = TRY(read_portable_site(file));
  // What could not be replayed is found out now.
  if (const auto parsed = parse_site(site.text, file, &site.maps); !parsed) {
    return failure(ErrorCode::unsupported, parsed.error().front());
  }
  for_each_part(site.text, [&](std::string part) { write(SitePart{"", std::move(part)}); });
  for (const auto& [name, text] : site.maps) {
    for_each_part(text, [&, map = name](std::string part) {
      write(SitePart{map, std::move(part)});
    });
  }
  return {};
}

void Recorder::entered(const Entry& entry) {
  write_stored();
  const auto* const push = std::get_if<Push>(&entry.what);
  if (push == nullptr || push->readings.size() <= kReadingsMax) return write(entry);
  for (std::size_t i = 0; i < push->readings.size(); i += kReadingsMax) {
    const auto first = push->readings.begin() + static_cast<std::ptrdiff_t>(i);
    const std::size_t count = std::min(kReadingsMax, push->readings.size() - i);
    write(Readings{push->meter, {first, first + static_cast<std::ptrdiff_t>(count)}});
  }
  Entry rest = entry;
  std::get<Push>(rest.what).readings.clear();
  write(rest);
}

void Recorder::reloaded(const Entry& at, const SiteConfig& site) {
  write_stored();
  if (!is_on_) return;
  if (const auto written = write_site(site.file); !written) {
    return give_up("the site file cannot be recorded: " + written.error().message);
  }
  write(Entry{at.at, at.clock_doubt, Reload{}});
}

void Recorder::stored(const std::string& meter, const metering::Reading& reading) {
  if (!is_on_) return;
  if (meter != stored_.meter || stored_.readings.size() >= kReadingsMax) write_stored();
  stored_.meter = meter;
  stored_.readings.push_back(reading);
}

void Recorder::write_stored() {
  if (stored_.readings.empty()) return;
  write(std::exchange(stored_, {}));
}

void Recorder::end(const std::string& why) {
  write_stored();
  if (!is_on_) return;
  (void)file_.append(to_text(End{why, true}));
  is_on_ = false;
}

void Recorder::write(const Line& line) {
  if (!is_on_) return;
  const std::string text = to_text(line);
  if (text.size() > kLineMax_bytes) {
    return give_up("a line of it would be longer than a replay reads");
  }
  if (file_.size_bytes() + text.size() > limit_bytes_) {
    const auto why = fmt::format("it has reached its limit of {} MB (--record-max-MB)",
                                 limit_bytes_ / kBytesPerMB);
    (void)file_.append(to_text(End{why, false}));
    return give_up(why);
  }
  if (const auto written = file_.append(text); !written) give_up(written.error().message);
}

void Recorder::give_up(const std::string& why) {
  is_on_ = false;
  if (on_end_) on_end_(why);
}

}  // namespace recald::daemon::recording
