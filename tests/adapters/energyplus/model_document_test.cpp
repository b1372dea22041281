#include "adapters/energyplus/model/model_document.hpp"

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
  EXPECT_EQ(find_target(model(), "Schedule:Compact/Heating/data/*/field")->fields.size(), 2u);
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
  EXPECT_THAT(refused("Schedule:Compact/Heating/data/0/field"), HasSubstr("not a number"));
}

TEST(ModelDocument, ChangesEveryFieldOfATarget) {
  const ModelDocument before = model();
  const Target lights = find_target(before, "Lights/*/watts_per_floor_area").value();
  Json objects = before.objects;
  apply(lights, ChangeKind::scale, 0.5, objects);
  EXPECT_EQ(objects["Lights"]["Shop Lights"]["watts_per_floor_area"], 10.0);
  EXPECT_EQ(objects["Lights"]["Core lights"]["watts_per_floor_area"], 5.0);
  apply(lights, ChangeKind::add, 2.0, objects);
  EXPECT_EQ(objects["Lights"]["Shop Lights"]["watts_per_floor_area"], 12.0);
  apply(lights, ChangeKind::set, 8.0, objects);
  EXPECT_EQ(objects["Lights"]["Core lights"]["watts_per_floor_area"], 8.0);
  EXPECT_EQ(objects["Lights"]["Core lights"]["fraction_radiant"], 0.4);
}

TEST(ModelDocument, AChangeIsOfTheQuantityHoweverTheFieldHasIt) {
  const ModelDocument before = model();
  Target target = find_target(before, "Lights/Shop*/watts_per_floor_area").value();
  const auto changed = [&](Sense sense, ChangeKind change, double value) {
    Json objects = before.objects;
    target.sense = sense;
    apply(target, change, value, objects);
    return objects["Lights"]["Shop Lights"]["watts_per_floor_area"].get<double>();
  };
  EXPECT_DOUBLE_EQ(changed(Sense::reciprocal, ChangeKind::scale, 0.5), 40.0);
  EXPECT_DOUBLE_EQ(changed(Sense::reciprocal, ChangeKind::set, 0.1), 10.0);
  EXPECT_DOUBLE_EQ(changed(Sense::complement, ChangeKind::scale, 2.0), 1.0 + 2.0 * 19.0);
  target.most = 25.0;
  EXPECT_DOUBLE_EQ(changed(Sense::direct, ChangeKind::scale, 2.0), 25.0);
}

}  // namespace
}  // namespace recald::energyplus::model_document_test
