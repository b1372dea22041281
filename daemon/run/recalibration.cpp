#include "daemon/run/recalibration.hpp"

#include <algorithm>
#include <utility>

namespace recald::daemon {
namespace {

/// Waiting goes by the monotonic clock and schedules by the wall clock, which may be set meanwhile.
constexpr std::chrono::milliseconds kLookAgain{60'000};

}  // namespace

Recalibration::Recalibration(Loop& loop, const SiteConfig& site, metering::LocalCalendar calendar,
                             std::function<void(const std::string&)> ask)
    : loop_(loop),
      schedule_(site.model ? site.recalibration.schedule : Schedule{}),
      modelled_meters_(site.model ? site.model->outputs : std::vector<std::string>{}),
      calendar_(std::move(calendar)),
      ask_(std::move(ask)),
      self_(std::make_shared<Recalibration*>(this)) {}

void Recalibration::start() {
  if (!schedule_.times) return;
  if (const auto next = schedule_.times->next(loop_.now().instant(), calendar_)) wait_for(*next);
}

void Recalibration::wait_for(metering::Instant next) {
  const auto left = next - loop_.now().wall;
  if (left.count() <= 0) {
    ask_("schedule");
    return start();
  }
  loop_.after(std::min(std::chrono::ceil<std::chrono::milliseconds>(left), kLookAgain),
              [weak = std::weak_ptr{self_}, next] {
                if (const auto self = weak.lock()) (*self)->wait_for(next);
              });
}

void Recalibration::month_closed(const std::string& meter) {
  if (!schedule_.when_a_month_closes || is_asking_) return;
  if (std::ranges::find(modelled_meters_, meter) == modelled_meters_.end()) return;
  is_asking_ = true;
  loop_.post([weak = std::weak_ptr{self_}] {
    const auto self = weak.lock();
    if (!self) return;
    (*self)->is_asking_ = false;
    (*self)->ask_("month");
  });
}

}  // namespace recald::daemon
