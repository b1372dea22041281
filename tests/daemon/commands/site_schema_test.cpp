/// The schema that editors read, held against the site files that come with recald.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <toml++/toml.h>

#include <nlohmann/json.hpp>

#include "daemon/commands/line/site_schema.hpp"
#include "tests/support/sample_site.hpp"

namespace recald::daemon::site_schema_test {
namespace {

using Json = nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

Json as_json(const toml::node& node) {
  if (const auto* table = node.as_table()) {
    Json object = Json::object();
    for (const auto& [key, value] : *table) object[std::string{key.str()}] = as_json(value);
    return object;
  }
  if (const auto* array = node.as_array()) {
    Json list = Json::array();
    for (const toml::node& value : *array) list.push_back(as_json(value));
    return list;
  }
  if (const auto text = node.value<std::string>(); text && node.is_string()) return *text;
  if (node.is_boolean()) return *node.value<bool>();
  return *node.value<double>();
}

bool has_type(const Json& value, const Json& type) {
  if (type.is_array()) {
    return std::any_of(type.begin(), type.end(),
                       [&](const Json& one) { return has_type(value, one); });
  }
  return (type == "object" && value.is_object()) || (type == "array" && value.is_array()) ||
         (type == "string" && value.is_string()) || (type == "number" && value.is_number()) ||
         (type == "boolean" && value.is_boolean());
}

/// What a validator of the few words that the schema uses finds wrong.
void validate(const Json& value, const Json& schema, const std::string& at,
              std::vector<std::string>& wrong) {
  if (schema.contains("type") && !has_type(value, schema["type"])) {
    wrong.push_back(at + " is no " + schema["type"].dump());
    return;
  }
  if (value.is_array() && schema.contains("items")) {
    for (const Json& one : value) validate(one, schema["items"], at, wrong);
  }
  if (!value.is_object()) return;
  for (const auto& [key, one] : value.items()) {
    const std::string inner = at.empty() ? key : at + "." + key;
    const bool known = schema.contains("properties") && schema["properties"].contains(key);
    if (known) {
      validate(one, schema["properties"][key], inner, wrong);
    } else if (schema["additionalProperties"].is_object()) {
      validate(one, schema["additionalProperties"], inner, wrong);
    } else {
      wrong.push_back(inner + " is unknown");
    }
  }
}

class SiteSchema : public ::testing::Test {
 protected:
  [[nodiscard]] std::vector<std::string> wrong_in(const toml::table& site) const {
    std::vector<std::string> wrong;
    validate(as_json(site), schema_, "", wrong);
    return wrong;
  }
  Json schema_ = Json::parse(site_schema());
};

TEST_F(SiteSchema, TakesTheSiteFilesThatComeWithRecald) {
  int files = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator{RECALD_SOURCE_DIR "/daemon/examples"}) {
    SCOPED_TRACE(entry.path());
    EXPECT_THAT(wrong_in(toml::parse_file(entry.path().string())), IsEmpty());
    ++files;
  }
  EXPECT_GE(files, 4);
  EXPECT_THAT(wrong_in(toml::parse(recald::testing::sample_site())), IsEmpty());
}

TEST_F(SiteSchema, KnowsNoOtherKeysAndTypes) {
  EXPECT_THAT(wrong_in(toml::parse("[site]\nid = \"a\"\ntimezon = \"UTC\"")),
              ElementsAre("site.timezon is unknown"));
  EXPECT_THAT(wrong_in(toml::parse("[[meter]]\nid = 7")), ElementsAre("meter.id is no \"string\""));
  EXPECT_THAT(wrong_in(toml::parse("[bus.any]\nport = true")),
              ElementsAre(HasSubstr("bus.any.port is no ")));
  EXPECT_THAT(wrong_in(toml::parse("[bus.any]\nport = \"ttyS0\"")), IsEmpty());
  EXPECT_THAT(wrong_in(toml::parse("[[meter]]\nfile = [\"2023.csv\", \"2024.csv\"]")), IsEmpty());
  EXPECT_THAT(wrong_in(toml::parse("[weather]\nfile = [\"2023.epw\", 7]")),
              ElementsAre(HasSubstr("weather.file is no ")));
}

TEST_F(SiteSchema, ExplainsKeys) {
  EXPECT_THAT(schema_["properties"]["site"]["properties"]["timezone"]["description"],
              HasSubstr("IANA"));
}

}  // namespace
}  // namespace recald::daemon::site_schema_test
