#include "adapters/doe/metamodel_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>

#include "tests/support/temporary_folder.hpp"

namespace recald::doe {
namespace {

using recald::testing::TemporaryFolder;
using recald::testing::write_text;

class MetamodelFile : public ::testing::Test {
 protected:
  Result<std::vector<model::metamodel::NamedCoefficient>> read(const std::string& text) {
    write_text(folder_ / "metamodel.csv", text);
    return read_metamodel(folder_ / "metamodel.csv");
  }

  TemporaryFolder folder_;
};

TEST_F(MetamodelFile, ReadsTermsAsRWritesThem) {
  const auto terms = read("term,coef\n(Intercept),0.5\n\"rh\",-1e-3\nrh:out,2\nt_cool^2,3\n");
  ASSERT_TRUE(terms) << terms.error().message;
  ASSERT_EQ(terms->size(), 4U);
  EXPECT_EQ((*terms)[0].term, "(Intercept)");
  EXPECT_EQ((*terms)[0].value, 0.5);
  EXPECT_EQ((*terms)[1].term, "rh");
  EXPECT_EQ((*terms)[1].value, -1e-3);
  EXPECT_EQ((*terms)[2].term, "rh:out");
  EXPECT_EQ((*terms)[3].term, "t_cool^2");
}

TEST_F(MetamodelFile, SaysWhatIsWrong) {
  const std::string head = "term,coef\n";
  const std::vector<std::pair<std::string, std::string>> faults = {
      {head, " has no term; it needs a row for each"},
      {"name,coef\n", ": column 'term' is missing; the file has name and coef"},
      {head + "a,b\n", ":2: column 'coef' is 'b'; write a number with a dot, such as 12.5"},
      {head + "a,\n", ":2: column 'coef' is blank"},
      {head + ",1\n", ":2: column 'term' is blank"},
      {head + "a:b,1\na:b,2\n", ":3: term 'a:b' comes twice"},
  };
  for (const auto& [text, sentence] : faults) {
    const auto terms = read(text);
    ASSERT_FALSE(terms) << text;
    EXPECT_THAT(terms.error().message, ::testing::EndsWith("metamodel.csv'" + sentence)) << text;
  }
}

}  // namespace
}  // namespace recald::doe
