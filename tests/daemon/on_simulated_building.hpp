/// Tests on three years of a simulated building, faults and all (seed 7): made once for a suite,
/// which runs as a whole then (WHOLE in its recald_test), and copied for each test.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <memory>

#include "simulators/scenario/building_feed.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::daemon::testing {

class OnSimulatedBuilding : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    building_ = std::make_unique<recald::testing::TemporaryFolder>();
    const auto written =
        simulators::write_building_feed({.out = building_->path(), .scenario = {}, .seed = 7});
    ASSERT_TRUE(written.has_value()) << written.error().message;
  }
  static void TearDownTestSuite() { building_.reset(); }
  void SetUp() override {
    std::filesystem::copy(building_->path(), folder_.path(),
                          std::filesystem::copy_options::recursive);
  }

  recald::testing::TemporaryFolder folder_;
  inline static std::unique_ptr<recald::testing::TemporaryFolder> building_;
};

}  // namespace recald::daemon::testing
