#include "daemon/gateway/forward/forwarder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "adapters/ports/destination_cursors.hpp"
#include "daemon/gateway/forward/outbox_identity.hpp"

namespace recald::daemon {
namespace {

using std::chrono::milliseconds;

/// An exception is the reason why it was not sent. A single entry is refused only by a destination
/// that would take others.
Sent send_safely(Sink& sink, const OutgoingBatch& batch, const std::stop_token& stop) {
  try {
    Sent sent = sink.send(batch, stop);
    if (sent.outcome != Sent::Outcome::refused || batch.size() > 1) return sent;
    if (sink.send({}, stop).outcome != Sent::Outcome::taken) sent.outcome = Sent::Outcome::later;
    return sent;
  } catch (const std::exception& thrown) {
    return {.outcome = Sent::Outcome::later, .why = thrown.what()};
  }
}

const OutboxEntry kEndOfHistory{
    .number = record::kHistorySent, .meter = "", .interval = std::chrono::seconds{1}, .stored = {}};
constexpr std::chrono::hours kCalm{24};  // without a resend
constexpr int kResults_max = 10;         // of a tenth of a megabyte each
constexpr std::array kJobKinds{JobKind::calibration, JobKind::diagnosis};

/// The number before the first job that waits or runs, so that a position passes none; without
/// one, that of the newest.
Result<std::int64_t> last_settled_job(Store& store) {
  const auto unfinished = TRY(store.unfinished_jobs());
  if (!unfinished.empty()) return unfinished.front().number - 1;
  std::int64_t last = 0;
  for (const JobKind kind : kJobKinds) {
    const auto newest = TRY(store.jobs(kind, 1));
    if (!newest.empty()) last = std::max(last, newest.front().number);
  }
  return last;
}

/// Those with a number of (after, last], in order, with their results.
Result<std::vector<StoredJob>> jobs_between(Store& store, std::int64_t after, std::int64_t last,
                                            int limit) {
  std::vector<StoredJob> jobs;
  for (std::int64_t number = after + 1; number <= last; ++number) {
    if (static_cast<int>(jobs.size()) == limit) break;
    auto job = TRY(store.job(number));
    if (job) jobs.push_back(std::move(*job));
  }
  return jobs;
}

}  // namespace

Forwarder::Forwarder(Ports ports, std::unique_ptr<Worker> worker, Destination destination,
                     std::unique_ptr<Sink> sink, Notify notify, const ForwardRules& rules)
    : ports_(ports),
      destination_(std::move(destination)),
      sink_(std::move(sink)),
      notify_(std::move(notify)),
      rules_(rules),
      batch_(rules.batch),
      wakeup_(ports.loop, [this] { poll(); }),
      worker_(std::move(worker)) {}

Forwarder::~Forwarder() { stop_.request_stop(); }

DestinationStatus Forwarder::status() const {
  DestinationStatus status{.name = destination_.words, .why = why_, .sent_at = sent_at_};
  const auto position = ports_.store.outbox_position(destination_.id);
  if (position) status.waiting = position->last - position->sent;
  return status;
}

void Forwarder::try_now() {
  is_asked_ = is_sending_;
  if (is_sending_ || wait_ == milliseconds{0}) return;
  not_before_ = milliseconds{0};
  wakeup_.after(milliseconds{0});
}

void Forwarder::poll() {
  wakeup_.after(rules_.poll_every);
  if (is_sending_ || ports_.loop.now().monotonic < not_before_) return;
  auto batch = next();
  // A store that cannot be read says so itself.
  if (!batch || batch->size() == 0) return;
  if (identify(*batch)) send(std::move(*batch));
}

Result<OutgoingBatch> Forwarder::next() {
  OutgoingBatch batch;
  // Its events and results begin with the first look, however long the past takes.
  if (destination_.wants_events) {
    batch.after.events = TRY(event_position());
  }
  if (destination_.wants_results) {
    batch.after.results = TRY(result_position());
  }
  const auto from = position();  // first: what waits has a limit, whatever is sent meanwhile
  if (!from) return tl::unexpected(from.error());
  auto past = next_history();
  if (!past || past->size() > 0) return past;
  batch.after.entries = from->sent;
  batch.entries = TRY(ports_.store.outbox_after(from->sent, batch_));
  for (const auto add : {&Forwarder::add_events, &Forwarder::add_results}) {
    TRY((this->*add)(batch));
  }
  return batch;
}

/// @return an empty one: all of it was sent, or none is wanted.
Result<OutgoingBatch> Forwarder::next_history() {
  OutgoingBatch batch;
  if (destination_.history.empty()) return batch;
  const std::string cursor = history_cursor(destination_.id);
  const auto known = TRY(ports_.store.cursor(cursor));
  const std::int64_t after = known.value_or(0);
  if (after >= record::kHistorySent) return batch;
  if (after == 0) {
    // What waits by now is part of the past, which is read after this.
    const auto position = TRY(ports_.store.outbox_position(destination_.id));
    TRY(ports_.store.put_outbox_position(destination_.id, position.last));
  }
  auto entries = TRY(history_after(ports_.store, destination_.history, after, batch_));
  if (entries.empty() && !destination_.has_identity) {
    TRY(ports_.store.put_cursor(cursor, record::kHistorySent));
    return batch;
  }
  if (entries.empty()) entries.push_back(kEndOfHistory);
  batch.is_history = true;
  batch.after.entries = after;
  batch.entries = std::move(entries);
  return batch;
}

Result<void> Forwarder::identify(OutgoingBatch& batch) {
  if (!destination_.has_identity) return {};
  const auto identity = TRY(outbox_identity(ports_.store, destination_.id));
  const auto taken = TRY(has_taken(ports_.store, destination_.id, identity));
  batch.identity = identity;
  batch.is_first = batch.is_history ? batch.after.entries == 0 : !taken;
  return {};
}

Result<std::int64_t> Forwarder::event_position() {
  return position_of(events_cursor(destination_.id), [this]() -> Result<std::int64_t> {
    const auto last = TRY(ports_.store.events(1));
    return last.empty() ? 0 : last.front().number;
  });
}

Result<std::int64_t> Forwarder::result_position() {
  return position_of(results_cursor(destination_.id),
                     [this] { return last_settled_job(ports_.store); });
}

Result<void> Forwarder::add_events(OutgoingBatch& batch) {
  const int room = room_in(batch);
  if (!destination_.wants_events || room == 0) return {};
  batch.events = TRY(ports_.store.events_after(batch.after.events, room));
  return {};
}

Result<void> Forwarder::add_results(OutgoingBatch& batch) {
  if (!destination_.wants_results) return {};
  const auto last = TRY(last_settled_job(ports_.store));
  if (batch.after.results >= last) return {};
  batch.results = TRY(jobs_between(ports_.store, batch.after.results, last,
                                   std::min(room_in(batch), kResults_max)));
  return {};
}

Result<OutboxPosition> Forwarder::position() {
  auto position = ports_.store.outbox_position(destination_.id);
  if (!position) return position;
  const std::int64_t left_out = position->last - position->sent - rules_.waiting_max;
  if (left_out <= 0) return position;
  if (destination_.has_identity) {
    TRY(begin_anew(ports_.store, destination_.id));
    report_resend("has not taken anything for so long that more waits than is kept for it");
    return position;
  }
  position->sent += left_out;
  TRY(ports_.store.put_outbox_position(destination_.id, position->sent));
  notify_({.time = ports_.loop.now().instant(),
           .severity = Severity::error,
           .kind = "forward_left_out",
           .subject = destination_.words,
           .text = fmt::format("{} has not taken anything for so long that the oldest {} intervals "
                               "and months are not sent to it any more; they are in the store",
                               destination_.words, left_out),
           .is_counted = true});
  return position;
}

/// A new destination receives what happens from now on. @param last  Number of what happened
/// last.
Result<std::int64_t> Forwarder::position_of(const std::string& cursor,
                                            const std::function<Result<std::int64_t>()>& last) {
  const auto known = TRY(ports_.store.cursor(cursor));
  if (known) return *known;
  auto position = last();
  if (!position) return position;
  TRY(ports_.store.put_cursor(cursor, *position));
  return position;
}

void Forwarder::send(OutgoingBatch batch) {
  const auto sent = std::make_shared<Sent>();
  const auto shared = std::make_shared<const OutgoingBatch>(std::move(batch));
  is_sending_ = true;
  is_asked_ = false;
  worker_->run([sink = sink_, shared, sent,
                stop = stop_.get_token()] { *sent = send_safely(*sink, *shared, stop); },
               alive_.guard([this, shared, sent] { finish(*shared, *sent); }));
}

void Forwarder::finish(const OutgoingBatch& batch, const Sent& sent) {
  is_sending_ = false;
  switch (sent.outcome) {
    case Sent::Outcome::taken:
      if (is_beyond_us(batch, sent)) return resend_all(batch, sent);
      if (!move_past(batch)) return;
      break;
    case Sent::Outcome::behind:
      return resend_all(batch, sent);
    case Sent::Outcome::partly:
      if (!set_aside(batch, sent.why)) return;
      break;
    case Sent::Outcome::refused:
      if (batch.size() > 1) {
        batch_ = static_cast<int>(batch.size()) / 2;
        return wakeup_.after(milliseconds{0});
      }
      if (!set_aside(batch, sent.why)) return;
      break;
    case Sent::Outcome::later:
      return wait_after(sent);
  }
  report_success();
  batch_ = std::min(2 * batch_, rules_.batch);
  wakeup_.after(milliseconds{0});
}

/// @return whether the position could be stored; if not, the batch is sent again.
bool Forwarder::move_past(const OutgoingBatch& batch) {
  const auto moved = ports_.store.as_one([&]() -> Result<void> {
    if (batch.identity != 0 && !batch.is_history && batch.is_first) {
      auto put = put_taken(ports_.store, destination_.id, batch.identity);
      if (!put) return put;
    }
    if (!batch.entries.empty()) {
      const std::int64_t number = batch.entries.back().number;
      auto put = batch.is_history ? ports_.store.put_cursor(history_cursor(destination_.id), number)
                                  : ports_.store.put_outbox_position(destination_.id, number);
      if (!put) return put;
    }
    if (!batch.events.empty()) {
      const std::int64_t number = batch.events.back().number;
      auto put = ports_.store.put_cursor(events_cursor(destination_.id), number);
      if (!put) return put;
    }
    if (batch.results.empty()) return {};
    return ports_.store.put_cursor(results_cursor(destination_.id), batch.results.back().number);
  });
  if (!moved) wait_after({.outcome = Sent::Outcome::later, .why = moved.error().message});
  return moved.has_value();
}

/// What was on its way when a process ended explains one batch. Beyond it are numbers that this
/// store never gave: it is an image of what it was once, or somebody else's.
bool Forwarder::is_beyond_us(const OutgoingBatch& batch, const Sent& sent) const {
  if (!sent.until || batch.is_history) return false;
  const std::int64_t batch_max = std::max<std::int64_t>(rules_.batch, ForwardRules{}.batch);
  return sent.until->entries > batch.after.entries + batch_max;
}

/// What one side has and the other does not know of is not guessed: all is sent again, under
/// another identity.
void Forwarder::resend_all(const OutgoingBatch& batch, const Sent& sent) {
  const bool is_behind = sent.outcome == Sent::Outcome::behind;
  const auto done = ports_.store.as_one([&]() -> Result<void> {
    if (auto begun = begin_anew(ports_.store, destination_.id); !begun) return begun;
    // Of an outbox that it does not know, it receives what happens from now on.
    if (!is_behind || batch.is_history || *sent.until == record::Progress{}) return {};
    auto put = ports_.store.put_cursor(events_cursor(destination_.id),
                                       std::min(batch.after.events, sent.until->events));
    if (!put) return put;
    return ports_.store.put_cursor(results_cursor(destination_.id),
                                   std::min(batch.after.results, sent.until->results));
  });
  if (!done) return wait_after({.outcome = Sent::Outcome::later, .why = done.error().message});
  report_resend(is_behind
                    ? "has less than it had confirmed, as after a backup of it was restored"
                    : "has more than this store has told it, as after an image of this machine "
                      "was restored");
  // The first time at once; where two records answer in turns, this would have no end.
  const milliseconds now = ports_.loop.now().monotonic;
  const bool was_calm = !anew_at_ || now - *anew_at_ > kCalm;
  const milliseconds wait = was_calm ? milliseconds{0} : anew_wait_;
  anew_wait_ = std::clamp(2 * wait, rules_.retry_min, rules_.asked_max);
  anew_at_ = now;
  not_before_ = now + wait;
  wakeup_.after(wait);
}

void Forwarder::report_resend(const std::string& why) {
  notify_({.time = ports_.loop.now().instant(),
           .severity = Severity::warning,
           .kind = "forward_anew",
           .subject = destination_.words,
           .text = fmt::format("{} {}; everything that the store has of the present meters is sent "
                               "to it again",
                               destination_.words, why),
           .is_counted = true});
}

bool Forwarder::set_aside(const OutgoingBatch& batch, const std::string& why) {
  if (!move_past(batch)) return false;
  const std::string what =
      batch.size() > 1         ? fmt::format("a part of {} intervals and months", batch.size())
      : !batch.entries.empty() ? fmt::format("a reading of '{}'", batch.entries.front().meter)
      : !batch.events.empty()  ? "an event"
                               : "a result";
  notify_({.time = ports_.loop.now().instant(),
           .severity = Severity::warning,
           .kind = "forward_refused",
           .subject = destination_.words,
           .text = fmt::format("{} refuses {}, which is not sent again: {}", destination_.words,
                               what, why),
           .is_counted = true});
  return true;
}

void Forwarder::wait_after(const Sent& sent) {
  const Moment now = ports_.loop.now();
  const bool is_first = wait_ == milliseconds{0};
  wait_ = is_first ? rules_.retry_min : std::min(2 * wait_, rules_.retry_max);
  const auto asked = std::chrono::duration_cast<milliseconds>(sent.wait);
  wait_ = std::max(wait_, std::min(asked, rules_.asked_max));
  const milliseconds until = is_asked_ ? milliseconds{0} : wait_;
  not_before_ = now.monotonic + until;
  wakeup_.after(until);
  why_ = sent.why;
  if (!is_first) return;
  notify_({.time = now.instant(),
           .severity = Severity::warning,
           .kind = "forward_failed",
           .subject = destination_.words,
           .text = fmt::format("nothing can be sent to {}: {}; recald keeps it and tries again",
                               destination_.words, sent.why),
           .is_counted = true});
}

void Forwarder::report_success() {
  const Moment now = ports_.loop.now();
  sent_at_ = now.instant();
  not_before_ = milliseconds{0};
  if (std::exchange(wait_, milliseconds{0}) == milliseconds{0}) return;
  why_.clear();
  notify_({.time = now.instant(),
           .severity = Severity::info,
           .kind = "forward_works",
           .subject = destination_.words,
           .text = fmt::format("{} takes data again", destination_.words),
           .is_counted = true});
}

}  // namespace recald::daemon
