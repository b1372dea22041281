/// `[model.errors]`: what a site knows of how far its model is from the building.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/daemon/command_line.hpp"
#include "tests/daemon/depot_year.hpp"
#include "tests/support/sample_site.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::daemon::model_errors_of_a_site_test {
namespace {

using Json = nlohmann::json;
using recald::daemon::testing::run;

/// The calibrated outdoor airflow of a site with these errors.
Json airflow_with(const std::string& errors) {
  const recald::testing::TemporaryFolder folder;
  std::string site = recald::testing::sample_site();
  site.insert(site.find("[[model.parameter]]"), errors);
  recald::testing::write_depot_year(folder / "", site);
  const auto outcome = run({"calibrate", (folder / "site.toml").string(), "--json"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  const Json result = Json::parse(outcome.out);
  for (const Json& parameter : result["parameters"]) {
    if (parameter["name"] == "outdoor_airflow") return parameter;
  }
  return {};
}

TEST(ModelErrorsOfASite, LargerOnesLeaveMoreOfThePrior) {
  const Json sure = airflow_with("[model.errors]\nparameter_share = 0\n");
  const Json learnt = airflow_with("");
  const Json unsure = airflow_with("[model.errors]\nparameter_share = 5\n");
  EXPECT_DOUBLE_EQ(sure["contraction_max"].get<double>(), 1.0);
  EXPECT_NEAR(unsure["contraction_max"].get<double>(), 1.0 / 26.0, 1e-9);
  EXPECT_LT(learnt["sd"].get<double>(), unsure["sd"].get<double>());
}

}  // namespace
}  // namespace recald::daemon::model_errors_of_a_site_test
