/// The stated posterior of the seed's case, from the command line: the case's own page states
/// it to the last constant, a long run of Stan's NUTS gives the moments with their errors.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "command_line.hpp"
#include "tests/support/data_folders.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::daemon {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using recald::testing::read_text;
using recald::testing::write_text;
using testing::Outcome;
using testing::run;

const fs::path& seedcase() {
  static const fs::path folder = recald::testing::own_data("seedcase");
  return folder;
}

/// The reference scales parameters by their priors' ends and names hyper-parameters as we do.
struct Scale {
  double min = 0.0;
  double range = 1.0;
};

void expect_mean(const Json& ours, const Json& reference, Scale scale) {
  const double mean = (ours["mean"].get<double>() - scale.min) / scale.range;
  const double error = ours["mcse"].get<double>() / scale.range;
  const double reference_error = reference["mcse_mean"];
  EXPECT_NEAR(mean, reference["mean"].get<double>(), 4.0 * std::hypot(error, reference_error));
}

class Reference : public ::testing::TestWithParam<const char*> {};

TEST_P(Reference, EveryMeanIsMetWithinItsError) {
  const fs::path folder = seedcase();
  const Json reference =
      Json::parse(read_text(folder / (std::string{"reference_posterior_"} + GetParam() + ".json")));
  const Json& beliefs = reference["hyperprior"];
  const recald::testing::TemporaryFolder own;
  const auto gamma = [&](const char* table, const char* shape, const char* rate) {
    return std::string{"["} + table + "]\nshape = " + beliefs[shape].dump() +
           "\nrate = " + beliefs[rate].dump() + "\n";
  };
  write_text(own / "beliefs.toml", gamma("discrepancy", "ad", "bd") + gamma("error", "ae", "be") +
                                       "[rho]\na = " + beliefs["ra"].dump() +
                                       "\nb = " + beliefs["rb"].dump() + "\n");
  const Outcome outcome = run({"calibrate", "--doe", folder.string(), "--metamodel",
                               (folder / "metamodel.csv").string(), "--hyper-prior",
                               (own / "beliefs.toml").string(), "--json"});
  ASSERT_EQ(outcome.exit_code, kSuccess) << outcome.err;
  const Json json = Json::parse(outcome.out);
  EXPECT_EQ(json["status"], "converged");
  for (const Json& parameter : json["parameters"]) {
    SCOPED_TRACE(parameter["name"].get<std::string>());
    const double min = parameter["prior"]["min"];
    const double max = parameter["prior"]["max"];
    expect_mean(parameter, reference["parameters"][parameter["name"].get<std::string>()],
                {min, max - min});
  }
  for (const Json& hyper : json["hyperparameters"]) {
    SCOPED_TRACE(hyper["name"].get<std::string>());
    expect_mean(hyper, reference["parameters"][hyper["name"].get<std::string>()], {});
  }
}

INSTANTIATE_TEST_SUITE_P(Seedcase, Reference, ::testing::Values("scaled", "wide"),
                         [](const auto& prior) { return std::string{prior.param}; });

}  // namespace
}  // namespace recald::daemon
