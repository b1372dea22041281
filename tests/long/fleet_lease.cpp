/// How long a worker waits for its next job: takes jobs from the record of a fleet and gives them
/// back.
///
///     fleet_lease URL TIMES
///
/// Prints a JSON object: milliseconds of a lease, of the median and the slowest.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "adapters/record/jobs.hpp"

int main(int argc, char** argv) {
  using namespace recald;
  if (argc != 3) {
    std::fprintf(stderr, "fleet_lease URL TIMES\n");
    return 2;
  }
  const auto record = postgres::Connection::open(argv[1], "");
  if (!record) {
    std::fprintf(stderr, "%s\n", record.error().message.c_str());
    return 1;
  }
  std::vector<double> milliseconds;
  for (int i = 0; i < std::atoi(argv[2]); ++i) {
    const auto begin = std::chrono::steady_clock::now();
    const auto job = record::lease(**record, "measured", {});
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - begin;
    if (!job || !*job || !record::hand_back(**record, **job)) {
      std::fprintf(stderr, "no job waits\n");
      return 1;
    }
    milliseconds.push_back(took.count());
  }
  std::ranges::sort(milliseconds);
  fmt::print("{{\"median_ms\": {:.2f}, \"slowest_ms\": {:.2f}}}\n",
             milliseconds[milliseconds.size() / 2], milliseconds.back());
  return 0;
}
