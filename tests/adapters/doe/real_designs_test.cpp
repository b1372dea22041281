/// Designs that other programs made.
#include <gtest/gtest.h>

#include <filesystem>

#include "adapters/doe/design_folder.hpp"
#include "adapters/doe/metamodel_file.hpp"
#include "tests/support/data_folders.hpp"

namespace recald::doe {
namespace {

TEST(SeedcaseFolder, IsRead) {
  const auto folder = testing::own_data("seedcase");
  const auto design = read_design_folder(folder);
  ASSERT_TRUE(design) << design.error().message;
  EXPECT_EQ(design->parameters.size(), 6U);
  EXPECT_EQ(design->outputs.rows(), 200);
  EXPECT_EQ(design->outputs.cols(), 48);
  EXPECT_TRUE(design->notes.empty());
  const auto measured = read_measurements(folder / "measurements.csv", *design);
  ASSERT_TRUE(measured) << measured.error().message;
  EXPECT_EQ(measured->table.months.size(), 24U);
  EXPECT_TRUE(measured->notes.empty());
  const auto screening = read_design_folder(folder, "screen");
  ASSERT_TRUE(screening) << screening.error().message;
  EXPECT_EQ(screening->parameters.size(), 25U);
  const auto terms = read_metamodel(folder / "metamodel.csv");
  ASSERT_TRUE(terms) << terms.error().message;
  EXPECT_EQ(terms->size(), 50U);
}

TEST(RealDesigns, ALaboratoryInADynamicSimulation) {
  const auto folder = testing::others_data("dynamic_doe/campus_lab/design");
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no data in " << folder;
  const auto design = read_design_folder(folder);
  ASSERT_TRUE(design) << design.error().message;
  EXPECT_EQ(design->parameters.size(), 26U);
  EXPECT_EQ(design->months.size(), 24U);
  EXPECT_EQ(design->inputs.months.size(), 36U);
  EXPECT_EQ(design->output_names.size(), 6U);
  EXPECT_TRUE(design->notes.empty());
  const auto measured = read_measurements(folder / "measurements_m1.csv", *design);
  ASSERT_TRUE(measured) << measured.error().message;
  EXPECT_EQ(measured->table.months.size(), 36U);
}

}  // namespace
}  // namespace recald::doe
