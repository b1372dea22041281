#include "daemon/gateway/alert/alerts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "adapters/http/url.hpp"
#include "adapters/system/files/sha256.hpp"
#include "core/text/limited.hpp"
#include "daemon/gateway/ingest/plausible_time.hpp"

namespace recald::daemon {
namespace {

using metering::Instant;
using std::chrono::milliseconds;

constexpr int kRefusedMax = 50;          // one after the other, before it is tried later
constexpr std::size_t kTextShown = 200;  // of an alert that was refused
constexpr std::size_t kRecentMax = 1'000;
constexpr std::size_t kNotifiedMax = 1'000;
/// How much of the past a new destination receives. The recovery of a store at the start is in it.
constexpr std::chrono::hours kNotifiedAtFirst{1};
constexpr int kEventsOfThePast = 1'000;
constexpr int kPagesMax = 20;                // of events at a look
constexpr std::chrono::days kCountedFor{1};  // as the store counts repeated events

template <class T>
void keep_newest(std::deque<T>& values, std::size_t max) {
  while (values.size() > max) values.pop_front();
}

/// An exception is the reason why it was not delivered.
Result<void> deliver_safely(const Deliver& deliver, const AlertDestination& destination,
                            const AlertMessage& message, const std::stop_token& stop) {
  try {
    return deliver(destination, message, stop);
  } catch (const std::exception& thrown) {
    return failure(ErrorCode::unsupported, thrown.what());
  }
}

}  // namespace

std::string cursor_name(const AlertDestination& destination) {
  const auto hashed = [](std::string_view kind, const std::string& what) {
    system::Sha256 digest;
    digest.add(what);
    return fmt::format("{} {}", kind, digest.hex().substr(0, 16));
  };
  if (const auto* const webhook = std::get_if<WebhookConfig>(&destination)) {
    return hashed("webhook", webhook->url);
  }
  const auto& mail = std::get<MailConfig>(destination);
  return hashed("mail", fmt::format("{} {}", mail.server, fmt::join(mail.to, " ")));
}

std::string destination_words(const AlertDestination& destination) {
  if (const auto* const webhook = std::get_if<WebhookConfig>(&destination)) {
    const auto url = http::parse_url(webhook->url);
    return "webhook at " + (url ? url->host : "?");
  }
  return fmt::format("mail to {}", fmt::join(std::get<MailConfig>(destination).to, ", "));
}

Alerts::Alerts(Ports ports, std::shared_ptr<const SiteConfig> site,
               metering::LocalCalendar calendar, Deliver deliver,
               std::function<void(StoreEvent)> notify, Notified notified, const AlertRules& rules)
    : ports_(ports),
      calendar_(std::move(calendar)),
      deliver_(std::move(deliver)),
      notify_(std::move(notify)),
      rules_(rules),
      notified_(std::move(notified)),
      wakeup_(ports.loop, [this] { poll(); }) {
  set_site(std::move(site));
}

Alerts::~Alerts() { stop_.request_stop(); }

void Alerts::start() { poll_after(rules_.gather); }

void Alerts::set_site(std::shared_ptr<const SiteConfig> site) {
  site_ = std::move(site);
  std::vector<Outgoing> outgoing;
  for (const AlertDestination& destination : site_->alerts.destinations) {
    const std::string cursor = cursor_name(destination);
    // Twice in the file is once: there is one cursor.
    if (std::ranges::find(outgoing, cursor, &Outgoing::cursor) != outgoing.end()) continue;
    const auto known = std::ranges::find(outgoing_, cursor, &Outgoing::cursor);
    outgoing.push_back({.destination = destination,
                        .cursor = cursor,
                        .position = known == outgoing_.end() ? std::nullopt : known->position,
                        .events_max = rules_.events});
  }
  outgoing_ = std::move(outgoing);
  poll_after(rules_.gather);
}

void Alerts::observe(const StoreEvent& event) {
  if (event.kind == "store_refuses") store_refuses_ = true;
  if (event.kind == "store_accepts") store_refuses_ = false;
  recent_.push_back({event, ports_.loop.now().monotonic});
  keep_newest(recent_, kRecentMax);
  poll_after(rules_.gather);
}

void Alerts::poll_after(milliseconds wait) {
  if (!outgoing_.empty()) wakeup_.after(wait);
}

void Alerts::poll() {
  poll_after(rules_.poll_every);
  if (is_sending_) return;  // its end looks again
  const Moment now = ports_.loop.now();
  for (Outgoing& outgoing : outgoing_) {
    if (now.monotonic < outgoing.not_before) continue;
    auto pending = pending_for(outgoing, now);
    if (!pending) continue;  // the store cannot be read, which it says itself
    std::erase_if(pending->events, [&](const StoreEvent& event) {
      return std::ranges::any_of(outgoing.refused, [&](const StoreEvent& refused) {
        return refused.kind == event.kind && refused.subject == event.subject &&
               refused.time == event.time;
      });
    });
    if (pending->events.empty() && !outgoing.refused.empty()) {
      finish_failed(outgoing, *pending, {ErrorCode::io_failed, outgoing.refusal});
    } else if (pending->events.empty()) {
      move(outgoing, pending->position);
    } else if (!waits_for_morning(*pending, now.instant())) {
      return send(outgoing, std::move(*pending), now.instant());
    }
  }
  if (!store_refuses_) {
    std::erase_if(recent_,
                  [&](const Recent& one) { return now.monotonic - one.at > rules_.gather; });
  }
}

Result<std::int64_t> Alerts::position_of(Outgoing& outgoing, Instant now) {
  if (outgoing.position) return *outgoing.position;
  const auto stored = TRY(ports_.store.cursor(outgoing.cursor));
  if (stored) {
    outgoing.position = *stored;
    return *stored;
  }
  const auto past = TRY(ports_.store.events(kEventsOfThePast));
  std::int64_t position = 0;
  for (const StoreEvent& event : past) {
    const bool is_old = is_plausible_time(event.time) && event.time < now - kNotifiedAtFirst;
    if (is_old) position = std::max(position, event.number);
  }
  // Now, so that what this destination misses is still new to it after a restart.
  TRY(ports_.store.put_cursor(outgoing.cursor, position));
  outgoing.position = position;
  return position;
}

Result<Alerts::Pending> Alerts::pending_for(Outgoing& outgoing, const Moment& now) {
  Pending pending;
  // A store that cannot even be read has nothing to add to what is in memory.
  const auto added = add_stored(outgoing, now, pending);
  if (!added && !store_refuses_) return tl::unexpected(added.error());
  if (store_refuses_) add_unstored(outgoing, now, pending);
  return pending;
}

Result<void> Alerts::add_stored(Outgoing& outgoing, const Moment& now, Pending& pending) {
  const auto position = TRY(position_of(outgoing, now.instant()));
  // All of them: in quiet hours an error may stand behind a thousand meters that fell silent.
  pending.position = position;
  for (int page = 0; page < kPagesMax; ++page) {
    const auto events = TRY(ports_.store.events_after(*pending.position, rules_.events));
    for (const StoreEvent& event : events) {
      pending.position = event.number;
      const bool is_new = is_alert(event, now.instant()) && !was_notified(outgoing, event);
      if (is_new) pending.events.push_back(event);
    }
    if (std::ssize(events) < rules_.events) break;
  }
  return {};
}

void Alerts::add_unstored(const Outgoing& outgoing, const Moment& now, Pending& pending) const {
  for (const Recent& observe : recent_) {
    const StoreEvent& event = observe.event;
    const bool is_stored = std::ranges::any_of(pending.events, [&](const StoreEvent& stored) {
      return stored.kind == event.kind && stored.subject == event.subject &&
             stored.time == event.time;
    });
    if (is_stored || !is_alert(event, now.instant()) || was_notified(outgoing, event)) continue;
    pending.events.push_back(event);
  }
}

bool Alerts::is_alert(const StoreEvent& event, Instant now) const {
  const bool is_chosen =
      std::ranges::find(site_->alerts.about, event.kind) != site_->alerts.about.end();
  // What happened before the clock was set has no age.
  const Instant at = event.last.value_or(event.time);
  return is_chosen && (!is_plausible_time(at) || at > now - rules_.forget);
}

bool Alerts::was_notified(const Outgoing& outgoing, const StoreEvent& event) const {
  const auto notified = notified_.find(outgoing.cursor);
  if (notified == notified_.end()) return false;
  return std::ranges::any_of(notified->second, [&](const NotifiedEvent& one) {
    const bool is_repeated =
        event.is_counted && one.time <= event.time && event.time < one.time + kCountedFor;
    return one.kind == event.kind && one.subject == event.subject &&
           (one.time == event.time || is_repeated);
  });
}

bool Alerts::waits_for_morning(const Pending& pending, Instant now) const {
  if (!site_->alerts.quiet) return false;
  const std::chrono::minutes time_of_day{calendar_.local_time(now).minute_of_day};
  return site_->alerts.quiet->contain(time_of_day) &&
         std::ranges::none_of(pending.events, [](const StoreEvent& event) {
           return event.severity == Severity::error;
         });
}

/// A cursor that cannot be stored moves in memory, and is stored with the next move.
void Alerts::move(Outgoing& outgoing, std::optional<std::int64_t> position) {
  if (!position || outgoing.position == position) return;
  outgoing.position = position;
  (void)ports_.store.put_cursor(outgoing.cursor, *position);
}

void Alerts::send(const Outgoing& outgoing, Pending pending, Instant now) {
  if (std::ssize(pending.events) > outgoing.events_max) {  // the others are the next message
    pending.events.resize(static_cast<std::size_t>(outgoing.events_max));
    // One that the store does not have yet has no number, and comes after those that it has.
    const auto last = std::ranges::max_element(pending.events, {}, &StoreEvent::number);
    pending.position = last->number > 0 ? std::optional{last->number} : std::nullopt;
  }
  const auto sent = std::make_shared<Result<void>>();
  AlertMessage message = alert_message(*site_, calendar_, pending.events, now);
  is_sending_ = true;
  ports_.worker.run([deliver = deliver_, destination = outgoing.destination,
                     message = std::move(message), stop = stop_.get_token(),
                     sent] { *sent = deliver_safely(deliver, destination, message, stop); },
                    alive_.guard([this, cursor = outgoing.cursor, pending = std::move(pending),
                                  sent] { finish(cursor, pending, *sent); }));
}

void Alerts::finish(const std::string& cursor, const Pending& pending, const Result<void>& sent) {
  is_sending_ = false;
  const auto outgoing = std::ranges::find(outgoing_, cursor, &Outgoing::cursor);
  if (outgoing == outgoing_.end()) return poll_after(milliseconds{0});  // removed by a reload
  if (sent) {
    finish_sent(*outgoing, pending);
  } else {
    finish_failed(*outgoing, pending, sent.error());
  }
  poll_after(milliseconds{0});
}

void Alerts::finish_failed(Outgoing& outgoing, const Pending& pending, const Error& why) {
  if (why.code == ErrorCode::out_of_range) {
    if (pending.events.size() > 1) {
      outgoing.events_max = static_cast<int>(pending.events.size()) / 2;
    } else {
      outgoing.refused.push_back(pending.events.front());
      outgoing.refusal = why.message;
    }
    // What comes after it may be taken; a destination that takes nothing at all is tried later.
    if (std::ssize(outgoing.refused) <= kRefusedMax) return;
  }
  outgoing.refused.clear();
  const Moment now = ports_.loop.now();
  const bool is_first = outgoing.wait == milliseconds{0};
  outgoing.wait = is_first ? rules_.retry_min : std::min(2 * outgoing.wait, rules_.retry_max);
  outgoing.not_before = now.monotonic + outgoing.wait;
  if (!is_first) return;
  const std::string words = destination_words(outgoing.destination);
  notify_({.time = now.instant(),
           .severity = Severity::warning,
           .kind = "alert_not_sent",
           .subject = words,
           .text = fmt::format("no alert can be sent as {}: {}; recald keeps trying for three days",
                               words, why.message),
           .is_counted = true});
}

void Alerts::finish_sent(Outgoing& outgoing, const Pending& pending) {
  outgoing.wait = outgoing.not_before = milliseconds{0};
  outgoing.events_max = std::min(2 * outgoing.events_max, rules_.events);
  set_aside_refused(outgoing);
  remember(outgoing, pending.events);
  move(outgoing, pending.position);
  const std::string words = destination_words(outgoing.destination);
  notify_({.time = ports_.loop.now().instant(),
           .severity = Severity::info,
           .kind = "alert_sent",
           .subject = words,
           .text = fmt::format("{} sent as {}",
                               pending.events.size() == 1
                                   ? "1 alert was"
                                   : fmt::format("{} alerts were", pending.events.size()),
                               words),
           .is_counted = true});
}

void Alerts::set_aside_refused(Outgoing& outgoing) {
  const std::vector<StoreEvent> refused = std::exchange(outgoing.refused, {});
  if (refused.empty()) return;
  remember(outgoing, refused);
  const std::string words = destination_words(outgoing.destination);
  notify_(
      {.time = ports_.loop.now().instant(),
       .severity = Severity::warning,
       .kind = "alert_refused",
       .subject = words,
       .text = fmt::format(
           "{} refuses {} and takes others; {} not sent again: {}", words,
           refused.size() == 1 ? "an alert" : fmt::format("{} alerts", refused.size()),
           refused.size() == 1 ? "it is" : "they are", limited(refused.front().text, kTextShown)),
       .is_counted = true});
}

void Alerts::remember(const Outgoing& outgoing, const std::vector<StoreEvent>& events) {
  auto& notified = notified_[outgoing.cursor];
  for (const StoreEvent& event : events) {
    notified.push_back({event.time, event.kind, event.subject});
  }
  keep_newest(notified, kNotifiedMax);
}

}  // namespace recald::daemon
