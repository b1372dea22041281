/// What a broker has sent and the loop has not read yet.
#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <mutex>
#include <vector>

#include "adapters/mqtt/message.hpp"

namespace recald::daemon {

/// A queue between two threads with a limit in bytes. Nobody can make a broker wait, so where
/// messages come faster than they are read, the older ones of the same topic go: of a counter the
/// newest value has all the energy. Safe from any thread.
class WaitingMessages {
 public:
  explicit WaitingMessages(std::size_t bytes_max = 4'000'000) : bytes_max_(bytes_max) {}

  /// @return whether nothing waited before, so that somebody is to be told.
  [[nodiscard]] bool add(mqtt::Message message);

  /// All that wait, in the order in which they came.
  [[nodiscard]] std::vector<mqtt::Message> take();

  /// How many went unread so far.
  [[nodiscard]] std::int64_t dropped() const;

 private:
  void drop(std::list<mqtt::Message>::iterator one);

  mutable std::mutex mutex_;
  std::list<mqtt::Message> waiting_;
  std::size_t bytes_ = 0;
  const std::size_t bytes_max_;
  std::int64_t dropped_ = 0;
};

}  // namespace recald::daemon
