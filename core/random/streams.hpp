/// Every stream of a run's seed, and who draws from it: no two that one run uses meet. A
/// calibration, a diagnosis and the following of a site are runs of their own, each with its list
/// below.
#pragma once

#include <array>
#include <cassert>
#include <cstdint>

namespace recald::streams {

/// Consecutive streams for one purpose.
struct Block {
  std::uint64_t first;
  std::uint64_t size;

  /// @pre k < size
  [[nodiscard]] constexpr std::uint64_t operator[](std::uint64_t k) const {
    assert(k < size);
    return first + k;
  }
};

inline constexpr std::uint64_t kChainsMax = 1'000'000;
inline constexpr std::uint64_t kPopulationRoundsMax = 10'000;
inline constexpr std::uint64_t kMonthsMax = 100'000;
inline constexpr std::uint64_t kPassesMax = 1'000;

inline constexpr Block kChains{0, kChainsMax};
inline constexpr Block kFolds{2'000'000, 1};  ///< Of a design's runs, for cross-validation.
inline constexpr Block kScreening{3'000'000, 1};
inline constexpr Block kDesign{1ULL << 32, 1};           ///< Of a calibration.
inline constexpr Block kPilots{1ULL << 33, kChainsMax};  ///< One a chain.
/// New ones after each doubling.
inline constexpr Block kPopulations{1ULL << 34, kPopulationRoundsMax* kChainsMax};
inline constexpr Block kBridge{1ULL << 35, 1};
inline constexpr Block kCut{1ULL << 36, kChainsMax};  ///< Chains given draws of an effect.
inline constexpr Block kHypercube{1ULL << 37, 2};  ///< Of `recald doe`: a design, runs to check it.
inline constexpr Block kPredictions{1ULL << 38, kChainsMax};  ///< Of measured points, one a chain.
inline constexpr Block kSavings{1ULL << 39, 3};  ///< Of measures, at a calibration's draws.
inline constexpr Block kCauses{1ULL << 40, 1};   ///< Of an alarm.
inline constexpr Block kVote{1ULL << 41, 1};     ///< Resampled months of a monthly model.
/// Of a followed site, two a month. All windows share them and differ only in what they believe.
inline constexpr Block kMonths{0, 2 * kMonthsMax};
inline constexpr Block kPasses{0, kPassesMax};  ///< Of a diagnosis.

inline constexpr std::array kOfCalibration{kChains,    kFolds,       kScreening, kDesign,
                                           kPilots,    kPopulations, kBridge,    kCut,
                                           kHypercube, kPredictions, kSavings};
inline constexpr std::array kOfDiagnosis{kPasses, kVote};
inline constexpr std::array kOfFollowing{kMonths, kDesign, kCauses};

/// The populations that are run side by side after so many doublings.
[[nodiscard]] constexpr Block populations_of(int doublings) {
  assert(doublings >= 0);
  const auto round = static_cast<std::uint64_t>(doublings);
  return {kPopulations[round * kChainsMax], kChainsMax};
}

}  // namespace recald::streams
