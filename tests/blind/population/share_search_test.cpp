#include "tests/blind/population/share_search.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/blind/population/moved_share.hpp"

namespace recald::blind::share_search_test {
namespace {

struct Found {
  std::optional<double> strength;
  int tries;
};

template <class Share>
Found search(const StrengthLimits& limits, const Share& share) {
  int tries = 0;
  const auto found = strength_in(kFrom3To10, limits, 4, [&](double strength) -> Result<double> {
    ++tries;
    return share(strength);
  });
  return {*found, tries};
}

TEST(ShareSearch, FindsAStrengthOfTheBin) {
  const auto share = [](double strength) { return 0.002 * std::pow(strength, 1.5); };
  const Found found = search({0.1, 400.0}, share);
  ASSERT_TRUE(found.strength.has_value());
  EXPECT_TRUE(kFrom3To10.holds(share(*found.strength)));
}

TEST(ShareSearch, KeepsTheSign) {
  const auto share = [](double strength) { return strength < 0.0 ? -0.2 * strength : 1.0; };
  const Found found = search({-0.02, -1.0}, share);
  ASSERT_TRUE(found.strength.has_value());
  EXPECT_LT(*found.strength, 0.0);
}

TEST(ShareSearch, GivesUpWhereTheStrongestIsTooWeak) {
  EXPECT_EQ(search({0.1, 1.0}, [](double strength) { return 0.001 * strength; }).strength,
            std::nullopt);
}

TEST(ShareSearch, AsksOnceForWhatIsThereOrNot) {
  const Found none = search({1.0, 1.0}, [](double) { return 0.2; });
  EXPECT_EQ(none.strength, std::nullopt);
  EXPECT_EQ(none.tries, 1);
  EXPECT_EQ(search({1.0, 1.0}, [](double) { return 0.05; }).strength, 1.0);
}

TEST(ShareSearch, TriesTheStrongestWhereTheMiddleShowsNothing) {
  const auto share = [](double strength) { return strength > 5.0 ? 0.05 : 0.0; };
  EXPECT_EQ(search({0.1, 10.0}, share).strength, 10.0);
}

TEST(ShareSearch, PassesOnWhatWasRefused) {
  const auto refused = strength_in(kFrom3To10, {0.1, 1.0}, 4, [](double) -> Result<double> {
    return failure(ErrorCode::io_failed, "disk full");
  });
  EXPECT_EQ(refused.error().message, "disk full");
}

TEST(MovedShare, OfAMeterThatHardlyCountsIsNothing) {
  const std::array whole_kW{1000.0, 15.0, 30.0};
  std::array shares{0.02, 0.9, 0.4};
  leave_out_small_meters(whole_kW, shares);
  EXPECT_EQ(shares, (std::array{0.02, 0.0, 0.4}));
}

}  // namespace
}  // namespace recald::blind::share_search_test
