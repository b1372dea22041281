#include "adapters/energyplus/model_document.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace recald::energyplus::model_document_test {
namespace {

using ::testing::HasSubstr;

constexpr std::string_view kModel = R"({
  "Version": {"Version 1": {"version_identifier": "25.2"}},
  "Lights": {"Core lights": {"watts_per_floor_area": 10.0, "fraction_radiant": 0.4},
             "Shop Lights": {"watts_per_floor_area": 20.0}},
  "Fan:VariableVolume": {"Supply fan": {"maximum_flow_rate": "Autosize"}},
  "Schedule:Compact": {"Heating": {"data": [{"field": "Through: 12/31"}, {"field": 21.0},
                                            {"field": 16.0}]}}
})";

ModelDocument model() { return parse_epjson(kModel, "office.epJSON").value(); }

std::string refused(std::string_view pattern) {
  const auto target = find_target(model(), pattern);
  return target ? "" : target.error().message;
}

TEST(ModelDocument, KnowsItsVersion) {
  EXPECT_EQ(model().version, "25.2");
  EXPECT_EQ(parse_epjson("Version,25.2;", "a.idf").error().code, ErrorCode::malformed);
  EXPECT_THAT(parse_epjson("{}", "a.json").error().message, HasSubstr("has no Version object"));
}

TEST(ModelDocument, APatternFindsFieldsWhateverTheCase) {
  EXPECT_EQ(find_target(model(), "lights/*/Watts_per_floor_area")->fields.size(), 2u);
  EXPECT_EQ(find_target(model(), "Lights/shop*/watts_per_floor_area")->fields.size(), 1u);
  EXPECT_EQ(find_target(model(), "Lights/*/fraction_radiant")->fields.size(), 1u);
  EXPECT_EQ(find_target(model(), "Schedule:Compact/Heating/data/1/field")->fields.size(), 1u);
}

TEST(ModelDocument, WhatIsNotThereNamesTheNearest) {
  EXPECT_THAT(refused("Light/*/watts_per_floor_area"),
              HasSubstr("no object of type 'Light'; did you mean 'Lights'?"));
  EXPECT_THAT(refused("Lights/Core light/watts_per_floor_area"),
              HasSubstr("has no Lights called 'Core light'; did you mean 'Core lights'?"));
  EXPECT_THAT(refused("Lights/*/watts_per_floor"),
              HasSubstr("did you mean 'watts_per_floor_area'?"));
  EXPECT_THAT(refused("Lights"), HasSubstr("must have the form Type/Object/field"));
  EXPECT_THAT(refused("Fan:VariableVolume/*/maximum_flow_rate"),
              HasSubstr("is \"Autosize\", not a number; write the number that it stands for"));
  EXPECT_THAT(refused("Schedule:Compact/Heating/data/*/field"), HasSubstr("not a number"));
}

TEST(ModelDocument, ChangesEveryFieldOfATarget) {
  const ModelDocument before = model();
  const Target lights = find_target(before, "Lights/*/watts_per_floor_area").value();
  Json objects = before.objects;
  apply(lights, Change::scale, 0.5, objects);
  EXPECT_EQ(objects["Lights"]["Shop Lights"]["watts_per_floor_area"], 10.0);
  EXPECT_EQ(objects["Lights"]["Core lights"]["watts_per_floor_area"], 5.0);
  apply(lights, Change::add, 2.0, objects);
  EXPECT_EQ(objects["Lights"]["Shop Lights"]["watts_per_floor_area"], 12.0);
  apply(lights, Change::set, 8.0, objects);
  EXPECT_EQ(objects["Lights"]["Core lights"]["watts_per_floor_area"], 8.0);
  EXPECT_EQ(objects["Lights"]["Core lights"]["fraction_radiant"], 0.4);
}

}  // namespace
}  // namespace recald::energyplus::model_document_test
