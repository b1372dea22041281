#include "daemon/commands/model/engine_runs.hpp"

#include <fmt/format.h>

#include <chrono>
#include <thread>

#include "adapters/system/parallel_for.hpp"
#include "daemon/commands/interrupt.hpp"

namespace recald::daemon {
namespace {

/// Says once how long all of it will take; on a terminal the progress line does.
class RunsEstimate {
 public:
  /// @param threads  Runs at a time: the first of them end together.
  RunsEstimate(unsigned threads, const Console& console)
      : console_{console},
        at_a_time_{static_cast<int>(threads > 0 ? threads : std::thread::hardware_concurrency())} {}

  /// Calls are not concurrent.
  void show(int done, int total) {
    if (total == 0) return;
    if (begun_with_ < 0) {
      begun_with_ = done;
      begin_ = std::chrono::steady_clock::now();
    }
    const int made = done - begun_with_;
    if (is_said_ || made < at_a_time_ || console_.is_terminal) return;
    is_said_ = true;
    const double took_s =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
    const std::string left =
        time_left_text(took_s, made / static_cast<double>(total - begun_with_));
    if (left.empty()) return;
    console_.err << fmt::format("{} runs to make; that takes about {}.\n", total - begun_with_,
                                left);
  }

 private:
  const Console& console_;
  int at_a_time_;
  std::chrono::steady_clock::time_point begin_;
  int begun_with_ = -1;
  bool is_said_ = false;
};

}  // namespace

tl::expected<MadeRuns, int> make_runs_aloud(const MakeRuns& make, unsigned threads,
                                            const Console& console) {
  const InterruptGuard guard;
  auto made = [&] {
    ProgressLine line{console};
    RunsEstimate estimate{threads, console};
    return make(system::parallel_for(threads), [&](int done, int total) {
      estimate.show(done, total);
      if (total > 0) line.show({calibration::Progress::Stage::design, 0, done, total});
      return !guard.interrupted();
    });
  }();
  if (!made) return tl::unexpected(console.fail(made.error()));
  return std::move(*made);
}

tl::expected<MadeRuns, int> make_runs_aloud(const ModelledSite& modelled,
                                            const RunsOptions& options, unsigned threads,
                                            const Console& console) {
  return make_runs_aloud(
      [&](const ForEachIndex& executor, const Engine::Observer& observer) {
        return make_runs(modelled, options, executor, observer);
      },
      threads, console);
}

tl::expected<ModelledSite, int> with_runs(
    const std::function<tl::expected<ModelledSite, int>(const Console&)>& open, std::uint64_t seed,
    unsigned threads, const Console& console) {
  auto modelled = open(console);
  if (!modelled) return modelled;
  const SiteConfig& site = modelled->site.config;
  if (!site.model || !site.model->energyplus || has_all_runs(site)) return modelled;
  TRY(make_runs_aloud(*modelled, {.seed = seed}, threads, console));
  // What the data show was printed when the site was first opened.
  return open({console.out, console.err, console.is_terminal, Console::Detail::little});
}

}  // namespace recald::daemon
