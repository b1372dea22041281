#include "adapters/series/line_protocol.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "tests/adapters/series/sample_points.hpp"

namespace recald::series::line_protocol_test {
namespace {

using recald::testing::interval_point;

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinite = std::numeric_limits<double>::infinity();
const metering::Instant kStart = std::chrono::sys_days{std::chrono::year{2026} / 1 / 1};

TEST(LineProtocol, HasALineForEachPoint) {
  std::vector<Point> points{interval_point("main", kStart, 12.5),
                            interval_point("chiller-2", kStart + std::chrono::minutes{15}, 5.0)};
  points[0].fields.push_back({"missing", kNothing});
  points[0].fields.push_back({"temperature_celsius", -0.1});
  EXPECT_EQ(line_protocol(points),
            "recald_interval,site=depot,meter=main mean_kilowatts=12.5,temperature_celsius=-0.1 "
            "1767225600000000000\n"
            "recald_interval,site=depot,meter=chiller-2 mean_kilowatts=5 1767226500000000000\n");
}

TEST(LineProtocol, LeavesOutWhatItCannotSay) {
  EXPECT_EQ(line_protocol({}), "");
  const std::vector<Point> points{interval_point("main", kStart, kNothing),
                                  interval_point("main", kStart, -kInfinite),
                                  interval_point("", kStart, 1.0)};
  EXPECT_EQ(line_protocol(points),
            "recald_interval,site=depot mean_kilowatts=1 1767225600000000000\n");
}

TEST(LineProtocol, EscapesValuesOfLabels) {
  const auto written = [](const std::string& meter) {
    const std::vector<Point> points{interval_point(meter, kStart, 1.0)};
    const std::string line = line_protocol(points);
    const std::size_t at = line.find("meter=") + 6;
    return line.substr(at, line.find(" mean_kilowatts") - at);
  };
  EXPECT_EQ(written("a, b=c \"d\" #ü"), R"(a\,\ b\=c\ "d"\ #ü)");
  EXPECT_EQ(written("two\r\nlines\t"), R"(two\ \ lines\ )");
  EXPECT_EQ(written(R"(C:\plant\)"), "C:/plant/");
}

}  // namespace
}  // namespace recald::series::line_protocol_test
