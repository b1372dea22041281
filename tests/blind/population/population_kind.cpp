#include "tests/blind/population/population_kind.hpp"

#include <fmt/format.h>

#include <array>

namespace recald::blind {
namespace {

using simulators::Use;

constexpr std::array kLearningUses{Use::laboratory, Use::office, Use::school, Use::hotel,
                                   Use::warehouse};
constexpr std::array kJudgingUses{Use::shop, Use::clinic, Use::restaurant, Use::gym};

}  // namespace

std::string_view to_string(Family family) {
  return family == Family::learning ? "learning" : "judging";
}

std::span<const Use> uses_of(Family family) {
  if (family == Family::learning) return kLearningUses;
  return kJudgingUses;
}

Result<PopulationKind> population_kind(std::string_view world, std::string_view name) {
  const bool is_own = world == "own";
  const auto kind = [&](Family family, int none, std::array<int, 3> singles, int outside, int pairs,
                        int years) {
    return PopulationKind{std::string(name),
                          family,
                          none,
                          {{kBelow3, singles[0]}, {kFrom3To10, singles[1]}, {kAbove10, singles[2]}},
                          outside,
                          pairs,
                          years};
  };
  if (name == "smoke") {
    return is_own ? kind(Family::learning, 3, {0, 3, 2}, 2, 2, 1)
                  : kind(Family::learning, 1, {0, 1, 1}, 0, 0, 1);
  }
  if (name == "development") {
    return is_own ? kind(Family::learning, 60, {40, 60, 60}, 20, 20, 3)
                  : kind(Family::learning, 30, {20, 35, 35}, 10, 0, 2);
  }
  if (name == "learning") {
    return is_own ? kind(Family::learning, 400, {300, 400, 350}, 50, 0, 3)
                  : kind(Family::learning, 70, {50, 80, 80}, 20, 0, 2);
  }
  if (name == "sealed") {
    return is_own ? kind(Family::judging, 100, {40, 60, 60}, 20, 20, 3)
                  : kind(Family::judging, 100, {40, 60, 60}, 20, 0, 2);
  }
  return failure(ErrorCode::not_found,
                 fmt::format("unknown population {}; there are smoke, development, learning, "
                             "sealed and, of our own world, plain",
                             name));
}

std::uint64_t own_seed(std::string_view population, std::uint64_t seed) {
  std::uint64_t hash = 14695981039346656037ULL ^ seed;
  for (const char c : population) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  return hash;
}

}  // namespace recald::blind
