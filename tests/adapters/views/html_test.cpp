#include "adapters/views/frame/html.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace recald::views {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using namespace std::string_literals;

TEST(Escape, LeavesNoMarkup) {
  EXPECT_EQ(escape("a < b & \"c\" > 'd'"), "a &lt; b &amp; &quot;c&quot; &gt; &#39;d&#39;");
  EXPECT_EQ(escape("Zürich 20 °C"), "Zürich 20 °C");
  EXPECT_EQ(escape("a\0b"s), "a\xEF\xBF\xBD"s + "b");
}

TEST(Html, EscapesTextButNotMarkup) {
  Html html;
  html.markup("<p>").text("<b>").markup("</p>").element("h2", "1 < 2", "title");
  EXPECT_EQ(html.str(), "<p>&lt;b&gt;</p><h2 class=\"title\">1 &lt; 2</h2>\n");
}

TEST(Table, MarksHeadsRowsAndNumbers) {
  Table table("Use <kWh>");
  table.column_groups({{"", 1}, {"Energy", 1}}).columns({"Month", "kWh"});
  table.group("Steam").row({{"Jan"}, {"1,200", "number"}});
  Html html;

  table.write(html);

  EXPECT_THAT(html.str(), HasSubstr("<p class=\"caption\">Use &lt;kWh&gt;</p>"));
  EXPECT_THAT(html.str(), HasSubstr("<th scope=\"colgroup\" colspan=\"1\">Energy</th>"));
  EXPECT_THAT(html.str(), HasSubstr("<th scope=\"col\">Month</th>"));
  EXPECT_THAT(html.str(), HasSubstr("<th scope=\"col\" class=\"number\">kWh</th>"));
  EXPECT_THAT(html.str(), HasSubstr("class=\"group\" colspan=\"2\">Steam</th>"));
  EXPECT_THAT(html.str(), HasSubstr("<th scope=\"row\">Jan</th><td class=\"number\">1,200</td>"));
}

TEST(Table, NamesTheColumnAtEachCellWhereAsked) {
  Table table("Meters");
  table.with_labels().columns({"Meter", "Load <kW>"}).row({{"main"}, {"12", "number"}});
  Html html;
  table.write(html);
  EXPECT_THAT(html.str(), HasSubstr("<table class=\"labelled\">"));
  EXPECT_THAT(html.str(), HasSubstr("<th scope=\"row\">main</th><td class=\"number\" "
                                    "data-label=\"Load &lt;kW&gt;\">12</td>"));
}

TEST(Figure, CarriesItsTableAndADescriptionForThoseWhoDoNotSeeIt) {
  Html html;
  write_figure(html,
               {.kind = "peaks",
                .index = 2,
                .title = "Peaks",
                .description = "A \"hidden\" text",
                .caption = "How to read",
                .size = "small"},
               Table("Numbers").columns({"Month"}).row({{"Jan"}}));
  EXPECT_THAT(html.str(), HasSubstr("data-figure=\"peaks\" data-index=\"2\""));
  EXPECT_THAT(html.str(), HasSubstr("aria-label=\"A &quot;hidden&quot; text\""));
  EXPECT_THAT(html.str(), HasSubstr("<th scope=\"row\">Jan</th>"));
  EXPECT_THAT(html.str(), Not(HasSubstr("\"hidden\"")));
}

}  // namespace
}  // namespace recald::views
