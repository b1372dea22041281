#include "daemon/gateway/run/load_watch.hpp"

#include <malloc.h>
#include <spdlog/spdlog.h>

#include <optional>
#include <utility>

#include "daemon/site/model/load_expectation.hpp"

namespace recald::daemon {
namespace {

constexpr std::chrono::hours kAskEvery{1};
constexpr std::chrono::minutes kAskAgain{1};  // while something else goes on
constexpr std::chrono::days kShownFor{8};
constexpr std::chrono::hours kLearnEvery{24};

/// An exception is the reason why nothing is expected.
Result<std::vector<ExpectedMeter>> expect_safely(const ExpectLoads& expect,
                                                 const metering::TimeSpan& span) {
  try {
    auto expected = expect(span);
    ::malloc_trim(0);  // as after a job
    return expected;
  } catch (const std::exception& thrown) {
    return failure(ErrorCode::unsupported, thrown.what());
  }
}

}  // namespace

LoadWatch::LoadWatch(Loop& loop, Worker& worker, ExpectLoads expect, std::function<bool()> is_busy)
    : loop_(loop),
      worker_(worker),
      expect_(std::move(expect)),
      is_busy_(std::move(is_busy)),
      wakeup_(loop, [this] { ask(); }) {}

void LoadWatch::start() { wakeup_.after(std::chrono::milliseconds{0}); }

void LoadWatch::set_expect(ExpectLoads expect) {
  expect_ = std::move(expect);
  latest_.clear();
  ++site_files_;
  wakeup_.after(std::chrono::milliseconds{0});
}

void LoadWatch::ask() {
  if (is_asking_ || is_busy_()) return wakeup_.after(kAskAgain);
  wakeup_.after(kAskEvery);
  is_asking_ = true;
  const metering::Instant now = loop_.now().instant();
  const metering::TimeSpan span{std::chrono::floor<std::chrono::hours>(now - kShownFor), now};
  // The work may outlive this object, so it has copies of everything it uses.
  const auto found = std::make_shared<Result<std::vector<ExpectedMeter>>>();
  worker_.run([expect = expect_, span, found] { *found = expect_safely(expect, span); },
              alive_.guard([this, found, asked_for = site_files_] {
                is_asking_ = false;
                if (site_files_ == asked_for) take(std::move(*found));
              }));
}

void LoadWatch::take(Result<std::vector<ExpectedMeter>> expected) {
  latest_ = expected ? std::move(*expected) : std::vector<ExpectedMeter>{};
  const std::string failure = expected ? "" : expected.error().message;
  if (!failure.empty() && failure != failure_) {
    spdlog::info("event=no_expected_loads why=\"{}\"", failure);
  }
  failure_ = failure;
}

ExpectLoads make_load_expectation(SharedSite site) {
  struct Learned {
    std::optional<LoadExpectation> expectation;
    metering::Instant at{};
  };
  return [site = std::move(site), learned = std::make_shared<Learned>()](
             const metering::TimeSpan& span) -> Result<std::vector<ExpectedMeter>> {
    if (!site->config.model || !site->config.building) return std::vector<ExpectedMeter>{};
    if (!learned->expectation || span.end - learned->at >= kLearnEvery) {
      learned->expectation = TRY(LoadExpectation::learn(*site, span.end));
      learned->at = span.end;
    }
    return learned->expectation->expect(span);
  };
}

}  // namespace recald::daemon
