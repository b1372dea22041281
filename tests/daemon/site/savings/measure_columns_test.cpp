#include "daemon/site/savings/measure_columns.hpp"

#include <gmock/gmock.h>

namespace recald::daemon {
namespace {

using model::ChangeKind;
using savings::Change;
using savings::Measure;
using ::testing::ElementsAre;
using ::testing::SizeIs;

Change change(std::string parameter, ChangeKind kind, double by) {
  return {std::move(parameter), {}, kind, {by, by, by}};
}

/// A site file's own lighting factor and cooling set-point.
ModelConfig two_parameters() {
  ModelConfig model;
  model.parameters = {{.name = "lighting", .prior = {}, .source = {}, .targets = {"Lights/*/x"}},
                      {.name = "cooling_setpoint", .prior = {}, .source = {}}};
  return model;
}

std::vector<double> row(const Eigen::MatrixXd& rows) {
  return {rows.data(), rows.data() + rows.size()};
}

TEST(MeasureColumns, ParametersOfTheSiteAreChangedInTheirOwnColumns) {
  const std::vector<Measure> measures{
      {"Lamps", {}, {change("lighting", ChangeKind::scale, 0.5)}},
      {"Warmer", {}, {change("cooling_setpoint", ChangeKind::add, 2.0)}}};
  const MeasureColumns columns{two_parameters(), measures};
  EXPECT_TRUE(columns.beside().empty());
  EXPECT_THAT(row(columns.changed(Eigen::RowVector2d{1.2, 24.0}, std::vector{1.0, 23.0})),
              ElementsAre(0.6, 26.0));
}

TEST(MeasureColumns, WhatTwoMeasuresSetIsSetOnce) {
  const std::vector<Measure> measures{
      {"Chiller", {}, {change("cooling_cop", ChangeKind::set, 4.0)}},
      {"Another", {}, {change("cooling_cop", ChangeKind::set, 4.0)}}};
  const MeasureColumns columns{two_parameters(), measures};
  ASSERT_THAT(columns.beside(), SizeIs(1));
  EXPECT_THAT(row(columns.changed(Eigen::RowVector2d{1.0, 24.0}, std::vector{1.0, 24.0, 3.0})),
              ElementsAre(1.0, 24.0, 4.0));
}

TEST(MeasureColumns, TargetsAreColumnsOfTheirOwn) {
  const Change pumps{
      "", {"Pump:VariableSpeed/*/design_pump_head"}, ChangeKind::scale, {0.8, 0.8, 0.8}};
  const std::vector<Measure> measures{{"Pumps", {}, {pumps}}, {"More", {}, {pumps}}};
  const MeasureColumns columns{two_parameters(), measures};
  ASSERT_THAT(columns.beside(), SizeIs(2));
  EXPECT_EQ(columns.beside().front().targets, pumps.targets);
  EXPECT_THAT(row(columns.changed(Eigen::RowVector2d{1.0, 24.0}, std::vector{1.0, 24.0, 1.0, 1.0})),
              ElementsAre(1.0, 24.0, 0.8, 0.8));
}

TEST(MeasureColumns, ExtentsThatAreNotKnownComeBehindTheParameters) {
  Change lamps = change("lighting", ChangeKind::scale, 0.0);
  lamps.by = {0.5, 0.6, 0.8};
  Change controls = lamps;
  controls.by = {0.8, 0.9, 1.0};
  const std::vector<Measure> measures{
      {"Lamps", {}, {change("cooling_setpoint", ChangeKind::set, 25.0), lamps}},
      {"Controls", {}, {controls}}};
  const MeasureColumns columns{two_parameters(), measures};
  ASSERT_THAT(columns.extents(), SizeIs(2));
  EXPECT_NE(columns.extents()[0].name, columns.extents()[1].name);
  const Eigen::RowVector4d theta{1.0, 24.0, 0.5, 0.8};
  EXPECT_THAT(row(columns.changed(theta, std::vector{1.0, 24.0})), ElementsAre(0.4, 25.0));
}

TEST(MeasureColumns, AQuantityOfTheLibraryStaysPossible) {
  const std::vector<Measure> measures{
      {"Off", {}, {change("lighting_power", ChangeKind::add, -100.0)}}};
  const MeasureColumns columns{two_parameters(), measures};
  EXPECT_THAT(row(columns.changed(Eigen::RowVector2d{1.0, 24.0}, std::vector{1.0, 24.0, 10.0})),
              ElementsAre(1.0, 24.0, 0.0));
}

TEST(MeasureColumns, SeveralMeasuresAreAskedForAloneAndTogether) {
  EXPECT_THAT(alone_and_together({Measure{}}), SizeIs(1));
  const std::vector<Measure> three(3);
  const auto all = alone_and_together(three);
  ASSERT_THAT(all, SizeIs(4));
  EXPECT_THAT(all.back(), SizeIs(3));
}

}  // namespace
}  // namespace recald::daemon
