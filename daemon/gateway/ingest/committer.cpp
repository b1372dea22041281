#include "daemon/gateway/ingest/committer.hpp"

#include <algorithm>
#include <utility>

namespace recald::daemon {
namespace {

using std::chrono::milliseconds;

template <class T>
void append(std::vector<T>& to, std::vector<T>&& from) {
  to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
}

/// Drops the oldest entries beyond `max`. @return how many.
template <class T>
std::size_t keep_newest(std::vector<T>& values, std::size_t max) {
  if (values.size() <= max) return 0;
  const std::size_t excess = values.size() - max;
  values.erase(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(excess));
  return excess;
}

}  // namespace

Committer::Committer(Loop& loop, IntervalStore& store, const CommitRules& rules,
                     OnCommitted on_committed, OnRefusal on_refusal)
    : loop_(loop),
      store_(store),
      rules_(rules),
      on_committed_(std::move(on_committed)),
      on_refusal_(std::move(on_refusal)),
      wakeup_(loop, [this] { (void)flush(); }) {}

/// The newest state of a register explains all intervals before it.
void Committer::put_state(const StoreBatch::Register& entry) {
  const auto same = [&](const StoreBatch::Register& other) {
    return other.meter == entry.meter && other.state.field == entry.state.field;
  };
  const auto known = std::ranges::find_if(waiting_.registers, same);
  if (known == waiting_.registers.end()) {
    waiting_.registers.push_back(entry);
  } else {
    *known = entry;
  }
}

void Committer::add(StoreBatch batch) {
  if (batch.empty()) return;
  const bool is_urgent = !batch.intervals.empty();
  append(waiting_.intervals, std::move(batch.intervals));
  append(waiting_.samples, std::move(batch.samples));
  append(waiting_.events, std::move(batch.events));
  append(waiting_.reopened, std::move(batch.reopened));
  for (const StoreBatch::Register& entry : batch.registers) put_state(entry);
  if (has_too_much() && !health_.is_degraded) (void)flush();
  give_up_what_is_too_much();
  if (waiting_.empty()) return;
  if (health_.is_degraded) return;  // the retry is scheduled
  wakeup_.after(is_urgent ? milliseconds{0} : rules_.gather);
}

bool Committer::has_too_much() const {
  return waiting_.intervals.size() > rules_.intervals_max ||
         waiting_.samples.size() > rules_.samples_max ||
         waiting_.events.size() > rules_.intervals_max;
}

void Committer::give_up_what_is_too_much() {
  health_.lost_intervals += keep_newest(waiting_.intervals, rules_.intervals_max);
  (void)keep_newest(waiting_.samples, rules_.samples_max);
  (void)keep_newest(waiting_.events, rules_.intervals_max);
}

Result<void> Committer::flush() {
  wakeup_.cancel();
  if (waiting_.empty()) return {};
  const milliseconds begin = loop_.now().monotonic;
  const auto counts = store_.commit(waiting_);
  health_.last_duration = loop_.now().monotonic - begin;
  health_.durations.observe(health_.last_duration);
  if (!counts) {
    ++health_.failures;
    health_.why = counts.error().message;
    wakeup_.after(rules_.retry);
    if (!std::exchange(health_.is_degraded, true) && on_refusal_) on_refusal_(health_.why);
    return tl::unexpected(counts.error());
  }
  ++health_.commits;
  health_.conflicts += counts->conflicts.size();
  health_.why.clear();
  const StoreBatch committed = std::exchange(waiting_, {});
  if (on_committed_) on_committed_(committed, *counts);
  if (std::exchange(health_.is_degraded, false) && on_refusal_) on_refusal_("");
  return {};
}

}  // namespace recald::daemon
