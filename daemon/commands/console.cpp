#include "daemon/commands/console.hpp"

#include <fmt/format.h>

#include <numeric>

namespace recald::daemon {

int Console::fail(const std::string& sentence) const {
  err << "recald: " << sentence << "\n";
  return kFailure;
}

int Console::fail(const std::vector<std::string>& sentences) const {
  for (const std::string& sentence : sentences) err << "recald: " << sentence << "\n";
  return kFailure;
}

int Console::misused(const std::string& sentence) const {
  fail(sentence);
  return kUsage;
}

ProgressLine::~ProgressLine() {
  if (shown_percent_ >= 0) console_.err << "\r\033[K" << std::flush;
}

void ProgressLine::show(const calibration::Progress& progress) {
  if (!console_.is_terminal) return;
  const std::scoped_lock lock{mutex_};
  const bool sampling = progress.stage == calibration::Progress::Stage::sampling;
  const auto chain = static_cast<std::size_t>(progress.chain);
  if (done_.size() <= chain) done_.resize(chain + 1, 0);
  done_[chain] = progress.done;
  // Chains run side by side; until all have reported, the line speaks of those that have.
  const long long done = std::accumulate(done_.begin(), done_.end(), 0LL);
  const int percent = static_cast<int>(
      100 * done / (static_cast<long long>(progress.total) * static_cast<long long>(done_.size())));
  if (percent == shown_percent_) return;
  shown_percent_ = percent;
  console_.err << fmt::format("\r\033[K{} {:3d} %", sampling ? "sampling" : "design", percent)
               << std::flush;
}

}  // namespace recald::daemon
