#include "core/diagnosis/expected_changes.hpp"

#include <algorithm>
#include <array>

#include "core/diagnosis/candidate_shapes.hpp"

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
                    const std::function<void(const ExpectedChange&)>& tell,
                    std::optional<int> since_day) {
  const SiteFacts facts = site.facts();
  const int days = site.drivers->hours.back().day_index + 1;
  SpanReader spans(reader, fit.hours_kW);
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const auto is_alike = [&](const Candidate& other) {
      return other.effect == candidates[i].effect && other.meter == candidates[i].meter;
    };
    const auto begin = candidates.begin() + static_cast<std::ptrdiff_t>(i);
    if (std::any_of(candidates.begin(), begin, is_alike)) continue;
    for (const std::vector<double>& values : shapes_to_try(candidates[i])) {
      if (predictor.is_stopped()) return;
      const auto alteration = candidates[i].effect->bind(facts, values, candidates[i].meter);
      predictor.parts_kW(fit.theta, alteration.get());
      spans.take(predictor.hours_kW());
      if (since_day) {
        const Eigen::MatrixXd change = spans.change(*since_day, days);
        for (auto alike = begin; alike != candidates.end(); ++alike) {
          if (!is_alike(*alike)) continue;
          tell({&*alike, values, *since_day, days,
                Eigen::Map<const Eigen::VectorXd>(change.data(), change.size())});
        }
        continue;
      }
      const Eigen::MatrixXd changes = changes_up_to(spans, days);
      for (auto alike = begin; alike != candidates.end(); ++alike) {
        if (!is_alike(*alike)) continue;
        for (const Span& span : spans_of(*alike, days)) {
          const Eigen::Index to =
              span.to == days ? changes.cols() - 1 : Eigen::Index{span.to / kBlockDays};
          tell({&*alike, values, span.from, span.to,
                changes.col(to) - changes.col(span.from / kBlockDays)});
        }
      }
    }
  }
}

}  // namespace recald::diagnosis
