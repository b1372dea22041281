#include "tests/blind/scoring/probability_scores.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace recald::blind {
namespace {

constexpr double kSure = 0.8;
constexpr std::size_t kSlopes = 161;
constexpr std::array kThresholds{0.0, 0.3, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.99};

/// The most probable answer of a case.
struct TopAnswer {
  const ScoredCase* scored;
  std::string answer;
  double probability = 0.0;
  bool right = false;

  [[nodiscard]] bool is_name() const { return answer != kNone && answer != kUnknown; }
};

TopAnswer top_answer(const ScoredCase& scored) {
  const std::vector<std::string> truth = true_answers(*scored.answer);
  TopAnswer top{.scored = &scored, .probability = -1.0};
  for (const auto& [name, probability] : scored.result->probabilities) {
    const bool is_true = std::ranges::find(truth, name) != truth.end();
    if (probability > top.probability ||
        (probability == top.probability && top.right && !is_true)) {
      top.answer = name;
      top.probability = probability;
      top.right = is_true;
    }
  }
  return top;
}

std::vector<TopAnswer> top_answers(const ScoredCases& cases) {
  std::vector<TopAnswer> tops;
  for (const ScoredCase& scored : cases) {
    if (!scored.result->probabilities.empty()) tops.push_back(top_answer(scored));
  }
  return tops;
}

double probability_of(const CaseResult& result, const std::string& name) {
  const auto found = result.probabilities.find(name);
  return found == result.probabilities.end() ? 0.0 : found->second;
}

double brier_of(const CaseResult& result, const std::string& truth) {
  double sum = result.probabilities.contains(truth) ? 0.0 : 1.0;
  for (const auto& [name, probability] : result.probabilities) {
    const double miss = probability - (name == truth ? 1.0 : 0.0);
    sum += miss * miss;
  }
  return sum;
}

void score_truths(const std::vector<TopAnswer>& tops, ProbabilityScores& scores) {
  std::vector<double> briers;
  std::vector<double> losses;
  for (const TopAnswer& top : tops) {
    const std::vector<std::string> truth = true_answers(*top.scored->answer);
    if (truth.size() != 1) continue;
    const double probability = probability_of(*top.scored->result, truth.front());
    briers.push_back(brier_of(*top.scored->result, truth.front()));
    losses.push_back(-std::log(std::max(probability, kProbabilityFloor)));
    if (probability < kProbabilityFloor) ++scores.floored;
  }
  scores.brier = mean_score(std::move(briers));
  scores.log_loss = mean_score(std::move(losses));
}

/// Log losses of one case for each slope that is tried.
using LossesBySlope = std::array<double, kSlopes>;

double slope_at(std::size_t i) {
  constexpr double kLeast = 0.02;
  constexpr double kMost = 5.0;
  return kLeast * std::pow(kMost / kLeast, static_cast<double>(i) / (kSlopes - 1.0));
}

LossesBySlope losses_by_slope(const CaseResult& result, const std::string& truth) {
  LossesBySlope losses{};
  for (std::size_t i = 0; i < kSlopes; ++i) {
    double sum = 0.0;
    for (const auto& [name, probability] : result.probabilities) {
      sum += std::pow(std::max(probability, kProbabilityFloor), slope_at(i));
    }
    if (!result.probabilities.contains(truth)) sum += std::pow(kProbabilityFloor, slope_at(i));
    const double of_truth = std::max(probability_of(result, truth), kProbabilityFloor);
    losses[i] = std::log(sum) - slope_at(i) * std::log(of_truth);
  }
  return losses;
}

std::optional<Score> best_slope(const std::vector<TopAnswer>& tops) {
  std::vector<LossesBySlope> losses;
  for (const TopAnswer& top : tops) {
    const std::vector<std::string> truth = true_answers(*top.scored->answer);
    if (truth.size() == 1) losses.push_back(losses_by_slope(*top.scored->result, truth.front()));
  }
  return bootstrap_score(losses.size(), [&](std::span<const std::size_t> rows) {
    LossesBySlope sum{};
    for (const std::size_t row : rows) {
      for (std::size_t i = 0; i < kSlopes; ++i) sum[i] += losses[row][i];
    }
    return slope_at(static_cast<std::size_t>(std::ranges::min_element(sum) - sum.begin()));
  });
}

std::size_t bin_of(double probability, int bins) {
  return static_cast<std::size_t>(std::min(static_cast<int>(probability * bins), bins - 1));
}

/// Mean probability and share of right answers among the tops that pass.
template <class Bin, class Member>
void fill(Bin& bin, const std::vector<TopAnswer>& tops, Member member) {
  int right = 0;
  double sum = 0.0;
  for (const TopAnswer& top : tops) {
    if (!member(top)) continue;
    ++bin.cases;
    sum += top.probability;
    if (top.right) ++right;
  }
  if (bin.cases > 0) bin.mean_probability = sum / bin.cases;
  bin.right = share_score(right, bin.cases);
}

std::vector<ReliabilityBin> reliability(const std::vector<TopAnswer>& tops, int count) {
  std::vector<ReliabilityBin> bins;
  for (int b = 0; b < count; ++b) {
    ReliabilityBin bin{.low = static_cast<double>(b) / count,
                       .high = static_cast<double>(b + 1) / count};
    fill(bin, tops, [&](const TopAnswer& top) {
      return bin_of(top.probability, count) == static_cast<std::size_t>(b);
    });
    bins.push_back(bin);
  }
  return bins;
}

/// n_b |right_b - mean_b| = |sum over the bin of (right - probability)|, so one pass is enough.
std::optional<Score> calibration_error(const std::vector<TopAnswer>& tops, int count) {
  return bootstrap_score(tops.size(), [&](std::span<const std::size_t> rows) {
    std::vector<double> excess(static_cast<std::size_t>(count));
    for (const std::size_t row : rows) {
      const TopAnswer& top = tops[row];
      excess[bin_of(top.probability, count)] += (top.right ? 1.0 : 0.0) - top.probability;
    }
    double error = 0.0;
    for (const double sum : excess) error += std::abs(sum);
    return error / static_cast<double>(rows.size());
  });
}

std::vector<ReliabilityOfKind> by_kind(const std::vector<TopAnswer>& tops) {
  std::vector<ReliabilityOfKind> kinds;
  for (const std::string_view kind : {std::string_view("a name"), kNone, kUnknown}) {
    ReliabilityOfKind row{.kind = std::string(kind)};
    fill(row, tops, [&](const TopAnswer& top) {
      return top.is_name() ? kind == "a name" : kind == top.answer;
    });
    kinds.push_back(std::move(row));
  }
  return kinds;
}

std::optional<Score> sure_names(const std::vector<TopAnswer>& tops) {
  int right = 0;
  int sure = 0;
  for (const TopAnswer& top : tops) {
    const CaseResult& result = *top.scored->result;
    if (result.named.empty() || probability_of(result, result.named.front()) < kSure) continue;
    const std::vector<std::string> truth = true_answers(*top.scored->answer);
    ++sure;
    if (std::ranges::find(truth, result.named.front()) != truth.end()) ++right;
  }
  return share_score(right, sure);
}

AbstentionPoint abstention_at(const std::vector<TopAnswer>& tops, double threshold) {
  int hidden = 0, hidden_named = 0, empty = 0, empty_named = 0, named = 0, right = 0;
  for (const TopAnswer& top : tops) {
    const bool names = top.is_name() && top.probability >= threshold;
    const Block block = top.scored->answer->block;
    const bool has_catalogued = block == Block::single || block == Block::pair;
    named += names;
    right += names && top.right;
    hidden += has_catalogued;
    hidden_named += has_catalogued && names;
    empty += block == Block::no_effect;
    empty_named += block == Block::no_effect && names;
  }
  return {.threshold = threshold,
          .coverage = share_score(hidden_named, hidden),
          .accuracy = share_score(right, named),
          .false_names = share_score(empty_named, empty)};
}

}  // namespace

ProbabilityScores probability_scores(const ScoredCases& cases, int bins) {
  assert(bins > 0);
  const std::vector<TopAnswer> tops = top_answers(cases);
  ProbabilityScores scores;
  scores.cases = static_cast<int>(tops.size());
  if (tops.empty()) return scores;
  score_truths(tops, scores);
  scores.slope = best_slope(tops);
  scores.bins = reliability(tops, bins);
  scores.ece = calibration_error(tops, bins);
  scores.kinds = by_kind(tops);
  scores.sure_names_right = sure_names(tops);
  for (const double threshold : kThresholds) {
    scores.abstention.push_back(abstention_at(tops, threshold));
  }
  return scores;
}

}  // namespace recald::blind
