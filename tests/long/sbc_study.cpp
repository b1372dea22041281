// The full simulation-based calibration of both ways, as a table for tests/results/calibration.md.
//
//   sbc_study [replicates] [seed|gaps|epc|default|model]

#include <cstdio>
#include <cstdlib>
#include <string>

#include "adapters/system/parallel_for.hpp"
#include "tests/core/calibration/sbc_cases.hpp"

namespace {

using namespace recald;
using namespace recald::calibration;

void print(const char* name, const SbcResult& result) {
  std::printf(
      "\n%s: %d replicates, %d failed, %d did not converge, populations took over in %d, "
      "smallest bulk ESS %.0f\n\n",
      name, result.replicates, result.failed, result.unconverged, result.replaced,
      result.smallest_ess);
  std::printf(
      "| quantity | chi-squared p of 20 bins | inside 50 %% | inside 80 %% | inside 95 %% |\n");
  std::printf("| --- | --- | --- | --- | --- |\n");
  for (const SbcQuantity& quantity : result.quantities) {
    std::printf("| %s | %.3f |", quantity.name.c_str(), quantity.p_value());
    for (std::size_t level = 0; level < kSbcLevels.size(); ++level) {
      const double p = kSbcLevels[level];
      const double share = quantity.inside[level] / static_cast<double>(result.replicates);
      const double se = std::sqrt(p * (1.0 - p) / result.replicates);
      std::printf(" %.3f (%+.1f se) |", share, (share - p) / se);
    }
    std::printf("\n");
  }
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const int replicates = argc > 1 ? std::atoi(argv[1]) : 500;
  const std::string only = argc > 2 ? argv[2] : "";
  const ForEachIndex executor = system::parallel_for();
  if (only.empty() || only == "seed") {
    OwnedSbcCase c = metamodel_case(6, 24, 4, /*gaps=*/false);
    print("Meta-model of the seed's size, default sampler",
          run_sbc(c.sbc, replicates, 10'001, executor));
  }
  if (only.empty() || only == "gaps") {
    OwnedSbcCase c = metamodel_case(3, 18, 2, /*gaps=*/true);
    print("Meta-model with missing months and known extra errors, default sampler",
          run_sbc(c.sbc, replicates, 20'001, executor));
  }
  if (only.empty() || only == "epc") {
    OwnedSbcCase c = epc_case(6, 1);
    c.sbc.draws = 79;
    c.sbc.sampling.sampler = find_sampler("dram").value();
    c.sbc.sampling.iterations = 5'000;
    c.sbc.sampling.burn_in = 1'000;
    c.sbc.sampling.gate = {.rhat_max = 1.05, .ess_min = 100.0, .mcse_share_max = 0.1};
    print("EPC, six months, DRAM", run_sbc(c.sbc, replicates, 30'001, executor));
  }
  if (only.empty() || only == "default") {
    const OwnedSbcCase c = emulated_epc_case(12, 2, /*data_from_model=*/false);
    print("EPC, twelve months, as a calibration of a site goes by default",
          run_sbc(c.sbc, replicates, 40'001, executor));
  }
  if (only.empty() || only == "model") {
    const OwnedSbcCase c = emulated_epc_case(12, 2, /*data_from_model=*/true);
    print("The same, with data from the model itself",
          run_sbc(c.sbc, replicates, 40'001, executor));
  }
  return 0;
}
