#include "daemon/gateway/alert/alert_outbox.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/text/limited.hpp"

namespace recald::daemon {
namespace {

using metering::Instant;

constexpr std::chrono::hours kForget{72};  // older events are not sent any more
constexpr std::size_t kRefusedMax = 50;    // one after the other, before it is tried later
constexpr std::size_t kTextShown = 200;    // of an alert that was refused
constexpr std::size_t kNotifiedMax = 1'000;
/// How much of the past a new destination receives. The recovery of a store at the start is in it.
constexpr std::chrono::hours kNotifiedAtFirst{1};
constexpr int kEventsOfThePast = 1'000;
/// There was no recald before: such a stamp is of a clock that was not set.
constexpr Instant kFirstRecald = std::chrono::sys_days{std::chrono::year{2026} / 1 / 1};
constexpr int kPagesMax = 20;                // of events at a look
constexpr std::chrono::days kCountedFor{1};  // as the store counts repeated events

/// Whether a stamp says how long ago something was. A trial's clock may show any time.
bool has_age(Instant stamp, Instant now) { return stamp >= kFirstRecald || now < kFirstRecald; }

bool is_same(const StoreEvent& a, const StoreEvent& b) {
  return a.kind == b.kind && a.subject == b.subject && a.time == b.time;
}

bool has(const std::vector<StoreEvent>& events, const StoreEvent& event) {
  return std::ranges::any_of(events, [&](const StoreEvent& one) { return is_same(one, event); });
}

}  // namespace

AlertOutbox::AlertOutbox(Loop& loop, EventStore& store, AlertMemory& memory,
                         Destination destination, Notify notify,
                         std::shared_ptr<const SiteConfig> site, metering::LocalCalendar calendar)
    : Outbox(loop, std::move(destination), std::move(notify)),
      store_(store),
      memory_(memory),
      site_(std::move(site)),
      calendar_(std::move(calendar)) {}

Result<OutgoingBatch> AlertOutbox::next(int limit) {
  const Instant now = loop().now().instant();
  auto pending = TRY(this->pending(now));
  std::erase_if(pending.events, [&](const StoreEvent& event) { return has(refused_, event); });
  OutgoingBatch batch;
  if (pending.events.empty()) {
    if (refused_.empty() && pending.position) move(*pending.position);
    refused_.clear();  // no others are left to tell by: they are tried again
    return batch;
  }
  if (waits_for_morning(pending, now)) return batch;
  batch.events = std::move(pending.events);
  if (std::ssize(batch.events) > limit) batch.events.resize(static_cast<std::size_t>(limit));
  return batch;
}

Result<std::int64_t> AlertOutbox::position(Instant now) {
  const std::string& id = destination().id;
  const auto known = memory_.positions.find(id);
  if (known != memory_.positions.end()) return known->second;
  const auto stored = TRY(store_.cursor(id));
  if (stored) return memory_.positions[id] = *stored;
  const auto past = TRY(store_.events(kEventsOfThePast));
  std::int64_t position = 0;
  for (const StoreEvent& event : past) {
    const bool is_old = has_age(event.time, now) && event.time < now - kNotifiedAtFirst;
    if (is_old) position = std::max(position, event.number);
  }
  // Now, so that what this destination misses is still new to it after a restart.
  TRY(store_.put_cursor(id, position));
  return memory_.positions[id] = position;
}

Result<AlertOutbox::Pending> AlertOutbox::pending(Instant now) {
  Pending pending;
  // A store that cannot even be read has nothing to add to what is in memory.
  const auto added = add_stored(now, pending);
  if (!added && !memory_.store_refuses) return tl::unexpected(added.error());
  if (memory_.store_refuses) add_unstored(now, pending);
  return pending;
}

Result<void> AlertOutbox::add_stored(Instant now, Pending& pending) {
  const auto position = TRY(this->position(now));
  // All of them: in quiet hours an error may stand behind a thousand meters that fell silent.
  pending.position = position;
  for (int page = 0; page < kPagesMax; ++page) {
    const auto events = TRY(store_.events_after(*pending.position, kOutboxBatch));
    for (const StoreEvent& event : events) {
      pending.position = event.number;
      const bool is_new = is_alert(event, now) && !was_notified(event);
      if (is_new) pending.events.push_back(event);
    }
    if (std::ssize(events) < kOutboxBatch) break;
  }
  return {};
}

void AlertOutbox::add_unstored(Instant now, Pending& pending) const {
  for (const auto& [event, at] : memory_.recent) {
    if (has(pending.events, event) || !is_alert(event, now) || was_notified(event)) continue;
    pending.events.push_back(event);
  }
}

bool AlertOutbox::is_alert(const StoreEvent& event, Instant now) const {
  const bool is_chosen =
      std::ranges::find(site_->alerts.about, event.kind) != site_->alerts.about.end();
  // What happened before the clock was set has no age.
  const Instant at = event.last.value_or(event.time);
  return is_chosen && (!has_age(at, now) || at > now - kForget);
}

bool AlertOutbox::was_notified(const StoreEvent& event) const {
  const auto notified = memory_.notified.find(destination().id);
  if (notified == memory_.notified.end()) return false;
  return std::ranges::any_of(notified->second, [&](const NotifiedEvent& one) {
    const bool is_repeated =
        event.is_counted && one.time <= event.time && event.time < one.time + kCountedFor;
    return one.kind == event.kind && one.subject == event.subject &&
           (one.time == event.time || is_repeated);
  });
}

bool AlertOutbox::waits_for_morning(const Pending& pending, Instant now) const {
  if (!site_->alerts.quiet) return false;
  const std::chrono::minutes time_of_day{calendar_.local_time(now).minute_of_day};
  return site_->alerts.quiet->contain(time_of_day) &&
         std::ranges::none_of(pending.events, [](const StoreEvent& event) {
           return event.severity == Severity::error;
         });
}

Result<void> AlertOutbox::move_past(const OutgoingBatch& batch) {
  remember(batch.events);
  // One that the store does not have yet has no number, and comes after those that it has.
  const auto last = std::ranges::max_element(batch.events, {}, &StoreEvent::number);
  if (last->number > 0) move(last->number);
  return {};
}

/// A cursor that cannot be stored moves in memory, and is stored with the next move.
void AlertOutbox::move(std::int64_t position) {
  std::int64_t& known = memory_.positions[destination().id];
  if (std::exchange(known, position) != position) {
    (void)store_.put_cursor(destination().id, position);
  }
}

Result<bool> AlertOutbox::set_aside(const OutgoingBatch& batch, const std::string& why) {
  refused_.push_back(batch.events.front());
  // What comes after it may be taken; a destination that takes nothing at all is tried later.
  const auto others = next(1);
  if (others && others->size() > 0 && refused_.size() <= kRefusedMax) return false;
  return failure(ErrorCode::io_failed, why);
}

void AlertOutbox::on_failure(const std::string& why, bool is_first) {
  refused_.clear();
  if (!is_first) return;
  report(Severity::warning, "alert_not_sent",
         fmt::format("no alert can be sent as {}: {}; recald keeps trying for three days", words(),
                     why));
}

void AlertOutbox::on_success(const OutgoingBatch& batch, bool /*is_first*/) {
  report_refused();
  report(
      Severity::info, "alert_sent",
      fmt::format("{} sent as {}",
                  batch.size() == 1 ? "1 alert was" : fmt::format("{} alerts were", batch.size()),
                  words()));
}

void AlertOutbox::report_refused() {
  const std::vector<StoreEvent> refused = std::exchange(refused_, {});
  if (refused.empty()) return;
  remember(refused);
  const bool is_one = refused.size() == 1;
  report(Severity::warning, "alert_refused",
         fmt::format("{} refuses {} and takes others; {} not sent again: {}", words(),
                     is_one ? "an alert" : fmt::format("{} alerts", refused.size()),
                     is_one ? "it is" : "they are", limited(refused.front().text, kTextShown)));
}

void AlertOutbox::remember(const std::vector<StoreEvent>& events) {
  auto& notified = memory_.notified[destination().id];
  for (const StoreEvent& event : events)
    notified.push_back({event.time, event.kind, event.subject});
  while (notified.size() > kNotifiedMax) notified.pop_front();
}

}  // namespace recald::daemon
