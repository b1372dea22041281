#include "daemon/gateway/forward/outbox/store_outbox.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "adapters/ports/destination_cursors.hpp"
#include "daemon/gateway/forward/outbox/outbox_identity.hpp"

namespace recald::daemon {
namespace {

const OutboxEntry kEndOfHistory{
    .number = record::kHistorySent, .meter = "", .interval = std::chrono::seconds{1}, .stored = {}};
constexpr int kResults_max = 10;  // of a tenth of a megabyte each
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

std::int64_t StoreOutbox::waiting() const {
  const auto position = store_.outbox_position(destination().id);
  return position ? position->last - position->sent : 0;
}

Result<OutgoingBatch> StoreOutbox::next(int limit) {
  auto batch = TRY(read(limit));
  if (batch.size() > 0) {
    TRY(identify(batch));
  }
  return batch;
}

Result<OutgoingBatch> StoreOutbox::read(int limit) {
  OutgoingBatch batch;
  // Its events and results begin with the first look, however long the past takes.
  if (destination().wants_events) {
    batch.after.events = TRY(event_position());
  }
  if (destination().wants_results) {
    batch.after.results = TRY(result_position());
  }
  const auto from = position();  // first: what waits has a limit, whatever is sent meanwhile
  if (!from) return tl::unexpected(from.error());
  auto past = next_history(limit);
  if (!past || past->size() > 0) return past;
  batch.after.entries = from->sent;
  batch.entries = TRY(store_.outbox_after(from->sent, limit));
  for (const auto add : {&StoreOutbox::add_events, &StoreOutbox::add_results}) {
    TRY((this->*add)(batch, limit));
  }
  return batch;
}

/// @return an empty one: all of it was sent, or none is wanted.
Result<OutgoingBatch> StoreOutbox::next_history(int limit) {
  OutgoingBatch batch;
  if (destination().history.empty()) return batch;
  const std::string cursor = history_cursor(destination().id);
  const auto known = TRY(store_.cursor(cursor));
  const std::int64_t after = known.value_or(0);
  if (after >= record::kHistorySent) return batch;
  if (after == 0) {
    // What waits by now is part of the past, which is read after this.
    const auto position = TRY(store_.outbox_position(destination().id));
    TRY(store_.put_outbox_position(destination().id, position.last));
  }
  auto entries = TRY(history_after(store_, destination().history, after, limit));
  if (entries.empty() && !destination().has_identity) {
    TRY(store_.put_cursor(cursor, record::kHistorySent));
    return batch;
  }
  if (entries.empty()) entries.push_back(kEndOfHistory);
  batch.is_history = true;
  batch.after.entries = after;
  batch.entries = std::move(entries);
  return batch;
}

Result<void> StoreOutbox::identify(OutgoingBatch& batch) {
  if (!destination().has_identity) return {};
  const auto identity = TRY(outbox_identity(store_, destination().id));
  const auto taken = TRY(has_taken(store_, destination().id, identity));
  batch.identity = identity;
  batch.is_first = batch.is_history ? batch.after.entries == 0 : !taken;
  return {};
}

Result<std::int64_t> StoreOutbox::event_position() {
  return position_of(events_cursor(destination().id), [this]() -> Result<std::int64_t> {
    const auto last = TRY(store_.events(1));
    return last.empty() ? 0 : last.front().number;
  });
}

Result<std::int64_t> StoreOutbox::result_position() {
  return position_of(results_cursor(destination().id), [this] { return last_settled_job(store_); });
}

Result<void> StoreOutbox::add_events(OutgoingBatch& batch, int limit) {
  const int room = limit - static_cast<int>(batch.size());
  if (!destination().wants_events || room <= 0) return {};
  batch.events = TRY(store_.events_after(batch.after.events, room));
  return {};
}

Result<void> StoreOutbox::add_results(OutgoingBatch& batch, int limit) {
  const int room = limit - static_cast<int>(batch.size());
  if (!destination().wants_results || room <= 0) return {};
  const auto last = TRY(last_settled_job(store_));
  if (batch.after.results >= last) return {};
  batch.results =
      TRY(jobs_between(store_, batch.after.results, last, std::min(room, kResults_max)));
  return {};
}

Result<OutboxPosition> StoreOutbox::position() {
  auto position = store_.outbox_position(destination().id);
  if (!position) return position;
  const std::int64_t left_out = position->last - position->sent - waiting_max_;
  if (left_out <= 0) return position;
  if (destination().has_identity) {
    TRY(begin_anew(store_, destination().id));
    report_resend("has not taken anything for so long that more waits than is kept for it");
    return position;
  }
  position->sent += left_out;
  TRY(store_.put_outbox_position(destination().id, position->sent));
  report(
      Severity::error, "forward_left_out",
      fmt::format("{} has not taken anything for so long that the oldest {} intervals and months "
                  "are not sent to it any more; they are in the store",
                  words(), left_out));
  return position;
}

/// A new destination receives what happens from now on. @param last  Number of what happened
/// last.
Result<std::int64_t> StoreOutbox::position_of(const std::string& cursor,
                                              const std::function<Result<std::int64_t>()>& last) {
  const auto known = TRY(store_.cursor(cursor));
  if (known) return *known;
  auto position = last();
  if (!position) return position;
  TRY(store_.put_cursor(cursor, *position));
  return position;
}

Result<void> StoreOutbox::move_past(const OutgoingBatch& batch) {
  return store_.as_one([&]() -> Result<void> {
    if (batch.identity != 0 && !batch.is_history && batch.is_first) {
      auto put = put_taken(store_, destination().id, batch.identity);
      if (!put) return put;
    }
    if (!batch.entries.empty()) {
      const std::int64_t number = batch.entries.back().number;
      auto put = batch.is_history ? store_.put_cursor(history_cursor(destination().id), number)
                                  : store_.put_outbox_position(destination().id, number);
      if (!put) return put;
    }
    if (!batch.events.empty()) {
      const std::int64_t number = batch.events.back().number;
      auto put = store_.put_cursor(events_cursor(destination().id), number);
      if (!put) return put;
    }
    if (batch.results.empty()) return {};
    return store_.put_cursor(results_cursor(destination().id), batch.results.back().number);
  });
}

/// What was on its way when a process ended explains one batch. Beyond it are numbers that this
/// store never gave: it is an image of what it was once, or somebody else's.
bool StoreOutbox::is_beyond_us(const OutgoingBatch& batch, const Sent& sent) const {
  if (!sent.until || batch.is_history) return false;
  return sent.until->entries > batch.after.entries + kOutboxBatch;
}

/// What one side has and the other does not know of is not guessed: all is sent again, under
/// another identity.
Result<void> StoreOutbox::resend_all(const OutgoingBatch& batch, const Sent& sent) {
  const bool is_behind = sent.outcome == Sent::Outcome::behind;
  TRY(store_.as_one([&]() -> Result<void> {
    if (auto begun = begin_anew(store_, destination().id); !begun) return begun;
    // Of an outbox that it does not know, it receives what happens from now on.
    if (!is_behind || batch.is_history || *sent.until == record::Progress{}) return {};
    auto put = store_.put_cursor(events_cursor(destination().id),
                                 std::min(batch.after.events, sent.until->events));
    if (!put) return put;
    return store_.put_cursor(results_cursor(destination().id),
                             std::min(batch.after.results, sent.until->results));
  }));
  report_resend(is_behind
                    ? "has less than it had confirmed, as after a backup of it was restored"
                    : "has more than this store has told it, as after an image of this machine "
                      "was restored");
  return {};
}

void StoreOutbox::report_resend(const std::string& why) const {
  report(
      Severity::warning, "forward_anew",
      fmt::format("{} {}; everything that the store has of the present meters is sent to it again",
                  words(), why));
}

Result<bool> StoreOutbox::set_aside(const OutgoingBatch& batch, const std::string& why) {
  TRY(move_past(batch));
  const std::string what =
      batch.size() > 1         ? fmt::format("a part of {} intervals and months", batch.size())
      : !batch.entries.empty() ? fmt::format("a reading of '{}'", batch.entries.front().meter)
      : !batch.events.empty()  ? "an event"
                               : "a result";
  report(Severity::warning, "forward_refused",
         fmt::format("{} refuses {}, which is not sent again: {}", words(), what, why));
  return true;
}

void StoreOutbox::on_failure(const std::string& why, bool is_first) {
  if (!is_first) return;
  report(
      Severity::warning, "forward_failed",
      fmt::format("nothing can be sent to {}: {}; recald keeps it and tries again", words(), why));
}

void StoreOutbox::on_success(const OutgoingBatch& /*batch*/, bool is_first) {
  if (!is_first) return;
  report(Severity::info, "forward_works", fmt::format("{} takes data again", words()));
}

}  // namespace recald::daemon
