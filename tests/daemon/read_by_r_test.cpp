/// The draws in the hands of R: its package posterior reads the files and agrees on their
/// diagnostics.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "command_line.hpp"
#include "tests/support/sample_design.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::daemon {
namespace {

using Json = nlohmann::json;

/// What a command prints, or the reason it could not be run.
std::string output_of(const std::string& command) {
  std::FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return "cannot run";
  std::string text;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) text += static_cast<char>(c);
  ::pclose(pipe);
  return text;
}

// The draws are made for other people's tools: R's posterior, from which the diagnostics' paper
// comes, reads the files and agrees.
TEST(ReadByR, TheDrawsAreReadByPosterior) {
  if (output_of("Rscript -e 'cat(requireNamespace(\"posterior\", quietly = TRUE))'") != "TRUE") {
    GTEST_SKIP() << "R with its package posterior is not there";
  }
  const recald::testing::TemporaryFolder folder;
  const auto path = [&](std::string_view name) { return (folder / name).string(); };
  recald::testing::write_sample_design(folder / "design");
  const testing::Outcome outcome =
      testing::run({"calibrate", "--doe", path("design"), "--json", "--out", path("out"),
                    "--sampler", "dram", "--draws", "2000", "--burn-in", "500"});
  ASSERT_EQ(outcome.exit_code, kSuccess) << outcome.err;
  recald::testing::write_text(
      folder / "read.R",
      "chains <- lapply(1:4, function(k) read.csv(sprintf('" + path("out") +
          "/draws_%d.csv', k), comment.char = '#', check.names = FALSE))\n"
          "draws <- posterior::as_draws_array(simplify2array(lapply(chains, as.matrix)) |>\n"
          "  aperm(c(1, 3, 2)))\n"
          "draws <- draws[, , -(1:2)]  # lp__ and accept_stat__\n"
          "s <- posterior::summarise_draws(draws, 'rhat', 'ess_bulk', 'ess_tail')\n"
          "cat(posterior::niterations(draws), posterior::nchains(draws), '\\n')\n"
          "cat(sprintf('%s %.8f %.4f %.4f\\n', s$variable, s$rhat, s$ess_bulk, s$ess_tail),"
          " sep = '')\n");
  std::istringstream words{output_of("Rscript " + path("read.R"))};
  int iterations = 0;
  int chains = 0;
  words >> iterations >> chains;
  const Json json = Json::parse(outcome.out);
  ASSERT_EQ(iterations, json["sampling"]["draws"].get<int>()) << words.str();
  ASSERT_EQ(chains, 4);
  std::map<std::string, std::array<double, 3>> by_name;
  std::string name;
  for (std::array<double, 3> d{}; words >> name >> d[0] >> d[1] >> d[2];) by_name[name] = d;
  for (const char* list : {"parameters", "hyperparameters"}) {
    for (const Json& quantity : json[list]) {
      const auto found = by_name.find(quantity["name"]);
      ASSERT_NE(found, by_name.end()) << quantity["name"];
      EXPECT_NEAR(quantity["rhat"], found->second[0], 0.01 * found->second[0]) << name;
      EXPECT_NEAR(quantity["ess_bulk"], found->second[1], 0.01 * found->second[1]) << name;
      EXPECT_NEAR(quantity["ess_tail"], found->second[2], 0.01 * found->second[2]) << name;
    }
  }
}

}  // namespace
}  // namespace recald::daemon
