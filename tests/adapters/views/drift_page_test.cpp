#include "adapters/views/drift/drift_page.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/adapters/views/page_text.hpp"
#include "tests/adapters/views/sample_drift.hpp"

namespace recald::views {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(DriftPage, SaysWhatHasChangedHowSureAndWhatWasDone) {
  const std::string page = own_markup(render_drift(sample_drift()));
  EXPECT_THAT(page, HasSubstr("▲ Something has changed"));
  EXPECT_THAT(page, HasSubstr("Chilled water is more than forecast since Jul 2022"));
  EXPECT_THAT(page, HasSubstr("<th scope=\"row\">outdoor_airflow is 6.2 m3/s since</th><td "
                              "class=\"number\">91.0\u00a0%</td>"));
  EXPECT_THAT(page, HasSubstr("under 0.1\u00a0%"));
  EXPECT_THAT(page, HasSubstr("The model has been learnt anew."));
  EXPECT_THAT(page, HasSubstr("gas reads about 1/28.2"));
  EXPECT_THAT(page, HasSubstr("<th scope=\"row\">Jul 2022</th><td>Begun anew.</td>"));
}

TEST(DriftPage, HoldsEveryFiguresNumbersAsATable) {
  const std::string page = own_markup(render_drift(sample_drift()));
  EXPECT_EQ(occurrences(page, "data-figure="), 3u);  // two outputs, one parameter
  EXPECT_EQ(occurrences(page, "<summary>The data of this figure</summary>"), 3u);
  // Learnt from, not forecast; then forecast.
  EXPECT_THAT(page, HasSubstr("<th scope=\"row\">Jan 2020</th><td class=\"number\">–</td>"));
  EXPECT_THAT(page, HasSubstr("<th scope=\"row\">Jan 2021</th><td class=\"number\">540.0</td><td "
                              "class=\"number\">600.0</td>"));
}

TEST(DriftPage, QuietSitesSaySoAndNamesAreNoMarkup) {
  const std::string page = own_markup(render_drift(quiet_drift()));
  EXPECT_THAT(page, HasSubstr("✓ No alarm"));
  EXPECT_THAT(page, Not(HasSubstr("<b>Steam")));
  EXPECT_THAT(page, Not(HasSubstr("id=\"believed\"")));
  const auto figures = nlohmann::json::parse(drift_figure_json(quiet_drift()));
  EXPECT_EQ(figures["forecasts"][0]["label"], "</script><b>Steam</b>");
  EXPECT_TRUE(figures["forecasts"][0]["months"][20]["measured"].is_null());
  EXPECT_TRUE(figures["forecasts"][0]["months"][0]["q50"].is_null());
}

TEST(DriftPage, SameDataSameBytes) {
  EXPECT_EQ(render_drift(sample_drift()), render_drift(sample_drift()));
}

}  // namespace
}  // namespace recald::views
