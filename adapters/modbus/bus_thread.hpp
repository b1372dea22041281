/// The owner thread of one Modbus endpoint. libmodbus blocks, so it never runs on the loop.
#pragma once

#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>

#include "adapters/modbus/connection.hpp"
#include "adapters/ports/bus.hpp"
#include "adapters/ports/loop.hpp"

namespace recald::modbus {

class BusThread final : public Bus {
 public:
  /// @param loop  Outlives this.
  BusThread(Endpoint endpoint, Loop& loop);
  /// Waits for the read in progress, at most its time-out; its outcome is not reported.
  ~BusThread() override;

  void read(const ReadRequest& request, milliseconds timeout, Done done) override;

 private:
  struct Job {
    ReadRequest request;
    milliseconds timeout;
    Done done;
  };

  void run(const std::stop_token& stopping);

  Connection connection_;
  Loop& loop_;
  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::optional<Job> job_;
  std::jthread thread_;  ///< Last: it uses all of the above.
};

}  // namespace recald::modbus
