#include "adapters/doe/priors_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>

#include "tests/support/temporary_folder.hpp"

namespace recald::doe {
namespace {

using recald::testing::TemporaryFolder;
using recald::testing::write_text;

class PriorsFile : public ::testing::Test {
 protected:
  Result<std::vector<Parameter>> read(const std::string& text) {
    write_text(folder_ / "priors.csv", text);
    return read_priors(folder_ / "priors.csv");
  }
  /// The message without the file's path.
  std::string fault(const std::string& text) {
    const auto read_back = read(text);
    if (read_back) return "no fault";
    std::string message = read_back.error().message;
    const std::string path = (folder_ / "priors.csv").string();
    return message.replace(message.find(path), path.size(), "FILE");
  }

  TemporaryFolder folder_;
};

TEST_F(PriorsFile, ReadsEveryDistribution) {
  const auto parameters = read(
      "parameter,unit,min,mode,max,distribution,sd,meaning\n"
      "t_cool,degC,20,23.5,28,,,\"set-point, cooling\"\n"
      "ela,cm2/m2,0.26,,4.94,uniform,,\n"
      "u_wall,W/m2K,0.1,0.4,,truncated_normal,0.1,\n"
      "people,person/m2,,0.05,,log_normal,0.5,\n");
  ASSERT_TRUE(parameters) << parameters.error().message;
  ASSERT_EQ(parameters->size(), 4U);
  EXPECT_EQ((*parameters)[0].name, "t_cool");
  EXPECT_EQ((*parameters)[0].unit, "degC");
  EXPECT_EQ((*parameters)[0].prior, Prior(20.0, 23.5, 28.0));
  EXPECT_EQ((*parameters)[1].prior, Prior(UniformPrior{0.26, 4.94}));
  EXPECT_EQ((*parameters)[2].prior, Prior(TruncatedNormalPrior{0.4, 0.1, 0.1}));
  EXPECT_EQ((*parameters)[3].prior, Prior(LogNormalPrior{0.05, 0.5}));
}

TEST_F(PriorsFile, WrittenParametersComeBackTheSame) {
  const std::vector<Parameter> parameters = {{"a", "m3/s, at design", Prior(0.1, 1.0 / 3.0, 1.0)},
                                             {"b", "the \"unit\"", Prior(UniformPrior{-1.0, 2.0})},
                                             {"c", "-", Prior(TruncatedNormalPrior{1.0, 0.1, 0.7})},
                                             {"d", "", Prior(LogNormalPrior{2.0, 0.3, 0.0, 9.0})}};
  const auto back = read(priors_csv(parameters));
  ASSERT_TRUE(back) << back.error().message;
  ASSERT_EQ(back->size(), parameters.size());
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    EXPECT_EQ((*back)[j].name, parameters[j].name);
    EXPECT_EQ((*back)[j].unit, parameters[j].unit);
    EXPECT_EQ((*back)[j].prior, parameters[j].prior);
  }
}

TEST_F(PriorsFile, SaysWhatIsWrong) {
  const std::string head = "parameter,unit,min,mode,max,distribution,sd\n";
  const std::vector<std::pair<std::string, std::string>> faults = {
      {"", "'FILE': the file is empty; its first line has to name the columns"},
      {head, "'FILE' names no parameter; it needs a row for each"},
      {"parameter;unit;min;mode;max\n", "'FILE': separate columns by commas, not semicolons"},
      {"parameter,unit,min,made,max\na,,0,1,2\n",
       "'FILE': column 'mode' is missing (is it 'made'?); the file has parameter, unit, min, made "
       "and max"},
      {"parameter,unit,min,mode,max,max\n", "'FILE': column 'max' comes twice"},
      {"parameter,unit,min,mode,max,\n", "'FILE': column 6 has no name"},
      {head + "a,,0,1\n", "'FILE':2: 4 fields instead of 7; each row needs one field a column"},
      {head + "a,\"m,0,1,2,,\n", "'FILE':2: a quote is not closed"},
      {head + ",,0,1,2,,\n", "'FILE':2: the parameter has no name"},
      {head + "a,,0,1,2,,\na,,0,1,3,,\n", "'FILE':3: parameter 'a' comes twice"},
      {head + "a,,0,1,high,,\n",
       "'FILE':2: column 'max' is 'high'; write a number with a dot, such as 12.5"},
      {head + "a,,0,,2,,\n", "'FILE':2: parameter 'a': a triangular prior needs min, mode and max"},
      {head + "a,,,1,2,uniform,\n", "'FILE':2: parameter 'a': a uniform prior needs min and max"},
      {head + "a,,0,1,2,normal,\n",
       "'FILE':2: parameter 'a': no prior has the distribution 'normal'; known are triangular, "
       "uniform, truncated_normal and log_normal"},
      {head + "a,,0,1,2,log_normal,\n",
       "'FILE':2: parameter 'a': a log_normal prior needs mode (its median) and sd (of the "
       "logarithm)"},
      {"parameter,unit,min,mode,max,distribution\na,,0,1,2,truncated_normal\n",
       "'FILE':2: parameter 'a': a truncated_normal prior needs mode (its centre) and sd"},
      {head + "a,,0,3,2,,\n",
       "'FILE':2: parameter 'a': a triangular prior needs min <= mode <= max and min < max, but "
       "min = 0, mode = 3, max = 2"},
      {head + "a,,100,1,101,truncated_normal,0.1\n",
       "'FILE':2: parameter 'a': a truncated normal prior has next to no probability (0) between "
       "its ends, min = 100 and max = 101, so recald cannot draw from it; move the ends or the "
       "centre"},
  };
  for (const auto& [text, sentence] : faults) EXPECT_EQ(fault(text), sentence) << text;
}

TEST_F(PriorsFile, AFileThatIsAbsentIsNotFound) {
  const auto read_back = read_priors(folder_ / "nowhere.csv");
  ASSERT_FALSE(read_back);
  EXPECT_EQ(read_back.error().code, ErrorCode::not_found);
  EXPECT_THAT(read_back.error().message, ::testing::EndsWith("nowhere.csv' does not exist"));
}

TEST_F(PriorsFile, AnUnusablePriorKeepsItsCode) {
  EXPECT_EQ(read("parameter,unit,min,mode,max\na,,0,3,2\n").error().code, ErrorCode::invalid_value);
}

}  // namespace
}  // namespace recald::doe
