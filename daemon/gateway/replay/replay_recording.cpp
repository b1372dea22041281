#include "daemon/gateway/replay/replay_recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <utility>

#include "adapters/system/time_zone_release.hpp"
#include "core/text/printable.hpp"
#include "daemon/gateway/recording/known_state.hpp"
#include "daemon/gateway/recording/line.hpp"
#include "daemon/gateway/recording/replay_loop.hpp"
#include "daemon/gateway/run/gateway.hpp"
#include "daemon/version.hpp"

namespace recald::daemon {
namespace {

using metering::Instant;
using metering::Reading;

constexpr std::size_t kSiteMax_bytes = 16'000'000;
constexpr std::size_t kPushMax = 100'000;  ///< Readings; a body of 1 MB has fewer.

bool is_same(const Reading& a, const Reading& b) {
  const bool is_equal =
      std::isnan(a.mean_kW) ? std::isnan(b.mean_kW) : a.mean_kW == b.mean_kW;  // to the last bit
  return is_equal && a.validity == b.validity && a.reasons == b.reasons && a.late == b.late;
}

std::string words_of(const Reading& reading) {
  const std::string reasons = metering::to_string(reading.reasons);
  return fmt::format("{} kW ({}{}{}{})", reading.mean_kW, metering::to_string(reading.validity),
                     reasons.empty() ? "" : ", ", reasons, reading.late ? ", late" : "");
}

/// What became of each interval, in order.
using Commits = std::map<std::string, std::map<Instant, std::vector<Reading>>>;

/// What this program's gateway commits.
class MadeIntervals final : public recording::Listener {
 public:
  void entered(const recording::Entry&) override {}
  void reloaded(const recording::Entry&, const SiteConfig&) override {}
  void stored(const std::string& meter, const Reading& reading) override {
    by_meter[meter][reading.start].push_back(reading);
  }

  Commits by_meter;
};

/// Takes the lines one after the other.
class Replayer {
 public:
  explicit Replayer(Store& store) : store_(store) {}

  Result<void> take(recording::Line line) {
    if (!is_begun_ && !std::holds_alternative<recording::Head>(line)) {
      return failure(ErrorCode::malformed, "a recording begins with \"recald_recording\"");
    }
    return std::visit([&](auto& one) { return take_one(std::move(one)); }, line);
  }

  Result<ReplayedRecording> finish(bool is_cut) {
    if (!gateway_) {
      return failure(ErrorCode::malformed, "the recording ends before the gateway has begun");
    }
    if (!is_ended_) {
      remark(fmt::format("the recording has no end{}: the program was killed, or still runs",
                         is_cut ? ", and its last line is cut off" : ""));
    }
    while (loop_.run_posted()) {
    }
    TRY(gateway_->flush());
    compare();
    return std::move(replayed_);
  }

 private:
  void remark(std::string sentence) { replayed_.remarks.push_back(std::move(sentence)); }

  Result<void> take_one(recording::Head head) {
    if (is_begun_) return failure(ErrorCode::malformed, "another recording begins here");
    is_begun_ = true;
    const std::string zones = system::time_zone_release();
    if (head.program != kVersion) {
      remark(fmt::format("recald {} recorded it, and {} replays it", printable(head.program),
                         kVersion));
    }
    if (head.time_zone_release != zones) {
      remark(fmt::format("it was recorded with the time zones of {}; this machine has {}",
                         printable(head.time_zone_release), zones));
    }
    replayed_.program = head.program;
    time_zone_release_ = std::move(head.time_zone_release);
    return {};
  }

  Result<void> take_one(recording::SitePart part) {
    (part.map.empty() ? site_text_ : maps_[part.map]) += part.text;
    site_bytes_ += part.text.size() + part.map.size();
    if (site_bytes_ <= kSiteMax_bytes) return {};
    return failure(ErrorCode::malformed, "the site file has more than 16 MB");
  }

