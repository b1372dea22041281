/// Keeps what the model expects of the last days up to date.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "adapters/ports/alive.hpp"
#include "adapters/ports/loop.hpp"
#include "adapters/ports/wakeup.hpp"
#include "adapters/ports/worker.hpp"
#include "core/result.hpp"
#include "daemon/site/model/expected_load.hpp"
#include "daemon/site/model/modelled_site.hpp"

namespace recald::daemon {

/// What the model expects of the span. Called on the worker; may be slow.
using ExpectLoads = std::function<Result<std::vector<ExpectedMeter>>(const metering::TimeSpan&)>;

/// Asks once an hour for the last eight days.
class LoadWatch {
 public:
  /// @param is_busy  While it is true, nothing is asked: a job needs the memory.
  LoadWatch(Loop& loop, Worker& worker, ExpectLoads expect, std::function<bool()> is_busy);
  ~LoadWatch() = default;
  LoadWatch(const LoadWatch&) = delete;
  LoadWatch& operator=(const LoadWatch&) = delete;

  void start();
  /// Replaces the model, for another site file.
  void set_expect(ExpectLoads expect);

  /// Empty until the first answer, and where the site has no hourly model.
  [[nodiscard]] const std::vector<ExpectedMeter>& latest() const { return latest_; }

 private:
  void ask();
  void take(Result<std::vector<ExpectedMeter>> expected);

  Loop& loop_;
  Worker& worker_;
  ExpectLoads expect_;
  std::function<bool()> is_busy_;
  std::vector<ExpectedMeter> latest_;
  std::string failure_;  ///< The last one logged.
  bool is_asking_ = false;
  int site_files_ = 0;  ///< So far: an answer for an earlier one is dropped.
  Wakeup wakeup_;
  Alive alive_;
};

/// Learns from the site's closed months at the first call, and again every day.
[[nodiscard]] ExpectLoads make_load_expectation(SharedSite site);

}  // namespace recald::daemon
