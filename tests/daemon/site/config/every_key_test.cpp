/// The example with every key, made wrong in every way there is: each of its values as another
/// type, as no number, as a word that nobody knows, each key misspelt, each required one left out.
/// A key that is added to the example is tested by being there.
#include <gmock/gmock.h>

#include <fstream>
#include <set>

#include "daemon/site/config/site_config.hpp"

namespace recald::daemon::every_key_test {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

/// One `key = value` of the example, and where it stands. Lines and columns count from 1.
struct Entry {
  std::string path;  ///< "building.air.fan_design_kW"
  std::string key;
  toml::source_region key_at;
  toml::source_region value_at;
  toml::node_type type;
};

class EveryKey : public ::testing::Test {
 protected:
  EveryKey() {
    std::ifstream in{RECALD_SOURCE_DIR "/daemon/examples/every-key.toml"};
    for (std::string line; std::getline(in, line);) lines_.push_back(line);
    const toml::table root = toml::parse(text(lines_));
    collect(root, "");
  }

  using Lines = std::vector<std::string>;

  static std::string text(const Lines& lines) {
    std::string joined;
    for (const std::string& line : lines) joined += line + "\n";
    return joined;
  }

  static Problems problems_of(const Lines& lines) {
    const auto site = parse_site(text(lines), "/nowhere/every-key.toml");
    return site ? Problems{} : site.error();
  }

  /// The example with a region of one line replaced.
  [[nodiscard]] Lines with(const toml::source_region& region, const std::string& words) const {
    Lines lines = lines_;
    std::string& line = lines[region.begin.line - 1];
    EXPECT_EQ(region.begin.line, region.end.line) << line;
    line.replace(region.begin.column - 1, region.end.column - region.begin.column, words);
    return lines;
  }

  /// What is refused names the line and the key.
  void expect_refused(const Entry& entry, const std::string& value, const std::string& said) {
    SCOPED_TRACE(entry.path + " = " + value);
    const std::string place = "every-key.toml:" + std::to_string(entry.value_at.begin.line) + ": ";
    EXPECT_THAT(problems_of(with(entry.value_at, value)),
                Contains(AllOf(StartsWith(place), HasSubstr(said))));
    ++wrong_;
  }

  Lines lines_;
  std::vector<Entry> entries_;
  int wrong_ = 0;  ///< Configurations tried.

 private:
  void collect(const toml::table& table, const std::string& path) {
    for (const auto& [key, node] : table) {
      const std::string name{key.str()};
      const std::string inner = path.empty() ? name : path + "." + name;
      if (const toml::table* child = node.as_table()) {
        collect(*child, inner);
      } else if (node.is_array_of_tables()) {
        for (const toml::node& element : *node.as_array()) collect(*element.as_table(), inner);
      } else {
        entries_.push_back({inner, name, key.source(), node.source(), node.type()});
      }
    }
  }
};

TEST_F(EveryKey, IsRightAsItStands) {
  EXPECT_THAT(problems_of(lines_), IsEmpty());
  EXPECT_GT(entries_.size(), 120u);
}

TEST_F(EveryKey, OfAnotherTypeIsRefused) {
  for (const Entry& entry : entries_) {
    const bool is_text = entry.type == toml::node_type::string;
    expect_refused(entry, is_text ? "7" : "\"seven\"", "'" + entry.key + "' must be");
    expect_refused(entry, "{ a = 1 }", "'" + entry.key + "' must be");
  }
  EXPECT_GT(wrong_, 240);
}

TEST_F(EveryKey, NumbersAreFiniteAndWithinReason) {
  for (const Entry& entry : entries_) {
    if (entry.type != toml::node_type::floating_point && entry.type != toml::node_type::integer) {
      continue;
    }
    for (const char* value : {"nan", "inf", "-inf"}) {
      expect_refused(entry, value, "'" + entry.key + "' is " + value + "; it must be");
    }
    if (entry.path.starts_with("model.parameter.")) continue;  // a prior may lie anywhere
    expect_refused(entry, "-1e12", "'" + entry.key + "' is -1");
  }
  EXPECT_GT(wrong_, 200);
}

TEST_F(EveryKey, WordsAreKnownOnes) {
  const std::set<std::string> free{"name",         "file",          "name_in_file",
                                   "host",         "token_file",    "certificate_file",
                                   "key_file",     "backup_folder", "design",
                                   "time_column",  "column",        "clock_column",
                                   "meter_column", "unit_column",   "flag_column",
                                   "sheet",        "currency",      "program",
                                   "user",         "password_file", "trusted_certificate",
                                   "url"};
  for (const Entry& entry : entries_) {
    if (entry.type != toml::node_type::string || free.contains(entry.key)) continue;
    if (entry.path == "bus.cellar.port") continue;           // any device
    if (entry.path == "model.parameter.source") continue;    // any words
    if (entry.path == "model.parameter.unit") continue;      // of a client's model
    if (entry.path.starts_with("model.reports.")) continue;  // likewise
    if (entry.path == "model.parameter.targets") continue;
    const bool is_of_others =
        entry.path.ends_with("energy_from.topic") || entry.path.ends_with("power_from.topic");
    if (!is_of_others) expect_refused(entry, "\"no such\"", "no such");
    expect_refused(entry, "\"\"", entry.key);
  }
  EXPECT_GT(wrong_, 50);
}

TEST_F(EveryKey, MisspeltIsTakenForTheNearest) {
  for (const Entry& entry : entries_) {
    if (entry.path.starts_with("model.weights.")) continue;  // names of meters
    SCOPED_TRACE(entry.path);
    const std::string misspelt = entry.key + "x";
    const std::string place = "every-key.toml:" + std::to_string(entry.key_at.begin.line) + ": ";
    EXPECT_THAT(problems_of(with(entry.key_at, misspelt)),
                Contains(AllOf(StartsWith(place), HasSubstr("unknown key '" + misspelt +
                                                            "'; did you mean '" + entry.key))));
  }
}

// The example says of a key that may be absent what its default is.
TEST_F(EveryKey, RequiredOnesAreMissed) {
  for (const Entry& entry : entries_) {
    const std::size_t index = entry.key_at.begin.line - 1;
    const std::string& line = lines_[index];
    const bool has_line_of_its_own = line.starts_with(entry.key + " ");
    const bool is_required =
        line.find('#') != std::string::npos && line.find("default") == std::string::npos;
    if (!has_line_of_its_own || !is_required) continue;
    SCOPED_TRACE(line);
    Lines lines = lines_;
    lines[index].clear();
    EXPECT_THAT(problems_of(lines), Contains(HasSubstr(entry.key)));
    ++wrong_;
  }
  EXPECT_GT(wrong_, 15);
}

}  // namespace
}  // namespace recald::daemon::every_key_test
