/// Measured sites, written anew as a portal would write them: a column a meter, days first, local
/// times without an offset, decimal commas. They lead to the same months. The measurements are
/// other people's and no part of the project: without them the tests are skipped.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <vector>

#include "../command_line.hpp"
#include "adapters/csv/fields.hpp"
#include "tests/support/data_folders.hpp"
#include "tests/support/sample_exports.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::daemon::init_real_sites_test {
namespace {

using metering::Instant;
using metering::LocalCalendar;
using testing::Outcome;
using testing::run;

std::filesystem::path readings_of(const std::string& site) {
  return recald::testing::others_data("real") / site / "meters.csv";
}

struct Row {
  std::string stamp;
  std::string meter;
  std::string value;
  std::string unit;
};

Row row_of(const std::string& line) {
  Row row;
  std::istringstream in{line};
  std::getline(in, row.stamp, ',');
  std::getline(in, row.meter, ',');
  std::getline(in, row.value, ',');
  std::getline(in, row.unit, ',');
  return row;
}

/// The same readings in another dress.
void rewrite(const std::filesystem::path& from, const std::filesystem::path& to,
             const LocalCalendar& calendar) {
  std::map<std::string, std::string> units;
  std::map<Instant, std::map<std::string, std::string>> times;
  std::ifstream in{from};
  std::string line;
  std::getline(in, line);
  while (std::getline(in, line)) {
    if (line.empty() || line.front() == '#') continue;
    Row row = row_of(line);
    const auto stamp = csv::parse_timestamp(row.stamp);
    ASSERT_TRUE(stamp.has_value()) << line;
    units.emplace(row.meter, row.unit);
    if (const auto point = row.value.find('.'); point != std::string::npos) {
      row.value[point] = ',';
    }
    times[*stamp].emplace(row.meter, row.value);
  }
  std::ofstream out{to};
  out << "Zeit";
  for (const auto& [meter, unit] : units) out << ';' << meter << " (" << unit << ')';
  out << '\n';
  for (const auto& [stamp, values] : times) {
    out << recald::testing::clock_text(calendar, stamp, "%d/%m/%Y %H:%M");
    for (const auto& [meter, unit] : units) {
      const auto value = values.find(meter);
      out << ';' << (value == values.end() ? "" : value->second);
    }
    out << '\n';
  }
}

/// The lines of months.csv that `init` and `replay` lead to, sorted: columns have another order
/// than rows.
std::vector<std::string> months_of(const std::filesystem::path& file,
                                   const std::filesystem::path& folder,
                                   const std::string& timezone) {
  const Outcome begun =
      run({"init", file.string(), "--out", folder.string(), "--timezone", timezone});
  EXPECT_EQ(begun.exit_code, kSuccess) << begun.err;
  const Outcome replayed =
      run({"replay", (folder / "site.toml").string(), "--out", folder.string()});
  EXPECT_EQ(replayed.exit_code, kSuccess) << replayed.err;
  std::vector<std::string> lines;
  std::ifstream in{folder / "months.csv"};
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  std::sort(lines.begin(), lines.end());
  return lines;
}

void expect_same_months(const std::string& site, const std::string& timezone) {
  const std::filesystem::path original = readings_of(site);
  if (!std::filesystem::exists(original)) {
    GTEST_SKIP() << "measured data of " << site << " are not here";
  }
  const recald::testing::TemporaryFolder folder;
  rewrite(original, folder / "portal.csv", *LocalCalendar::open(timezone));
  const std::vector<std::string> expected = months_of(original, folder / "own", timezone);
  EXPECT_GT(expected.size(), 10u);
  EXPECT_EQ(months_of(folder / "portal.csv", folder / "rewritten", timezone), expected);
}

TEST(InitRealSites, Hillside) { expect_same_months("openeis-hillside", "America/Los_Angeles"); }
TEST(InitRealSites, School) { expect_same_months("nmecr-school", "America/Los_Angeles"); }
TEST(InitRealSites, Cambridge) { expect_same_months("cambridge-b25", "Europe/London"); }

}  // namespace
}  // namespace recald::daemon::init_real_sites_test
