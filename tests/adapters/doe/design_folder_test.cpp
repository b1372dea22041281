#include "adapters/doe/design_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <ostream>

#include "tests/support/sample_site.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::doe {
namespace {

using recald::testing::edited;
using recald::testing::TemporaryFolder;
using recald::testing::write_text;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// Three runs, two parameters, three months of which two are in the design, two outputs:
/// heat = 100 run + month, peak = 1000 + the same.
class Folder : public ::testing::Test {
 protected:
  Folder() {
    files_["priors.csv"] = "parameter,unit,min,mode,max\nt_cool,degC,20,24,28\nela,cm2,0,1,4\n";
    files_["doe_inputs.csv"] = "run,ela,t_cool\n7,1,21\n3,2,25.5\n5,3,24\n";
    files_["doe_outputs.csv"] =
        "month,run,heat,peak\n2021-02,3,302,1302\n2021-01,3,301,1301\n2021-01,7,701,1701\n"
        "2021-02,7,702,1702\n2021-01,5,501,1501\n2021-02,5,502,1502\n";
    files_["inputs.csv"] = "month,drybulb,rh\n2021-03,9,60\n2021-01,1,80\n2021-02,3,70\n";
    files_["measurements.csv"] =
        "month,year,peak,heat\n2021-01,2021,1400,400\n2021-03,2021,1100,\n2021-02,2021,,390\n";
  }

  void change(const std::string& file, std::string_view from, std::string_view to) {
    files_[file] = edited(files_[file], from, to);
  }
  Result<DesignFolder> read() {
    write();
    return read_design_folder(folder_.path());
  }
  Result<Measurements> measure() {
    const auto design = read();
    if (!design) return tl::unexpected(design.error());
    return read_measurements(folder_ / "measurements.csv", *design);
  }
  /// The only fault of `read`, without the folder's path.
  std::string fault() { return without_path(read()); }
  std::string measurement_fault() { return without_path(measure()); }

  std::map<std::string, std::string> files_;
  TemporaryFolder folder_;

