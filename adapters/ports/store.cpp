#include "adapters/ports/store.hpp"

#include <array>

namespace recald {

std::string_view name_of(JobKind kind) {
  constexpr std::array<std::string_view, 2> kNames{"calibration", "diagnosis"};
  return kNames.at(static_cast<std::size_t>(kind));
}

std::string_view name_of(JobState state) {
  constexpr std::array<std::string_view, 5> kNames{"waiting", "running", "done", "failed",
                                                   "cancelled"};
  return kNames.at(static_cast<std::size_t>(state));
}

}  // namespace recald
