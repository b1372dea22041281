/// Keeps what the model expects of the last days up to date.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "adapters/ports/loop.hpp"
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
  LoadWatch(Loop& loop, Worker& worker, ExpectLoads expect);
  ~LoadWatch() = default;
  LoadWatch(const LoadWatch&) = delete;
  LoadWatch& operator=(const LoadWatch&) = delete;

  void start();
  /// Replaces the model, for another site file.
  void set_expect(ExpectLoads expect) { expect_ = std::move(expect); }

  /// Empty until the first answer, and where the site has no hourly model.
  [[nodiscard]] const std::vector<ExpectedMeter>& latest() const { return latest_; }

 private:
  void ask_every_hour();
  void take(Result<std::vector<ExpectedMeter>> expected);

  Loop& loop_;
  Worker& worker_;
  ExpectLoads expect_;
  std::vector<ExpectedMeter> latest_;
  std::string failure_;  ///< The last one logged.
  bool is_asking_ = false;
  std::shared_ptr<LoadWatch*> self_;
};

/// Learns from the site's closed months at the first call, and again every day.
[[nodiscard]] ExpectLoads make_load_expectation(OpenSite site);

}  // namespace recald::daemon
