#include "core/diagnosis/expected_changes.hpp"

#include <array>

#include "core/diagnosis/candidate_shapes.hpp"

namespace recald::diagnosis {
namespace {

constexpr int kFirstDay = 28;  ///< A date this close to an end of the record shows nothing.
constexpr int kDaysBetween = 56;
constexpr std::array<int, 3> kLastingDays{56, 112, 196};

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

}  // namespace

void expect_changes(const SiteProblem& site, const SignatureReader& reader, const SignatureFit& fit,
                    const std::vector<Candidate>& candidates, Predictor& predictor,
                    const std::function<void(const ExpectedChange&)>& tell) {
  const SiteFacts facts = site.facts();
  const int days = site.drivers->hours.back().day_index + 1;
  SpanReader spans(reader, fit.hours_kW);
  for (const Candidate& candidate : candidates) {
    for (const std::vector<double>& values : shapes_to_try(candidate)) {
      const auto alteration = candidate.effect->bind(facts, values, candidate.meter);
      predictor.parts_kW(fit.theta, alteration.get());
      spans.take(predictor.hours_kW());
      for (const Span& span : spans_of(candidate, days)) {
        const Eigen::MatrixXd change = spans.change(span.from, span.to);
        tell({&candidate, values, span.from, span.to,
              Eigen::Map<const Eigen::VectorXd>(change.data(), change.size())});
      }
    }
  }
}

}  // namespace recald::diagnosis
