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

std::string time_left_text(double elapsed_s, double share) {
  // The first per cents and the first second tell little of the rest.
  if (!(share >= 0.03) || elapsed_s < 1.0) return {};
  const double left_s = elapsed_s * (1.0 - share) / share;
  if (left_s < 90.0) return fmt::format("{:.0f} s", left_s);
  if (left_s < 5400.0) return fmt::format("{:.0f} min", left_s / 60.0);
  return fmt::format("{:.1f} h", left_s / 3600.0);
}

ProgressLine::~ProgressLine() {
  if (shown_percent_ >= 0) console_.err << kLineOver << std::flush;
}

void ProgressLine::show(const calibration::Progress& progress) {
  if (!console_.is_terminal) return;
  const std::scoped_lock lock{mutex_};
  using enum calibration::Progress::Stage;
  const auto chain = static_cast<std::size_t>(progress.chain);
  if (done_.size() <= chain) done_.resize(chain + 1, 0);
  done_[chain] = progress.done;
  // Chains run side by side; until all have reported, the line speaks of those that have.
  const double done = std::accumulate(done_.begin(), done_.end(), 0.0);
  draw(progress.stage == sampling     ? "Sampling"
       : progress.stage == predicting ? "Predicting"
                                      : "Running the model",
       done / (static_cast<double>(progress.total) * static_cast<double>(done_.size())));
}

void ProgressLine::show(std::string_view what, double share) {
  if (!console_.is_terminal) return;
  const std::scoped_lock lock{mutex_};
  draw(what, share);
}

void ProgressLine::draw(std::string_view what, double share) {
  const auto now = std::chrono::steady_clock::now();
  if (what != what_) {
    what_ = what;
    begin_ = now;
    shown_percent_ = -1;
  }
  const int percent = static_cast<int>(100.0 * share);
  if (percent == shown_percent_) return;
  shown_percent_ = percent;
  const std::string left =
      time_left_text(std::chrono::duration<double>(now - begin_).count(), share);
  console_.err << fmt::format("\r\033[K{} {:3d} %{}", what, percent,
                              left.empty() ? "" : ", " + left + " left")
               << std::flush;
}

}  // namespace recald::daemon
