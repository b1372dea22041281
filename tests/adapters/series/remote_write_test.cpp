#include "adapters/series/remote_write.hpp"

#include <gmock/gmock.h>
#include <snappy.h>

#include <limits>

namespace recald::series::remote_write_test {
namespace {

using std::chrono::minutes;

std::string hexadecimal(const std::string& body) {
  std::string bytes;
  if (!snappy::Uncompress(body.data(), body.size(), &bytes)) return "not Snappy";
  std::string digits;
  for (const char c : bytes) {
    for (const int shift : {4, 0}) {
      digits += "0123456789abcdef"[static_cast<unsigned char>(c) >> shift & 0xF];
    }
  }
  return digits;
}

// Serialized by Google's Python package protobuf 7.35 from the messages of the specification:
// 2026-01-01 00:00 and 00:15 UTC, {meter="main", site="Gebäude 7"}, mean 12.5 and -0.1, peak 1e22.
TEST(RemoteWriteBody, HasTheBytesOfAnotherEncoder) {
  const metering::Instant start = std::chrono::sys_days{std::chrono::year{2026} / 1 / 1};
  const std::vector<std::pair<std::string, std::string>> labels{
      {"site", "Gebäude 7"}, {"tag", ""}, {"meter", "main"}};
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Point> points{
      {"recald_interval",
       labels,
       start + minutes{15},
       {{"peak_kilowatts", nothing}, {"mean_kilowatts", -0.1}}},
      {"recald_interval", labels, start, {{"mean_kilowatts", 3.0}}},  // read again, and corrected
      {"recald_interval", labels, start, {{"peak_kilowatts", 1e22}, {"mean_kilowatts", 12.5}}}};
  EXPECT_EQ(
      hexadecimal(remote_write_body(points)),
      "0a730a2a0a085f5f6e616d655f5f121e726563616c645f696e74657276616c5f6d65616e5f6b696c6f776174"
      "74730a0d0a056d6574657212046d61696e0a120a0473697465120a476562c3a4756465203712100900000000"
      "000029401080d0eab6b7331210099a9999999999b9bf10a0c7a1b7b7330a610a2a0a085f5f6e616d655f5f12"
      "1e726563616c645f696e74657276616c5f7065616b5f6b696c6f77617474730a0d0a056d6574657212046d61"
      "696e0a120a0473697465120a476562c3a4756465203712100992d54d06cff080441080d0eab6b733");
}

TEST(RemoteWriteBody, OfNoPointsIsAnEmptyMessage) {
  EXPECT_EQ(hexadecimal(remote_write_body({})), "");
  EXPECT_NE(remote_write_body({}), "");
}

// Bytes are compared, so capitals stand before "__name__".
TEST(RemoteWriteBody, SortsLabelsAsBytes) {
  const std::vector<Point> points{{"m", {{"a", "1"}, {"Z", "2"}}, {}, {{"f", 0.0}}}};
  const std::string digits = hexadecimal(remote_write_body(points));
  const auto at = [&](const char* name) { return digits.find(name); };
  EXPECT_LT(at("0a015a"), at("0a085f5f6e616d65"));  // "Z", "__name"
  EXPECT_LT(at("0a085f5f6e616d65"), at("0a0161"));  // "a"
}

}  // namespace
}  // namespace recald::series::remote_write_test
