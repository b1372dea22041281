#include "daemon/gateway/forward/forwarder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

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

}  // namespace

Forwarder::Forwarder(Ports ports, std::unique_ptr<Worker> worker, Destination destination,
                     std::unique_ptr<Sink> sink, Tell tell, const ForwardRules& rules)
    : ports_(ports),
      destination_(std::move(destination)),
      sink_(std::move(sink)),
      tell_(std::move(tell)),
      rules_(rules),
      batch_(rules.batch),
      self_(std::make_shared<Forwarder*>(this)),
      worker_(std::move(worker)) {}

Forwarder::~Forwarder() { stop_.request_stop(); }

DestinationStatus Forwarder::status() const {
  DestinationStatus status{.name = destination_.words, .why = why_, .told_at = told_at_};
  const auto position = ports_.store.outbox_position(destination_.id);
  if (position) status.waiting = position->last - position->told;
  return status;
}

void Forwarder::schedule(milliseconds wait) {
  const milliseconds due = ports_.loop.now().monotonic + wait;
  if (due_ && *due_ <= due) return;
  due_ = due;
  ports_.loop.after(wait, [weak = std::weak_ptr{self_}, due] {
    const auto self = weak.lock();
    if (!self || (*self)->due_ != due) return;
    (*self)->due_.reset();
    (*self)->look();
  });
}

void Forwarder::look() {
  schedule(rules_.look_every);
  if (is_sending_ || ports_.loop.now().monotonic < not_before_) return;
  auto batch = next();
  // A store that cannot be read says so itself.
  if (batch && batch->size() > 0) send(std::move(*batch));
}

Result<OutgoingBatch> Forwarder::next() {
  OutgoingBatch batch;
  const auto from = position();
  if (!from) return tl::unexpected(from.error());
  auto entries = ports_.store.outbox_after(from->told, batch_);
  if (!entries) return tl::unexpected(entries.error());
  batch.entries = std::move(*entries);
  const int left = batch_ - static_cast<int>(batch.entries.size());
  if (!destination_.wants_events || left <= 0) return batch;
  const auto after = event_position();
  if (!after) return tl::unexpected(after.error());
  auto events = ports_.store.events_after(*after, left);
  if (!events) return tl::unexpected(events.error());
  batch.events = std::move(*events);
  return batch;
}

Result<OutboxPosition> Forwarder::position() {
  auto position = ports_.store.outbox_position(destination_.id);
  if (!position) return position;
  const std::int64_t left_out = position->last - position->told - rules_.waiting_max;
  if (left_out <= 0) return position;
  position->told += left_out;
  if (auto put = ports_.store.put_outbox_position(destination_.id, position->told); !put) {
    return tl::unexpected(put.error());
  }
  tell_({.time = ports_.loop.now().instant(),
         .severity = Severity::error,
         .kind = "forward_left_out",
         .subject = destination_.words,
         .text = fmt::format("{} has not taken anything for so long that the oldest {} intervals "
                             "and months are not sent to it any more; they are in the store",
                             destination_.words, left_out),
         .is_counted = true});
  return position;
}

/// A new destination is told of what happens from now on.
Result<std::int64_t> Forwarder::event_position() {
  const auto known = ports_.store.cursor(events_cursor(destination_.id));
  if (!known) return tl::unexpected(known.error());
  if (*known) return **known;
  const auto last = ports_.store.events(1);
  if (!last) return tl::unexpected(last.error());
  const std::int64_t position = last->empty() ? 0 : last->front().number;
  if (auto put = ports_.store.put_cursor(events_cursor(destination_.id), position); !put) {
    return tl::unexpected(put.error());
  }
  return position;
}

void Forwarder::send(OutgoingBatch batch) {
  const auto sent = std::make_shared<Sent>();
  const auto shared = std::make_shared<const OutgoingBatch>(std::move(batch));
  is_sending_ = true;
  worker_->run([sink = sink_, shared, sent,
                stop = stop_.get_token()] { *sent = send_safely(*sink, *shared, stop); },
               [weak = std::weak_ptr{self_}, shared, sent] {
                 if (const auto self = weak.lock()) (*self)->finish(*shared, *sent);
               });
}

void Forwarder::finish(const OutgoingBatch& batch, const Sent& sent) {
  is_sending_ = false;
  switch (sent.outcome) {
    case Sent::Outcome::taken:
      if (!move_past(batch)) return;
      break;
    case Sent::Outcome::partly:
      if (!set_aside(batch, sent.why)) return;
      break;
    case Sent::Outcome::refused:
      if (batch.size() > 1) {
        batch_ = static_cast<int>(batch.size()) / 2;
        return schedule(milliseconds{0});
      }
      if (!set_aside(batch, sent.why)) return;
      break;
    case Sent::Outcome::later:
      return wait_after(sent);
  }
  tell_of_success();
  batch_ = std::min(2 * batch_, rules_.batch);
  schedule(milliseconds{0});
}

/// @return whether the position could be stored; if not, the batch is sent again.
bool Forwarder::move_past(const OutgoingBatch& batch) {
  const auto moved = ports_.store.as_one([&]() -> Result<void> {
    if (!batch.entries.empty()) {
      const std::int64_t number = batch.entries.back().number;
      auto put = ports_.store.put_outbox_position(destination_.id, number);
      if (!put) return put;
    }
    if (batch.events.empty()) return {};
    return ports_.store.put_cursor(events_cursor(destination_.id), batch.events.back().number);
  });
  if (!moved) wait_after({.outcome = Sent::Outcome::later, .why = moved.error().message});
  return moved.has_value();
}

bool Forwarder::set_aside(const OutgoingBatch& batch, const std::string& why) {
  if (!move_past(batch)) return false;
  const std::string what =
      batch.size() > 1        ? fmt::format("a part of {} intervals and months", batch.size())
      : batch.entries.empty() ? "an event"
                              : fmt::format("a reading of '{}'", batch.entries.front().meter);
  tell_({.time = ports_.loop.now().instant(),
         .severity = Severity::warning,
         .kind = "forward_refused",
         .subject = destination_.words,
         .text = fmt::format("{} refuses {}, which is not sent again: {}", destination_.words, what,
                             why),
         .is_counted = true});
  return true;
}

void Forwarder::wait_after(const Sent& sent) {
  const Moment now = ports_.loop.now();
  const bool is_first = wait_ == milliseconds{0};
  wait_ = is_first ? rules_.retry_min : std::min(2 * wait_, rules_.retry_max);
  const auto asked = std::chrono::duration_cast<milliseconds>(sent.wait);
  wait_ = std::max(wait_, std::min(asked, rules_.asked_max));
  not_before_ = now.monotonic + wait_;
  schedule(wait_);
  why_ = sent.why;
  if (!is_first) return;
  tell_({.time = now.instant(),
         .severity = Severity::warning,
         .kind = "forward_failed",
         .subject = destination_.words,
         .text = fmt::format("nothing can be sent to {}: {}; recald keeps it and tries again",
                             destination_.words, sent.why),
         .is_counted = true});
}

void Forwarder::tell_of_success() {
  const Moment now = ports_.loop.now();
  told_at_ = now.instant();
  not_before_ = milliseconds{0};
  if (std::exchange(wait_, milliseconds{0}) == milliseconds{0}) return;
  why_.clear();
  tell_({.time = now.instant(),
         .severity = Severity::info,
         .kind = "forward_works",
         .subject = destination_.words,
         .text = fmt::format("{} takes data again", destination_.words),
         .is_counted = true});
}

}  // namespace recald::daemon
