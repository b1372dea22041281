/// Whether the right thing was said: names, classes, false names, places.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tests/blind/scoring/intervals.hpp"
#include "tests/blind/scoring/scored_case.hpp"

namespace recald::blind {

/// Scores of one block, or of the single effects of like size.
struct GroupScores {
  std::string group;  ///< "single, 3 to 10 %".
  int cases = 0;
  std::optional<Score> right;  ///< Outcome and names exactly the true ones.
  std::optional<Score> top1;
  std::optional<Score> top3;
  std::optional<Score> class_right;  ///< Where the catalogue has the hidden effect.
  std::optional<Score> wrong_name;   ///< An effect was added that is not there.
  std::optional<Score> said_unknown;
  std::optional<Score> said_confusable;
  std::optional<Score> said_none;
};

/// The group of all single effects, whatever their size.
inline constexpr const char* kAllSingles = "single, all";

/// The group of those that move a meter by so much.
[[nodiscard]] std::string single_group(double share);

struct PairScores {
  std::optional<Score> both;  ///< Both added, whatever else was.
  std::optional<Score> only_one;
  std::optional<Score> neither;
  std::optional<Score> both_large;  ///< Both added, of those that are large.
};

/// Where the residual pointed, for cases with an effect whose result gives `located`.
struct PlaceScores {
  std::optional<Score> first_meter_right;  ///< The meter located first is the most affected one.
  std::optional<Score> found_among_all;    ///< The most affected meter is among those located.
};

struct DecoyScores {
  int cases = 0;  ///< With a decoy on offer, of any block.
  std::optional<Score> right;
  std::optional<Score> wrong_name;
};

/// A share of right answers among cases that have something in common.
struct Breakdown {
  std::string what;  ///< "climate cold", "gaps".
  std::optional<Score> right;
};

struct NamingScores {
  std::optional<Score> right;         ///< Over all cases.
  std::vector<GroupScores> groups;    ///< Those with cases only.
  std::optional<Score> false_names;   ///< No effect hidden, yet one added.
  std::optional<Score> false_alarms;  ///< No effect hidden, and anything but "none" said.
  std::optional<Score> wrong_names;   ///< An effect hidden, and one added that is not there.
  std::optional<Score> out_of_catalogue_wrong_name;
  std::optional<Score> out_of_catalogue_unknown;  ///< Cases with an effect; decoys alone are none.
  std::optional<Score> confusable_has_truth;      ///< Of the confusable sets at a hidden effect.
  PairScores pairs;
  DecoyScores decoys;
  PlaceScores places;
  std::vector<Breakdown> breakdowns;
  /// Truth -> said -> cases.
  std::map<std::string, std::map<std::string, int>> confusion;
};

[[nodiscard]] NamingScores naming_scores(const ScoredCases& cases);

/// Of the cases that pass `counts`, the share that pass `hits`.
template <class Counts, class Hits>
[[nodiscard]] std::optional<Score> share_of(const ScoredCases& cases, Counts counts, Hits hits) {
  int all = 0;
  int hit = 0;
  for (const ScoredCase& scored : cases) {
    if (!counts(scored)) continue;
    ++all;
    if (hits(scored)) ++hit;
  }
  return share_score(hit, all);
}

}  // namespace recald::blind
