#include "daemon/gateway/forward/record_sink.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

#include "core/text/limited.hpp"

namespace recald::daemon {
namespace {

using record::RecordBatch;
using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr int kTimes_max = 3;  ///< Of one batch, before it waits like after a failure.

std::size_t count_in(const RecordBatch& batch) {
  return batch.entries.size() + batch.events.size() + batch.results.size();
}

/// Moves up to `left` from the front of a list to another, and counts down.
template <class T>
void move_front(std::vector<T>& from, std::vector<T>& to, std::size_t& left) {
  const auto end = from.begin() + static_cast<std::ptrdiff_t>(std::min(left, from.size()));
  left -= static_cast<std::size_t>(end - from.begin());
  to.assign(std::make_move_iterator(from.begin()), std::make_move_iterator(end));
  from.erase(from.begin(), end);
}

/// What one event or result says, at its shortest: that there was one is told all the same, since
/// the record counts them.
constexpr std::size_t kShortText = 80;

/// Without documents and with the beginnings of texts.
std::string shortened(RecordBatch& batch) {
  for (StoredJob& job : batch.results) {
    job.result.document.clear();
    job.message = limited(job.message, kShortText);
    job.asked_by = limited(job.asked_by, kShortText);
  }
  for (StoreEvent& event : batch.events) {
    event.kind = limited(event.kind, kShortText);
    event.subject = limited(event.subject, kShortText);
    event.text = limited(event.text, kShortText);
  }
  return record::to_json(batch);
}

/// Takes the first half out of a batch, which then follows it.
RecordBatch take_half(RecordBatch& batch) {
  RecordBatch half{.outbox = batch.outbox, .after = batch.after, .is_first = batch.is_first};
  std::size_t left = count_in(batch) / 2;
  move_front(batch.entries, half.entries, left);
  move_front(batch.events, half.events, left);
  move_front(batch.results, half.results, left);
  batch.after = half.until();
  return half;
}

class RecordSink final : public Sink {
 public:
  RecordSink(std::string site, std::shared_ptr<RecordLink> link, const RecordRules& rules)
      : site_(std::move(site)), link_(std::move(link)), rules_(rules) {}

  Sent send(const OutgoingBatch& batch, const std::stop_token& stop) override {
    if (!link_) return waits("it is not connected");
    return send(RecordBatch{.outbox = batch.is_history ? -batch.identity : batch.identity,
                            .after = batch.after,
                            .is_first = batch.is_first,
                            .entries = batch.entries,
                            .events = batch.events,
                            .results = batch.results},
                stop);
  }

 private:
  static Sent waits(std::string why) {
    return {.outcome = Sent::Outcome::later, .why = std::move(why)};
  }

  Sent send(RecordBatch batch, const std::stop_token& stop) {
    record::Watermark wanted{.outbox = batch.outbox, .until = batch.until()};
    // What was sent before the last failure may have arrived after it.
    if (const auto answer = link_->wait_for(wanted, link_->calls(), milliseconds{0}, stop)) {
      return {.until = answer->until};
    }
    wanted.answers = batch.question = link_->next_question();
    std::string payload = record::to_json(batch);
    if (payload.size() > rules_.payload_bytes && count_in(batch) > 1) {
      return send_in_halves(std::move(batch), stop);
    }
    if (payload.size() > rules_.result_bytes) payload = shortened(batch);
    const auto until = steady_clock::now() + rules_.confirm_max;
    for (int times = 1;; ++times) {
      const int calls = link_->calls();
      auto published = link_->publish(payload, rules_.publish_max, stop);
      if (!published && published.error().code == ErrorCode::out_of_range) {
        // The broker takes less than we do.
        if (count_in(batch) > 1) return send_in_halves(std::move(batch), stop);
        payload = shortened(batch);
        published = link_->publish(payload, rules_.publish_max, stop);
      }
      if (!published) return waits(published.error().message);
      const auto left = std::chrono::ceil<milliseconds>(until - steady_clock::now());
      const auto answer = link_->wait_for(wanted, calls, left, stop);
      if (answer && covers(*answer, wanted)) return {.until = answer->until};
      if (answer) return {.outcome = Sent::Outcome::behind, .until = answer->until};
      const bool is_over = stop.stop_requested() || steady_clock::now() >= until;
      if (is_over) break;
      // A record that has just come may have lost what was on its way.
      if (link_->calls() == calls || times == kTimes_max) {
        return waits("the connection was lost before the fleet's record confirmed what was sent");
      }
    }
    return waits(
        fmt::format("the fleet's record has not confirmed what was sent within {} s; `recald "
                    "worker` or its PostgreSQL is away, or site '{}' is not registered there with "
                    "`recald fleet add`",
                    std::chrono::duration<double>{rules_.confirm_max}.count(), site_));
  }

  Sent send_in_halves(RecordBatch batch, const std::stop_token& stop) {
    Sent sent = send(take_half(batch), stop);
    if (sent.outcome != Sent::Outcome::taken) return sent;
    batch.is_first = false;
    return send(std::move(batch), stop);
  }

  std::string site_;
  std::shared_ptr<RecordLink> link_;
  RecordRules rules_;
};

}  // namespace

std::unique_ptr<Sink> make_record_sink(std::string site, std::shared_ptr<RecordLink> link,
                                       const RecordRules& rules) {
  return std::make_unique<RecordSink>(std::move(site), std::move(link), rules);
}

}  // namespace recald::daemon