  Result<void> take_one(recording::Readings some) {
    if (!gateway_) return recording::put_known(store_, some);
    if (some.meter != pushed_.meter) pushed_ = {some.meter, {}};
    pushed_.readings.insert(pushed_.readings.end(), some.readings.begin(), some.readings.end());
    if (pushed_.readings.size() <= kPushMax) return {};
    return failure(ErrorCode::malformed, "a push has more than 100000 readings");
  }

  Result<void> take_one(recording::KnownMeter meter) {
    if (meter.readings_from) readings_from_[meter.id] = *meter.readings_from;
    return recording::put_known(store_, std::move(meter));
  }
  template <class Known>
  Result<void> take_one(Known known) {
    return recording::put_known(store_, std::move(known));
  }

  Result<void> take_one(recording::Committed some) {
    for (const Reading& one : some.readings) committed_[some.meter][one.start].push_back(one);
    return {};
  }

  Result<void> take_one(recording::End end) {
    is_ended_ = true;
    is_whole_ = end.is_whole;
    remark("the recording ended because " + printable(end.why));
    return {};
  }

  Result<void> take_one(recording::Entry entry) {
    if (is_ended_) return failure(ErrorCode::malformed, "something follows the end");
    const bool is_start = std::holds_alternative<recording::Start>(entry.what);
    if (is_start == (gateway_ != nullptr)) {
      return failure(ErrorCode::malformed, is_start ? "the gateway begins a second time"
                                                    : "the gateway has not begun yet");
    }
    if (gateway_ && entry.at.monotonic < loop_.now().monotonic) {
      return failure(ErrorCode::malformed, "'monotonic_ms' runs back");
    }
    loop_.advance_to(entry.at);
    clock_doubt_ = entry.clock_doubt;
    if (!replayed_.begin) replayed_.begin = entry.at.instant();
    replayed_.end = entry.at.instant();
    return std::visit([&](auto& what) { return act(std::move(what)); }, entry.what);
  }

  Result<SiteConfig> read_site() {
    auto site = parse_site(site_text_, "site.toml", &maps_);
    site_text_.clear();
    maps_.clear();
    site_bytes_ = 0;
    if (site) return std::move(*site);
    return failure(ErrorCode::malformed, site.error().front());
  }

  Result<void> act(recording::Start) {
    replayed_.site = TRY(read_site());
    const auto calendar = TRY(metering::LocalCalendar::open(replayed_.site.timezone));
    gateway_ = TRY(Gateway::open(
        replayed_.site, calendar,
        {.loop = loop_,
         .store = store_,
         .make_bus = {},
         .time_zone_release = time_zone_release_,
         .clock = ClockEvidence{.released = {}, .recorded_doubt = [this] { return clock_doubt_; }},
         .recorder = &made_},
        {}));
    gateway_->start();
    return {};
  }

  Result<void> act(recording::Read read) {
    ++replayed_.reads;
    return differs(gateway_->take_read(read));
  }

  Result<void> act(recording::Push push) {
    ++replayed_.pushes;
    auto before = std::exchange(pushed_, {});
    if (before.meter == push.meter) push.readings.swap(before.readings);
    push.readings.insert(push.readings.end(), before.readings.begin(), before.readings.end());
    TRY(check(push));
    const auto taken = gateway_->take_pushed(push.meter, std::move(push.readings), push.correction);
    return differs(taken ? Result<void>{} : tl::unexpected(taken.error()));
  }

  Result<void> act(recording::Value told) {
    ++replayed_.values;
    const auto taken = gateway_->accept_mqtt(told.value);
    return differs(taken ? Result<void>{} : tl::unexpected(taken.error()));
  }

  Result<void> act(recording::Tick tick) {
    if (tick != recording::Tick::step) {
      gateway_->tick(tick);
      return {};
    }
    if (loop_.run_posted()) return {};
    return differs(failure(ErrorCode::unsupported,
                           "the recorded program went on closing months, and this one is done"));
  }

  Result<void> act(recording::Reload) {
    auto site = TRY(read_site());
    TRY(differs(gateway_->reload(site)));
    replayed_.site = std::move(site);
    return {};
  }

