#include "daemon/gateway/forward/record_sink.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "adapters/ports/destination_cursors.hpp"

namespace recald::daemon {
namespace {

using record::RecordBatch;

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

/// Takes the first half out of a batch, which then follows it.
RecordBatch take_half(RecordBatch& batch) {
  RecordBatch half{.outbox = batch.outbox, .after = batch.after};
  std::size_t left = count_in(batch) / 2;
  move_front(batch.entries, half.entries, left);
  move_front(batch.events, half.events, left);
  move_front(batch.results, half.results, left);
  batch.after = half.until();
  return half;
}

class RecordSink final : public Sink {
 public:
  RecordSink(std::string site, std::int64_t outbox, std::shared_ptr<RecordLink> link,
             const RecordRules& rules)
      : site_(std::move(site)), outbox_(outbox), link_(std::move(link)), rules_(rules) {}

  Sent send(const OutgoingBatch& batch, const std::stop_token& stop) override {
    if (!link_) return waits("it is not connected");
    return send(RecordBatch{.outbox = batch.is_history ? -outbox_ : outbox_,
                            .after = batch.after,
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
    const record::Watermark wanted{.outbox = batch.outbox, .until = batch.until()};
    // What was sent before the last failure may have arrived after it.
    if (link_->wait_for(wanted, std::chrono::milliseconds{0}, stop)) return {};
    std::string payload = record::to_json(batch);
    if (payload.size() > rules_.payload_bytes && count_in(batch) > 1) {
      Sent sent = send(take_half(batch), stop);
      return sent.outcome == Sent::Outcome::taken ? send(std::move(batch), stop) : sent;
    }
    if (payload.size() > rules_.result_bytes && !batch.results.empty()) {
      batch.results.front().result.document.clear();
      payload = record::to_json(batch);
    }
    if (auto sent = link_->publish(std::move(payload), rules_.publish_max, stop); !sent) {
      return waits(sent.error().message);
    }
    if (link_->wait_for(wanted, rules_.confirm_max, stop)) return {};
    return waits(
        fmt::format("the fleet's record has not confirmed what was sent within {} s; `recald "
                    "worker` or its PostgreSQL is away, or site '{}' is not registered there with "
                    "`recald fleet add`",
                    std::chrono::duration<double>{rules_.confirm_max}.count(), site_));
  }

  std::string site_;
  std::int64_t outbox_;
  std::shared_ptr<RecordLink> link_;
  RecordRules rules_;
};

}  // namespace

std::unique_ptr<Sink> make_record_sink(std::string site, std::int64_t outbox,
                                       std::shared_ptr<RecordLink> link, const RecordRules& rules) {
  return std::make_unique<RecordSink>(std::move(site), outbox, std::move(link), rules);
}

Result<std::int64_t> outbox_identity(Store& store, const std::string& destination) {
  const std::string cursor = identity_cursor(destination);
  const auto known = store.cursor(cursor);
  if (!known) return tl::unexpected(known.error());
  if (*known) return **known;
  std::random_device random;
  std::uniform_int_distribution<std::int64_t> any{1, std::numeric_limits<std::int64_t>::max()};
  const std::int64_t identity = any(random);
  if (auto put = store.put_cursor(cursor, identity); !put) return tl::unexpected(put.error());
  return identity;
}

}  // namespace recald::daemon
