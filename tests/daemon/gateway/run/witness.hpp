/// What a killed process leaves behind besides its files: what it had promised, and its clock.
#pragma once

#include <sys/mman.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>

#include "tests/daemon/gateway/run/surviving_store.hpp"

namespace recald::daemon::testing {

struct Witness {
  static constexpr std::size_t kPromisesMax = 200'000;
  std::chrono::sys_time<std::chrono::milliseconds> now;
  std::int64_t last_job;  ///< Of those that were taken; 0: none.
  std::size_t count;
  Promise promises[kPromisesMax];

  void add(const StoreBatch& batch) {
    for (const StoreBatch::Interval& interval : batch.intervals) {
      if (count == kPromisesMax) throw std::runtime_error("too many promises");
      const metering::Reading& reading = interval.reading;
      promises[count] = {reading.meter, reading.start, reading.mean_kW};
      ++count;
    }
  }
  [[nodiscard]] std::span<const Promise> all() const { return {promises, count}; }
};

/// Seen by a process and its children.
class SharedWitness {
 public:
  explicit SharedWitness(std::chrono::sys_time<std::chrono::milliseconds> now)
      : memory_(static_cast<Witness*>(::mmap(nullptr, sizeof(Witness), PROT_READ | PROT_WRITE,
                                             MAP_SHARED | MAP_ANONYMOUS, -1, 0))) {
    if (memory_ == MAP_FAILED) throw std::runtime_error("no shared memory");
    memory_->now = now;
  }
  ~SharedWitness() { ::munmap(memory_, sizeof(Witness)); }
  SharedWitness(const SharedWitness&) = delete;
  SharedWitness& operator=(const SharedWitness&) = delete;
  Witness* operator->() const { return memory_; }

 private:
  Witness* memory_;
};

}  // namespace recald::daemon::testing
