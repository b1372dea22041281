#include "adapters/system/clock_setting.hpp"

#include <sys/timex.h>

#include <chrono>
#include <ctime>

namespace recald::system {
namespace {

constexpr std::chrono::minutes kAfterBoot{10};

}  // namespace

bool is_clock_settling() {
  timespec up{};
  if (clock_gettime(CLOCK_BOOTTIME, &up) != 0) return false;
  if (std::chrono::seconds{up.tv_sec} > kAfterBoot) return false;
  timex asked{};  // modes 0: only asks
  return adjtimex(&asked) == TIME_ERROR;
}

bool is_clock_synchronised() {
  timex asked{};
  return adjtimex(&asked) != TIME_ERROR && (asked.status & STA_UNSYNC) == 0;
}

}  // namespace recald::system
