#include "core/model/parameter.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace recald {
namespace {

TEST(Parameter, ValuesAreDescribedWithTheirUnits) {
  const std::vector<Parameter> parameters{{"set_point", "degC", {20.0, 23.5, 28.0}},
                                          {"leakage", "", {0.0, 1.0, 2.0}}};
  const std::vector<double> values{23.25, 0.5};
  EXPECT_EQ(describe(parameters, values), "set_point = 23.25 degC, leakage = 0.5");
}

}  // namespace
}  // namespace recald