  /// With the time.
  [[nodiscard]] Result<void> differs(const Result<void>& done) const {
    if (done) return {};
    return failure(done.error().code, fmt::format("at {} {}", metering::to_string(*replayed_.end),
                                                  printable(done.error().message)));
  }

  /// What the API has checked before.
  Result<void> check(const recording::Push& push) {
    const auto from = readings_from_.find(push.meter);
    for (const StoredMeter& stored : gateway_->meters()) {
      const metering::Meter& meter = stored.meter;
      if (meter.id != push.meter) continue;
      for (const Reading& one : push.readings) {
        if ((one.start - meter.phase).time_since_epoch() % meter.interval !=
            std::chrono::seconds{}) {
          return failure(ErrorCode::malformed,
                         fmt::format("a reading of meter '{}' begins at {}, which is no boundary",
                                     meter.id, metering::to_string(one.start)));
        }
        if (from == readings_from_.end() || one.start >= from->second) continue;
        remark(fmt::format(
            "meter '{}': a reading of {} was pushed, and the recording has none "
            "before {}; months of then may come out differently",
            meter.id, metering::to_string(one.start), metering::to_string(from->second)));
        readings_from_.erase(from);
        return {};
      }
    }
    return {};
  }

  /// What both programs committed. A recording that is not whole lacks the last of it.
  void compare() {
    for (const auto& [meter, intervals] : committed_) {
      for (const auto& [start, recorded] : intervals) {
        replayed_.intervals += recorded.size();
        compare(meter, start, recorded, made_.by_meter[meter][start]);
      }
    }
    if (!is_whole_) return;
    for (const auto& [meter, intervals] : made_.by_meter) {
      for (const auto& [start, made] : intervals) {
        if (!committed_[meter].contains(start)) compare(meter, start, {}, made);
      }
    }
  }

  void compare(const std::string& meter, Instant start, const std::vector<Reading>& recorded,
               const std::vector<Reading>& made) {
    const auto [one, other] = std::ranges::mismatch(recorded, made, is_same);
    const bool has_more = other != made.end();
    if (one == recorded.end() && (!has_more || !is_whole_)) return;
    if (replayed_.different++ > 0) return;
    replayed_.first_difference =
        fmt::format("meter '{}' at {}: recorded {}, now {}", printable(meter),
                    metering::to_string(start), one == recorded.end() ? "nothing" : words_of(*one),
                    has_more ? words_of(*other) : "nothing");
  }

  Store& store_;
  ReplayedRecording replayed_{};
  bool is_begun_ = false;
  bool is_ended_ = false;
  bool is_whole_ = false;
  std::string clock_doubt_;
  std::string time_zone_release_;
  std::string site_text_;  ///< Of the next start or reload, as are its maps.
  MapTexts maps_;
  std::size_t site_bytes_ = 0;
  recording::Readings pushed_;  ///< The first of the next push.
  std::map<std::string, Instant> readings_from_;
  Commits committed_;
  MadeIntervals made_;
  recording::ReplayLoop loop_;
  std::unique_ptr<Gateway> gateway_;
};

}  // namespace

Result<ReplayedRecording> replay_recording(const csv::ByteSource& source, const std::string& name,
                                           Store& store) {
  Replayer replayer{store};
  csv::LineReader reader{source, recording::kLineMax_bytes};
  csv::Line text;
  bool is_cut = false;
  const auto at_line = [&](const Error& error) {
    return failure(error.code,
                   fmt::format("{}:{}: {}", name, text.number, printable(error.message)));
  };
  while (reader.next(text)) {
    if (text.too_long) return at_line({ErrorCode::malformed, "the line is longer than a megabyte"});
    is_cut = !text.terminated;
    if (is_cut) break;
    auto line = recording::parse_line(text.text);
    if (!line) return at_line(line.error());
    if (const auto taken = replayer.take(std::move(*line)); !taken) return at_line(taken.error());
  }
  if (reader.error()) return tl::unexpected(*reader.error());
  auto replayed = replayer.finish(is_cut);
  if (!replayed) return failure(replayed.error().code, name + ": " + replayed.error().message);
  return replayed;
}

}  // namespace recald::daemon
