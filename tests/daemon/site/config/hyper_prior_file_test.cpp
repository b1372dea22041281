#include "daemon/site/config/hyper_prior_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>

#include "tests/support/temporary_folder.hpp"

namespace recald::daemon::hyper_prior_file_test {
namespace {

using calibration::BetaPrior;
using calibration::GammaPrior;
using calibration::HyperPriorProfile;
using recald::testing::TemporaryFolder;
using recald::testing::write_text;
using ::testing::ElementsAre;

constexpr const char* kWhole =
    "[discrepancy]\nshape = 10\nrate = 0.0084\n[error]\nshape = 9.5\nrate = 0.00084\n"
    "[rho]\na = 1\nb = 0.4\n";

class HyperPriorFile : public ::testing::Test {
 protected:
  auto load(const std::string& text) {
    write_text(folder_ / "beliefs.toml", text);
    return load_hyper_prior(folder_ / "beliefs.toml");
  }

  TemporaryFolder folder_;
};

TEST_F(HyperPriorFile, IsReadWhole) {
  const auto prior = load(kWhole);
  ASSERT_TRUE(prior);
  EXPECT_EQ(prior->name, "custom");
  EXPECT_EQ(prior->discrepancy_precision, (GammaPrior{10.0, 0.0084}));
  EXPECT_EQ(prior->error_precision, (GammaPrior{9.5, 0.00084}));
  EXPECT_EQ(prior->rho, (BetaPrior{1.0, 0.4}));
}

TEST_F(HyperPriorFile, RhoMayBeAbsent) {
  const auto prior = load("[discrepancy]\nshape = 10\nrate = 1\n[error]\nshape = 9\nrate = 1\n");
  ASSERT_TRUE(prior);
  EXPECT_EQ(prior->rho, (BetaPrior{1.0, 0.3}));
}

TEST_F(HyperPriorFile, EveryProblemIsNamed) {
  const auto problems = load(
      "[discrepancy]\nshape = 10\nrate = -1\n[rho]\na = \"one\"\nb = 0.3\nc = 2\n[eror]\nshape = "
      "1\n");
  ASSERT_FALSE(problems);
  EXPECT_THAT(problems.error(),
              ElementsAre("beliefs.toml:3: [discrepancy] 'rate' is -1; it must be greater than 0",
                          "beliefs.toml:1: [error] with shape and rate is missing",
                          "beliefs.toml:5: [rho] 'a' must be a number",
                          "beliefs.toml:7: [rho] unknown key 'c'",
                          "beliefs.toml:8: unknown key 'eror'; did you mean 'error'?"));
}

TEST_F(HyperPriorFile, NoTomlIsSaid) {
  const auto problems = load("[discrepancy\n");
  ASSERT_FALSE(problems);
  ASSERT_EQ(problems.error().size(), 1U);
  EXPECT_THAT(problems.error()[0], ::testing::StartsWith("beliefs.toml:1: not valid TOML: "));
}

TEST_F(HyperPriorFile, InfinityIsNoBelief) {
  const auto problems =
      load("[discrepancy]\nshape = 10\nrate = inf\n[error]\nshape = 9\nrate = 1\n");
  ASSERT_FALSE(problems);
  EXPECT_EQ(problems.error().size(), 1U);
}

TEST_F(HyperPriorFile, AChoiceIsAProfileOrAFile) {
  const auto profile = choose_hyper_prior("tight");
  ASSERT_TRUE(profile);
  EXPECT_EQ(std::get<HyperPriorProfile>(*profile), HyperPriorProfile::tight);
  write_text(folder_ / "beliefs.toml", kWhole);
  const auto file = choose_hyper_prior((folder_ / "beliefs.toml").string());
  ASSERT_TRUE(file);
  EXPECT_EQ(std::get<calibration::HyperPrior>(*file).name, "custom");
  EXPECT_THAT(choose_hyper_prior("/nowhere/b.toml").error(),
              ElementsAre("hyper-prior file '/nowhere/b.toml' does not exist"));
  const auto neither = choose_hyper_prior("guess");
  ASSERT_FALSE(neither);
  EXPECT_THAT(neither.error()[0], ::testing::EndsWith(", or name a file that ends in .toml"));
}

}  // namespace
}  // namespace recald::daemon::hyper_prior_file_test