 private:
  void write() const {
    for (const auto& [name, text] : files_) write_text(folder_ / name, text);
  }
  template <class T>
  std::string without_path(const Result<T>& result) const {
    if (result) return "no fault";
    std::string message = result.error().message;
    const std::string path = folder_.path().string();
    const std::size_t place = message.find(path + "/");
    if (place != std::string::npos) return message.erase(place, path.size() + 1);
    return message.replace(message.find(path), path.size(), "DIR");
  }
};

TEST_F(Folder, IsReadInTheOrderOfItsFiles) {
  const auto design = read();
  ASSERT_TRUE(design) << design.error().message;
  ASSERT_EQ(design->parameters.size(), 2U);
  EXPECT_EQ(design->parameters[1].name, "ela");
  EXPECT_THAT(design->runs, ElementsAre(7, 3, 5));
  Eigen::MatrixXd theta(3, 2);
  theta << 21, 1, 25.5, 2, 24, 3;
  EXPECT_EQ(design->theta, theta);
  EXPECT_THAT(design->output_names, ElementsAre("heat", "peak"));
  ASSERT_EQ(design->months.size(), 2U);
  EXPECT_EQ(design->months[0].text(), "2021-01");
  Eigen::MatrixXd outputs(3, 4);
  outputs << 701, 702, 1701, 1702, 301, 302, 1301, 1302, 501, 502, 1501, 1502;
  EXPECT_EQ(design->outputs, outputs);
  EXPECT_THAT(design->inputs.names, ElementsAre("drybulb", "rh"));
  EXPECT_EQ(design->inputs.months[2].text(), "2021-03");
  Eigen::MatrixXd covered(2, 2);
  covered << 1, 80, 3, 70;
  EXPECT_EQ(design->design_inputs(), covered);
  EXPECT_THAT(design->notes, IsEmpty());
}

TEST_F(Folder, MonthsMayBeNumbers) {
  files_["doe_outputs.csv"] = "run,month,heat\n3,1,1\n3,2,2\n7,2,3\n7,1,4\n5,1,5\n5,2,6\n";
  files_["inputs.csv"] = "month,drybulb\n01,1\n2,3\n";
  const auto design = read();
  ASSERT_TRUE(design) << design.error().message;
  EXPECT_EQ(design->months[1].text(), "2");
}

TEST_F(Folder, MayHoldASecondDesign) {
  files_["screen_priors.csv"] = "parameter,unit,min,mode,max\na,,0,1,2\n";
  files_["screen_inputs.csv"] = "run,a\n1,0.5\n2,1.5\n";
  files_["screen_outputs.csv"] =
      "run,month,heat\n1,2021-01,1\n1,2021-02,2\n2,2021-01,3\n"
      "2,2021-02,4\n";
  ASSERT_TRUE(read());
  const auto design = read_design_folder(folder_.path(), "screen");
  ASSERT_TRUE(design) << design.error().message;
  EXPECT_EQ(design->parameters[0].name, "a");
  EXPECT_EQ(design->outputs(1, 1), 4.0);
}

TEST_F(Folder, RunsOutsideTheirPriorsAreNamed) {
  change("doe_inputs.csv", "7,1,21", "7,1,19");
  const auto design = read();
  ASSERT_TRUE(design);
  EXPECT_THAT(design->notes,
              ElementsAre("t_cool: 1 of 3 runs lie outside its prior, 20 to 28 (run 7 has 19): the "
                          "design was made for other priors."));
}

TEST_F(Folder, AMissingLineEndIsSaid) {
  files_["inputs.csv"].pop_back();
  const auto design = read();
  ASSERT_TRUE(design);
  ASSERT_EQ(design->notes.size(), 1U);
  EXPECT_THAT(design->notes[0],
              ::testing::EndsWith("inputs.csv' ends without a line end: if the file was cut, its "
                                  "last number is wrong."));
}

TEST_F(Folder, AnAbsentFolderIsNotFound) {
  const auto design = read_design_folder("/nonexistent/design");
  ASSERT_FALSE(design);
  EXPECT_EQ(design.error().code, ErrorCode::not_found);
  EXPECT_EQ(design.error().message, "the design folder '/nonexistent/design' does not exist");
}

TEST_F(Folder, EveryFileHasToBeThere) {
  for (const char* file : {"priors.csv", "doe_inputs.csv", "doe_outputs.csv", "inputs.csv"}) {
    ASSERT_TRUE(read());
    std::filesystem::remove(folder_ / file);
    const auto design = read_design_folder(folder_.path());
    ASSERT_FALSE(design) << file;
    EXPECT_EQ(design.error().code, ErrorCode::not_found);
    EXPECT_THAT(design.error().message, ::testing::HasSubstr(file));
  }
}

struct Mistake {
  const char* name;
  const char* file;
  const char* from;
  const char* to;
  const char* sentence;
  friend void PrintTo(const Mistake& mistake, std::ostream* out) { *out << mistake.name; }
};

class FolderMistake : public Folder, public ::testing::WithParamInterface<Mistake> {};

TEST_P(FolderMistake, IsSaidInOneSentence) {
  change(GetParam().file, GetParam().from, GetParam().to);
  EXPECT_EQ(fault(), GetParam().sentence);
}

INSTANTIATE_TEST_SUITE_P(
    Runs, FolderMistake,
    ::testing::Values(
        Mistake{"doe_inputs_csv_lacks_a_parameter", "doe_inputs.csv", "run,ela", "run,elb",
                "'doe_inputs.csv': column 'ela' is missing (is it 'elb'?); the file has run, elb "
                "and t_cool"},
        Mistake{"doe_inputs_csv_lacks_the_run", "doe_inputs.csv", "run,", "Run,",
                "'doe_inputs.csv': column 'run' is missing (is it 'Run'?); the file has Run, ela "
                "and t_cool"},
        Mistake{"doe_inputs_csv_has_a_stray_parameter", "priors.csv", "ela,cm2,0,1,4\n", "",
                "'doe_inputs.csv': column 'ela' is no parameter of the priors file; add its prior "
                "there or remove the column"},
        Mistake{"doe_inputs_csv_has_a_run_twice", "doe_inputs.csv", "5,3,24", "3,3,24",
                "'doe_inputs.csv':4: run 3 comes twice"},
        Mistake{
            "doe_inputs_csv_has_a_word_for_a_number", "doe_inputs.csv", "5,3,24", "5,three,24",
            "'doe_inputs.csv':4: column 'ela' is 'three'; write a number with a dot, such as 12.5"},
        Mistake{"doe_inputs_csv_has_a_blank", "doe_inputs.csv", "5,3,24", "5,,24",
                "'doe_inputs.csv':4: column 'ela' is blank"},
        Mistake{
            "doe_inputs_csv_has_nan", "doe_inputs.csv", "5,3,24", "5,nan,24",
            "'doe_inputs.csv':4: column 'ela' is 'nan'; write a number with a dot, such as 12.5"},
        Mistake{"doe_inputs_csv_has_a_fraction_for_a_run", "doe_inputs.csv", "5,3,24", "5.5,3,24",
                "'doe_inputs.csv':4: column 'run' is '5.5'; write a whole number, such as 17"},
        Mistake{"doe_inputs_csv_has_a_short_row", "doe_inputs.csv", "5,3,24", "5,3",
                "'doe_inputs.csv':4: 2 fields instead of 3; each row needs one field a column"},
        Mistake{"doe_inputs_csv_has_one_run", "doe_inputs.csv", "3,2,25.5\n5,3,24\n", "",
                "'doe_inputs.csv' has 1 runs; a design needs at least 2, and a useful one some 10 "
                "a parameter"},
        Mistake{"doe_inputs_csv_has_a_constant_parameter", "doe_inputs.csv",
                "7,1,21\n3,2,25.5\n5,3,24\n", "7,2,21\n3,2,25.5\n5,2,24\n",
                "'doe_inputs.csv': parameter 'ela' is 2 in every run, so nothing can be learnt of "
                "it; remove it from the design and from the priors"}),
    [](const auto& mistake) { return mistake.param.name; });

INSTANTIATE_TEST_SUITE_P(
    Outputs, FolderMistake,
    ::testing::Values(
        Mistake{"doe_outputs_csv_has_a_column_twice", "doe_outputs.csv", "heat,peak", "heat,heat",
                "'doe_outputs.csv': column 'heat' comes twice"},
        Mistake{"doe_outputs_csv_lacks_a_run", "doe_outputs.csv",
                "2021-01,5,501,1501\n2021-02,5,502,1502\n", "",
                "'doe_outputs.csv' lacks 1 of 3 runs (5); run them, or remove them from the file "
                "of run inputs"},
        Mistake{"doe_outputs_csv_has_a_stray_run", "doe_inputs.csv", "5,3,24\n", "6,3,24\n",
                "'doe_outputs.csv':6: run 5 is not in the file of run inputs; remove its rows or "
                "add it there"},
        Mistake{"doe_outputs_csv_lacks_a_month", "doe_outputs.csv", "2021-02,5,502,1502\n", "",
                "'doe_outputs.csv': run 5 lacks 1 of 2 months (2021-02); every run needs all of "
                "them"},
        Mistake{"doe_outputs_csv_has_a_month_twice", "doe_outputs.csv", "2021-02,5,502",
                "2021-01,5,502", "'doe_outputs.csv':7: run 5 has month 2021-01 twice"},
        Mistake{"doe_outputs_csv_has_a_word_for_a_month", "doe_outputs.csv", "2021-02,5,502",
                "Feb,5,502",
                "'doe_outputs.csv':7: month 'Feb' is neither YYYY-MM nor a number from 0 to 9999"},
        Mistake{"doe_outputs_csv_mixes_kinds_of_months", "doe_outputs.csv", "2021-02,5,502",
                "2,5,502",
                "'doe_outputs.csv' names some months by number and some as YYYY-MM; use one of the "
                "two"},
        Mistake{"doe_outputs_csv_has_a_blank", "doe_outputs.csv", "5,502,", "5,,",
                "'doe_outputs.csv':7: column 'heat' is blank"},
        Mistake{"doe_outputs_csv_has_inf", "doe_outputs.csv", "5,502,", "5,inf,",
                "'doe_outputs.csv':7: column 'heat' is 'inf'; write a number with a dot, such as "
                "12.5"}),
    [](const auto& mistake) { return mistake.param.name; });

INSTANTIATE_TEST_SUITE_P(
    Inputs, FolderMistake,
    ::testing::Values(
        Mistake{"inputs_csv_lacks_a_month", "inputs.csv", "2021-02,3,70\n", "",
                "'inputs.csv' lacks 1 of 2 months of the design (2021-02); its months have to be "
                "written as those of the design and cover them"},
        Mistake{"inputs_csv_has_a_month_twice", "inputs.csv", "2021-02,3,70", "2021-01,3,70",
                "'inputs.csv':4: month 2021-01 comes twice"},
        Mistake{"inputs_csv_has_a_blank", "inputs.csv", "2021-02,3,70", "2021-02,3,",
                "'inputs.csv':4: column 'rh' is blank"},
        Mistake{"inputs_csv_has_a_constant_input", "inputs.csv", "2021-02,3,70", "2021-02,3,80",
                "'inputs.csv': model input 'rh' is 80 in every month of the design, so it explains "
                "nothing; remove the column"},
        Mistake{
            "inputs_csv_has_the_name_of_an_output", "inputs.csv", "month,drybulb,rh",
            "month,drybulb,peak",
            "'DIR': 'peak' is the name of two things among parameters, model inputs and outputs; "
            "rename one of them in its files"}),
    [](const auto& mistake) { return mistake.param.name; });

TEST_F(Folder, ADesignOfOneMonthIsTooShort) {
  files_["doe_outputs.csv"] = "run,month,heat\n3,2021-01,1\n7,2021-01,2\n5,2021-01,3\n";
  EXPECT_EQ(fault(), "'doe_outputs.csv' covers one month only; a design needs at least 2");
}

TEST_F(Folder, AFileNeedsValues) {
  files_["inputs.csv"] = "month\n2021-01\n";
  EXPECT_EQ(fault(), "'inputs.csv' has no column besides month; there is nothing to read");
}

TEST_F(Folder, ManyAbsentRunsAreCounted) {
  for (int run = 10; run < 40; ++run) {
    files_["doe_inputs.csv"] += std::to_string(run) + ",1.5,22\n";
  }
  EXPECT_EQ(fault(),
            "'doe_outputs.csv' lacks 30 of 33 runs (10, 11, 12, 13, 14, 15, 16, 17 and 22 more); "
            "run them, or remove them from the file of run inputs");
}

TEST_F(Folder, MeasurementsStandInTheDesignsOrder) {
  const auto measured = measure();
  ASSERT_TRUE(measured) << measured.error().message;
  EXPECT_THAT(measured->table.names, ElementsAre("heat", "peak"));
  ASSERT_EQ(measured->table.months.size(), 3U);
  const Eigen::MatrixXd& values = measured->table.values;
  EXPECT_EQ(values(0, 0), 400.0);
  EXPECT_EQ(values(0, 1), 1400.0);
  EXPECT_EQ(values(1, 0), 390.0);
  EXPECT_TRUE(std::isnan(values(1, 1)));
  EXPECT_TRUE(std::isnan(values(2, 0)));
  EXPECT_EQ(values(2, 1), 1100.0);
  EXPECT_THAT(measured->notes, IsEmpty());
}

TEST_F(Folder, AnUnmeasuredOutputIsLeftOutInWords) {
  change("measurements.csv", "peak,heat", "peak,hat");
  const auto measured = measure();
  ASSERT_TRUE(measured) << measured.error().message;
  EXPECT_TRUE(measured->table.values.col(0).array().isNaN().all());
  EXPECT_EQ(measured->table.values(0, 1), 1400.0);
  ASSERT_EQ(measured->notes.size(), 1U);
  EXPECT_THAT(measured->notes[0], ::testing::StartsWith("heat is not measured in '"));
  EXPECT_THAT(measured->notes[0], ::testing::EndsWith("measurements.csv' and left out."));
}

TEST_F(Folder, MonthsWithoutInputsAreLeftOutInWords) {
  files_["measurements.csv"] += "2021-04,2021,1000,300\n2021-05,2021,1000,300\n";
  const auto measured = measure();
  ASSERT_TRUE(measured) << measured.error().message;
  EXPECT_EQ(measured->table.months.size(), 3U);
  EXPECT_EQ(measured->table.values.rows(), 3);
  EXPECT_THAT(measured->notes, ElementsAre("Measured months without a row in inputs.csv are left "
                                           "out: 2021-04 and 2021-05."));
}

TEST_F(Folder, MeasurementsThatSayNothingAreRefused) {
  change("measurements.csv", "peak,heat", "peek,hat");
  EXPECT_EQ(measurement_fault(),
            "'measurements.csv' measures no output of the design (heat and peak); its columns are "
            "month, year, peek and hat");
}

TEST_F(Folder, MeasurementsOfOtherMonthsAreRefused) {
  files_["measurements.csv"] = "month,heat\n2021-03,400\n2021-01,\n";
  EXPECT_EQ(measurement_fault(),
            "'measurements.csv' measures no month of the design, 2021-01 to 2021-02, so nothing "
            "can be calibrated");
}

TEST_F(Folder, MeasurementsHaveToBeNumbersOnceAMonth) {
  change("measurements.csv", "1400", "14OO");
  EXPECT_EQ(
      measurement_fault(),
      "'measurements.csv':2: column 'peak' is '14OO'; write a number with a dot, such as 12.5");
  change("measurements.csv", "14OO", "1400");
  change("measurements.csv", "2021-02,2021", "2021-01,2021");
  EXPECT_EQ(measurement_fault(), "'measurements.csv':4: month 2021-01 comes twice");
}

}  // namespace
}  // namespace recald::doe
