#include "daemon/gateway/forward/waiting_messages.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace recald::daemon {

void WaitingMessages::drop(std::list<mqtt::Message>::iterator one) {
  bytes_ -= bytes_of(*one);
  waiting_.erase(one);
  ++dropped_;
}

bool WaitingMessages::add(mqtt::Message message) {
  const std::scoped_lock lock{mutex_};
  const bool was_empty = waiting_.empty();
  const std::size_t bytes = bytes_of(message);
  while (!waiting_.empty() && bytes_ + bytes > bytes_max_) {
    const auto same = std::ranges::find(waiting_, message.topic, &mqtt::Message::topic);
    drop(same == waiting_.end() ? waiting_.begin() : same);
  }
  waiting_.push_back(std::move(message));
  bytes_ += bytes;
  return was_empty;
}

std::vector<mqtt::Message> WaitingMessages::take() {
  const std::scoped_lock lock{mutex_};
  std::vector<mqtt::Message> taken(std::make_move_iterator(waiting_.begin()),
                                   std::make_move_iterator(waiting_.end()));
  waiting_.clear();
  bytes_ = 0;
  return taken;
}

std::int64_t WaitingMessages::dropped() const {
  const std::scoped_lock lock{mutex_};
  return dropped_;
}

}  // namespace recald::daemon
