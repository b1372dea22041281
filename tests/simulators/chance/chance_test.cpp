#include "simulators/chance/chance.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace recald::simulators::chance_test {
namespace {

TEST(Chance, TriangularQuantilesMeetClosedForm) {
  const Triangular t{0.0, 0.05, 0.10};
  EXPECT_NEAR(t.quantile(0.5), 0.05, 1e-15);
  EXPECT_NEAR(t.quantile(0.05), 0.05 * std::sqrt(0.1), 1e-15);  // 0.316 of the mode
  EXPECT_NEAR(t.quantile(0.48), 0.05 * std::sqrt(0.96), 1e-15);
  EXPECT_NEAR(t.quantile(0.95), 0.10 - 0.05 * std::sqrt(0.1), 1e-15);
  EXPECT_NEAR(t.quantile(1e-12), 0.0, 1e-7);
  const Triangular skew{0.3, 1.0, 1.2};
  EXPECT_NEAR(skew.quantile(0.7 / 0.9), 1.0, 1e-12);
}

TEST(Chance, TriangularMeanIsThatOfItsCorners) {
  Rng rng{3};
  const Triangular t{0.3, 1.0, 1.2};
  double sum = 0.0;
  constexpr int draws = 20'000;
  for (int i = 0; i < draws; ++i) sum += t.draw(rng);
  const double standard_error = std::sqrt((0.09 + 1.44 + 1.0 - 0.3 - 0.36 - 1.2) / 18.0 / draws);
  EXPECT_NEAR(sum / draws, 2.5 / 3.0, 4.0 * standard_error);
}

TEST(Chance, PersistenceKeepsUnitVarianceAndForgetsExponentially) {
  Rng rng{11};
  Persistence value(20.0, 1.0, rng);
  double squares = 0.0;
  double products = 0.0;
  double before = value.value();
  constexpr int steps = 400'000;
  for (int i = 0; i < steps; ++i) {
    const double now = value.advance(rng);
    squares += now * now;
    products += now * before;
    before = now;
  }
  EXPECT_NEAR(squares / steps, 1.0, 0.05);  // 20,000 independent values: standard error 0.01
  EXPECT_NEAR(products / squares, std::exp(-1.0 / 20.0), 0.002);
}

TEST(Chance, StreamsOfOneSeedDiffer) {
  Rng weather = stream_of(1, Stream::weather);
  Rng people = stream_of(1, Stream::people);
  EXPECT_NE(weather.next(), people.next());
}

}  // namespace
}  // namespace recald::simulators::chance_test
