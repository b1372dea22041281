#include "tests/blind/scoring/naming_scores.hpp"

#include <algorithm>
#include <array>
#include <functional>

namespace recald::blind {
namespace {

using Predicate = std::function<bool(const ScoredCase&)>;

Predicate in_block(Block block) {
  return [block](const ScoredCase& scored) { return scored.answer->block == block; };
}

Predicate said(Outcome outcome) {
  return [outcome](const ScoredCase& scored) { return scored.result->outcome == outcome; };
}

bool is_right(const ScoredCase& scored) { return scored.judgement.right; }
bool has_wrong_name(const ScoredCase& scored) { return scored.judgement.wrong_name; }
bool has_effect(const ScoredCase& scored) { return !scored.answer->effects.empty(); }
bool is_named(const ScoredCase& scored) { return scored.result->outcome == Outcome::named; }

struct ShareBin {
  double from;
  const char* group;
};
constexpr std::array kShareBins{
    ShareBin{0.1, "single, above 10 %"}, ShareBin{0.03, "single, 3 to 10 %"},
    ShareBin{0.01, "single, 1 to 3 %"}, ShareBin{0.0, "single, below 1 %"}};

const ShareBin& bin_of(double share) {
  return *std::ranges::find_if(kShareBins, [&](const ShareBin& bin) { return share >= bin.from; });
}

GroupScores group_scores(const ScoredCases& cases, std::string group, const Predicate& member) {
  const Predicate catalogued = [&](const ScoredCase& scored) {
    return member(scored) &&
           (scored.answer->block == Block::single || scored.answer->block == Block::pair);
  };
  const auto count = std::ranges::count_if(cases, member);
  return {.group = std::move(group),
          .cases = static_cast<int>(count),
          .right = share_of(cases, member, is_right),
          .top1 = share_of(cases, member, [](const auto& c) { return c.judgement.top1; }),
          .top3 = share_of(cases, member, [](const auto& c) { return c.judgement.top3; }),
          .class_right =
              share_of(cases, catalogued, [](const auto& c) { return c.judgement.class_right; }),
          .wrong_name = share_of(cases, member, has_wrong_name),
          .said_unknown = share_of(cases, member, said(Outcome::unknown)),
          .said_confusable = share_of(cases, member, said(Outcome::confusable)),
          .said_none = share_of(cases, member, said(Outcome::none))};
}

/// The blocks, and below "single" each size that occurs, the largest first.
std::vector<GroupScores> all_groups(const ScoredCases& cases) {
  std::vector<GroupScores> groups;
  const auto add = [&](std::string group, const Predicate& member) {
    if (std::ranges::any_of(cases, member)) {
      groups.push_back(group_scores(cases, std::move(group), member));
    }
  };
  add("no effect", in_block(Block::no_effect));
  add(kAllSingles, in_block(Block::single));
  for (const ShareBin& bin : kShareBins) {
    add(bin.group, [&bin](const ScoredCase& scored) {
      return scored.answer->block == Block::single &&
             &bin_of(largest_share(*scored.answer)) == &bin;
    });
  }
  add("pair", in_block(Block::pair));
  add("out of catalogue", in_block(Block::out_of_catalogue));
  return groups;
}

PairScores pair_scores(const ScoredCases& cases) {
  const auto naming = [&](int count) {
    return share_of(cases, in_block(Block::pair), [count](const ScoredCase& scored) {
      return scored.judgement.hidden_named == count;
    });
  };
  const auto both = [](const ScoredCase& scored) { return scored.judgement.hidden_named == 2; };
  const auto large = [](const ScoredCase& scored) {
    return scored.answer->block == Block::pair && is_large(*scored.answer);
  };
  return {.both = naming(2),
          .only_one = naming(1),
          .neither = naming(0),
          .both_large = share_of(cases, large, both)};
}

PlaceScores place_scores(const ScoredCases& cases) {
  const Predicate counts = [](const ScoredCase& scored) {
    return scored.result->located && !most_affected_meter(*scored.answer).empty();
  };
  const auto first_is_right = [](const ScoredCase& scored) {
    const std::vector<std::string>& located = *scored.result->located;
    return !located.empty() && located.front() == most_affected_meter(*scored.answer);
  };
  const auto found = [](const ScoredCase& scored) {
    const std::vector<std::string>& located = *scored.result->located;
    return std::ranges::find(located, most_affected_meter(*scored.answer)) != located.end();
  };
  return {.first_meter_right = share_of(cases, counts, first_is_right),
          .found_among_all = share_of(cases, counts, found)};
}

DecoyScores decoy_scores(const ScoredCases& cases) {
  const Predicate has_decoy = [](const ScoredCase& scored) {
    return !scored.answer->decoys.empty();
  };
  return {.cases = static_cast<int>(std::ranges::count_if(cases, has_decoy)),
          .right = share_of(cases, has_decoy, is_right),
          .wrong_name = share_of(cases, has_decoy, has_wrong_name)};
}

std::vector<Breakdown> breakdowns(const ScoredCases& cases) {
  std::map<std::string, std::pair<int, int>> right_and_all;
  for (const ScoredCase& scored : cases) {
    const Answer& answer = *scored.answer;
    for (const std::string& what : {"climate " + answer.climate, "use " + answer.use,
                                    std::string(answer.gaps ? "with gaps" : "without gaps")}) {
      auto& [right, all] = right_and_all[what];
      ++all;
      if (scored.judgement.right) ++right;
    }
  }
  std::vector<Breakdown> rows;
  rows.reserve(right_and_all.size());
  for (const auto& [what, counts] : right_and_all) {
    rows.push_back({what, share_score(counts.first, counts.second)});
  }
  return rows;
}

}  // namespace

std::string single_group(double share) { return bin_of(share).group; }

NamingScores naming_scores(const ScoredCases& cases) {
  const Predicate no_effect = in_block(Block::no_effect);
  const Predicate outside = in_block(Block::out_of_catalogue);
  NamingScores scores;
  scores.right = share_of(
      cases, [](const ScoredCase&) { return true; }, is_right);
  scores.groups = all_groups(cases);
  scores.false_names = share_of(cases, no_effect, is_named);
  scores.false_alarms = share_of(cases, no_effect, [](const ScoredCase& scored) {
    return scored.result->outcome != Outcome::none;
  });
  scores.wrong_names = share_of(cases, has_effect, has_wrong_name);
  scores.out_of_catalogue_wrong_name = share_of(cases, outside, is_named);
  scores.out_of_catalogue_unknown = share_of(
      cases, [&](const ScoredCase& scored) { return outside(scored) && has_effect(scored); },
      said(Outcome::unknown));
  scores.confusable_has_truth = share_of(
      cases,
      [](const ScoredCase& scored) {
        return scored.result->outcome == Outcome::confusable && has_effect(scored);
      },
      [](const ScoredCase& scored) { return scored.judgement.set_has_truth; });
  scores.pairs = pair_scores(cases);
  scores.decoys = decoy_scores(cases);
  scores.places = place_scores(cases);
  scores.breakdowns = breakdowns(cases);
  for (const ScoredCase& scored : cases) {
    ++scores.confusion[scored.judgement.truth][scored.judgement.said];
  }
  return scores;
}

}  // namespace recald::blind
