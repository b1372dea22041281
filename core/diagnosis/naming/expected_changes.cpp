#include "core/diagnosis/naming/expected_changes.hpp"

#include <algorithm>
#include <array>

#include "core/diagnosis/evidence/candidate_shapes.hpp"

namespace recald::diagnosis {
namespace {

constexpr int kBlockDays = 28;         ///< All dates are whole blocks from the start.
constexpr int kFirstDay = kBlockDays;  ///< A date this close to an end of the record shows nothing.
constexpr int kDaysBetween = 2 * kBlockDays;
constexpr std::array<int, 3> kLastingDays{2 * kBlockDays, 4 * kBlockDays, 7 * kBlockDays};

struct Span {
  int from;
  int to;
};

std::vector<Span> spans_of(const Candidate& candidate, int days) {
  if (!candidate.begins) return {{0, days}};
  std::vector<Span> spans;
  for (int from = kFirstDay; from < days - kFirstDay; from += kDaysBetween) {
    spans.push_back({from, days});
    if (!candidate.ends) continue;
    for (const int lasting : kLastingDays) {
      if (from + lasting < days) spans.push_back({from, from + lasting});
    }
  }
  return spans;
}

/// What the record changes by up to the end of each block; of none first, of all last.
Eigen::MatrixXd changes_up_to(const SpanReader& reader, int days) {
  const int blocks = (days + kBlockDays - 1) / kBlockDays;
  Eigen::MatrixXd changes;
  for (int block = 0; block <= blocks; ++block) {
    const Eigen::MatrixXd change =
        reader.change(std::max(block - 1, 0) * kBlockDays, std::min(block * kBlockDays, days));
    if (block == 0) changes.resize(change.size(), blocks + 1);
    changes.col(block) = Eigen::Map<const Eigen::VectorXd>(change.data(), change.size());
    if (block > 0) changes.col(block) += changes.col(block - 1);
  }
  return changes;
}

}  // namespace

void expect_changes(const SiteProblem& site, const SignatureReader& reader, const SignatureFit& fit,
                    const std::vector<Candidate>& candidates, Predictor& predictor,
                    const std::function<void(const ExpectedChange&)>& visit,
                    std::optional<int> since_day) {
  const SiteFacts facts = site.facts();
  const int days = site.drivers->hours.back().day_index + 1;
  /// A run with an effect in one shape.
  struct Run {
    std::size_t candidate;
    std::vector<double> values;
    Eigen::MatrixXd changes;  ///< Since the day, or up to the end of each block.
  };
  const auto is_alike = [&](std::size_t i, const Candidate& other) {
    return other.effect == candidates[i].effect && other.meter == candidates[i].meter;
  };
  std::vector<Run> runs;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const auto begin = candidates.begin() + static_cast<std::ptrdiff_t>(i);
    if (std::any_of(candidates.begin(), begin,
                    [&](const Candidate& other) { return is_alike(i, other); })) {
      continue;
    }
    for (const std::vector<double>& values : shapes_to_try(candidates[i])) {
      runs.push_back({i, values, {}});
    }
  }
  predictor.for_each(runs.size(), [&](Predictor& own, std::size_t r) {
    if (own.is_stopped()) return;
    const Candidate& candidate = candidates[runs[r].candidate];
    const auto alteration = candidate.effect->bind(facts, runs[r].values, candidate.meter);
    own.parts_kW(fit.theta, alteration.get());
    SpanReader spans(reader, fit.hours_kW);
    spans.take(own.hours_kW());
    runs[r].changes = since_day ? spans.change(*since_day, days) : changes_up_to(spans, days);
  });
  if (predictor.is_stopped()) return;
  for (const Run& run : runs) {
    const Eigen::MatrixXd& changes = run.changes;
    for (std::size_t i = run.candidate; i < candidates.size(); ++i) {
      if (!is_alike(run.candidate, candidates[i])) continue;
      if (since_day) {
        visit({&candidates[i], run.values, *since_day, days,
               Eigen::Map<const Eigen::VectorXd>(changes.data(), changes.size())});
        continue;
      }
      for (const Span& span : spans_of(candidates[i], days)) {
        const Eigen::Index to =
            span.to == days ? changes.cols() - 1 : Eigen::Index{span.to / kBlockDays};
        visit({&candidates[i], run.values, span.from, span.to,
               changes.col(to) - changes.col(span.from / kBlockDays)});
      }
    }
  }
}

}  // namespace recald::diagnosis
