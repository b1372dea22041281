#include "core/result.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <string>

namespace recald {
namespace {

Result<int> positive(int value) {
  if (value > 0) return value;
  return failure(ErrorCode::invalid_value, "not positive");
}

Result<void> require_positive(int value) {
  TRY(positive(value));
  return {};
}

Result<int> sum_of(int left, int right) {
  const int a = TRY(positive(left));
  TRY(require_positive(right));
  const auto both = TRY([&]() -> Result<int> { return a + TRY(positive(right)); }());
  return both;
}

TEST(Try, IsTheValueOrEndsTheFunctionWithTheError) {
  EXPECT_EQ(*sum_of(2, 3), 5);
  ASSERT_FALSE(sum_of(-2, 3));
  EXPECT_EQ(sum_of(-2, 3).error().message, "not positive");
  EXPECT_EQ(sum_of(2, -3).error().code, ErrorCode::invalid_value);
}

TEST(Try, MovesWhatNobodyElseHas) {
  const auto length = [](Result<std::unique_ptr<std::string>> given) -> Result<std::size_t> {
    const auto text = TRY(std::move(given));
    return text->size();
  };
  EXPECT_EQ(*length(std::make_unique<std::string>("abc")), 3U);
}

TEST(Try, LeavesAResultThatHasAnotherUse) {
  const Result<std::string> kept = "a text that is longer than what fits into the object itself";
  Result<std::string> also = kept;
  const auto size = [&]() -> Result<std::size_t> {
    const std::string text = TRY(also);
    return text.size();
  };
  EXPECT_EQ(*size(), kept->size());
  EXPECT_EQ(*also, *kept);
}

}  // namespace
}  // namespace recald
