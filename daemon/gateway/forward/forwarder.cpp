#include "daemon/gateway/forward/forwarder.hpp"

#include <algorithm>
#include <utility>

namespace recald::daemon {
namespace {

using std::chrono::milliseconds;

constexpr std::chrono::hours kCalm{24};  // without a resend

Sent later_because(const Error& error) {
  return {.outcome = Sent::Outcome::later, .why = error.message};
}

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

Forwarder::Forwarder(Loop& loop, std::unique_ptr<Worker> worker, std::unique_ptr<Outbox> outbox,
                     std::unique_ptr<Sink> sink, const ForwardRules& rules)
    : loop_(loop),
      outbox_(std::move(outbox)),
      sink_(std::move(sink)),
      rules_(rules),
      batch_(rules.batch),
      wakeup_(loop, [this] { poll(); }),
      worker_(std::move(worker)) {}

Forwarder::~Forwarder() { stop_.request_stop(); }

DestinationStatus Forwarder::status() const {
  return {
      .name = destination().words, .waiting = outbox_->waiting(), .why = why_, .sent_at = sent_at_};
}

void Forwarder::try_now() {
  is_asked_ = is_sending_;
  if (is_sending_ || wait_ == milliseconds{0}) return;
  not_before_ = milliseconds{0};
  wakeup_.after(milliseconds{0});
}

void Forwarder::poll() {
  wakeup_.after(rules_.poll_every);
  if (is_sending_ || loop_.now().monotonic < not_before_) return;
  auto batch = outbox_->next(batch_);
  // A store that cannot be read says so itself.
  if (!batch || batch->size() == 0) return;
  batch->time = loop_.now().instant();
  send(std::move(*batch));
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
  if (!settle(batch, sent)) return;
  report_success(batch);
  batch_ = std::min(2 * batch_, rules_.batch);
  wakeup_.after(milliseconds{0});
}

/// @return whether the destination works and the outbox is past the batch.
bool Forwarder::settle(const OutgoingBatch& batch, const Sent& sent) {
  switch (sent.outcome) {
    case Sent::Outcome::taken:
      if (outbox_->is_beyond_us(batch, sent)) break;
      if (const auto moved = outbox_->move_past(batch); !moved) {
        wait_after(later_because(moved.error()));
        return false;
      }
      return true;
    case Sent::Outcome::behind:
      break;
    case Sent::Outcome::refused:
      if (batch.size() > 1) {
        batch_ = static_cast<int>(batch.size()) / 2;
        wakeup_.after(milliseconds{0});
        return false;
      }
      return set_aside(batch, sent);
    case Sent::Outcome::partly:
      return set_aside(batch, sent);
    case Sent::Outcome::later:
      wait_after(sent);
      return false;
  }
  resend_all(batch, sent);
  return false;
}

bool Forwarder::set_aside(const OutgoingBatch& batch, const Sent& sent) {
  const auto is_past = outbox_->set_aside(batch, sent.why);
  if (!is_past) {
    wait_after(later_because(is_past.error()));
    return false;
  }
  if (!*is_past) wakeup_.after(milliseconds{0});
  return *is_past;
}

void Forwarder::resend_all(const OutgoingBatch& batch, const Sent& sent) {
  if (const auto begun = outbox_->resend_all(batch, sent); !begun) {
    return wait_after(later_because(begun.error()));
  }
  // The first time at once; where two records answer in turns, this would have no end.
  const milliseconds now = loop_.now().monotonic;
  const bool was_calm = !anew_at_ || now - *anew_at_ > kCalm;
  const milliseconds wait = was_calm ? milliseconds{0} : anew_wait_;
  anew_wait_ = std::clamp(2 * wait, rules_.retry_min, rules_.asked_max);
  anew_at_ = now;
  not_before_ = now + wait;
  wakeup_.after(wait);
}

void Forwarder::wait_after(const Sent& sent) {
  const milliseconds now = loop_.now().monotonic;
  const bool is_first = wait_ == milliseconds{0};
  wait_ = is_first ? rules_.retry_min : std::min(2 * wait_, rules_.retry_max);
  const auto asked = std::chrono::duration_cast<milliseconds>(sent.wait);
  wait_ = std::max(wait_, std::min(asked, rules_.asked_max));
  const milliseconds until = is_asked_ ? milliseconds{0} : wait_;
  not_before_ = now + until;
  wakeup_.after(until);
  why_ = sent.why;
  outbox_->on_failure(sent.why, is_first);
}

void Forwarder::report_success(const OutgoingBatch& batch) {
  sent_at_ = loop_.now().instant();
  not_before_ = milliseconds{0};
  const bool had_failed = std::exchange(wait_, milliseconds{0}) != milliseconds{0};
  why_.clear();
  outbox_->on_success(batch, had_failed);
}

}  // namespace recald::daemon
