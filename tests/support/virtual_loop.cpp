#include "tests/support/virtual_loop.hpp"

#include <algorithm>
#include <utility>

namespace recald::testing {

void VirtualLoop::after(std::chrono::milliseconds wait, Call call) {
  calls_.emplace(now_.monotonic + std::max(wait, std::chrono::milliseconds{0}), std::move(call));
}

void VirtualLoop::post(Call call) { after(std::chrono::milliseconds{0}, std::move(call)); }

bool VirtualLoop::run_for(std::chrono::milliseconds length) {
  const auto end = now_.monotonic + length;
  is_stopped_ = false;
  while (!calls_.empty() && calls_.begin()->first <= end) {
    auto next = calls_.extract(calls_.begin());
    pass(next.key() - now_.monotonic);
    next.mapped()();
    if (is_stopped_) return false;
  }
  pass(end - now_.monotonic);
  return true;
}

void VirtualLoop::pass(std::chrono::milliseconds length) {
  now_.wall += length;
  now_.monotonic += length;
}

}  // namespace recald::testing
