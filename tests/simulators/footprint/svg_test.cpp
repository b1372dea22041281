#include "simulators/footprint/svg.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "tests/simulators/footprint/well_formed.hpp"

namespace recald::simulators::svg_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

TEST(Svg, EscapesWhatXmlReserves) {
  EXPECT_EQ(escape_xml("a < b & \"c\" > 'd' m²"),
            "a &lt; b &amp; &quot;c&quot; &gt; &#39;d&#39; m²");
}

TEST(Svg, CountsALetterOfTwoBytesOnce) {
  EXPECT_DOUBLE_EQ(text_width("m²", 10.0), text_width("ma", 10.0));
  EXPECT_GT(text_width("W", 10.0), text_width("i", 10.0));
}

TEST(Svg, WrapsAtWordsAndLeavesLongOnesWhole) {
  const double line = text_width("aaaa aaaa", 10.0);

  EXPECT_THAT(wrap_text("aaaa aaaa aaaa", 10.0, line), ElementsAre("aaaa aaaa", "aaaa"));
  EXPECT_THAT(wrap_text("aaaa aaaa aaaa", 10.0, 0.99 * line), ElementsAre("aaaa", "aaaa", "aaaa"));
  EXPECT_THAT(wrap_text("aa aaaaaaaaaaaaaaaa  aa ", 10.0, line),
              ElementsAre("aa", "aaaaaaaaaaaaaaaa", "aa"));
  EXPECT_THAT(wrap_text("  ", 10.0, line), IsEmpty());
}

TEST(Svg, WritesSignsAndNoMinusZero) {
  EXPECT_EQ(signed_number(1.25, 1), "+1.2");
  EXPECT_EQ(signed_number(-0.44, 1), "\u22120.4");
  EXPECT_EQ(signed_number(-0.04, 1), "0");
  EXPECT_EQ(signed_number(0.0, 2), "0");
}

// 1 px right and 1 px up, then half a pixel left and down again, in tenths of a pixel.
TEST(Svg, WritesCurvesAsSteps) {
  Svg svg(20, 20, "curve");
  svg.curve(std::array<Point, 3>{{{0.0, 2.0}, {1.0, 1.0}, {0.5, 2.0}}}, {.width = 1.5});

  EXPECT_THAT(svg.finished(), HasSubstr("d=\"M0 20l10-10-5 10\" transform=\"scale(.1)\""));
  EXPECT_THAT(svg.finished(), HasSubstr("stroke-width=\"15\""));
}

// Steps of 0.04 px would be lost one by one: rounding must not add up.
TEST(Svg, CurvesEndWhereTheyShould) {
  std::vector<Point> points;
  for (int i = 0; i <= 100; ++i) points.push_back({0.04 * i, 0.0});
  Svg svg(20, 20, "curve");
  svg.curve(points, {});

  const std::string text = svg.finished();
  const auto steps = text.find('l', text.find("M0 0")) + 1;
  int x = 0;
  const std::string path = text.substr(steps, text.find('"', steps) - steps);
  std::size_t at = 0;
  for (int i = 0; i < 100; ++i) {
    std::size_t read = 0;
    x += std::stoi(path.substr(at), &read);
    at += read;
    EXPECT_EQ(std::stoi(path.substr(at), &read), 0);
    at += read;
  }
  EXPECT_EQ(x, 40);
}

TEST(Svg, OnePointIsNoCurve) {
  Svg svg(20, 20, "curve");
  svg.curve(std::array<Point, 1>{{{0.0, 2.0}}}, {});
  EXPECT_THAT(svg.finished(), Not(HasSubstr("<path")));
}

TEST(Svg, IsPlainXmlOnItsOwnGround) {
  Svg svg(200, 100, "Rooms < 20 & \"more\"");
  svg.rectangle({1, 2, 3, 4}, "#123456");
  svg.line({0, 0}, {10, 10}, {.dashed = true});
  svg.boxes(std::array<Box, 1>{{{1, 2, 3, 4}}}, "#123456");
  svg.text({5, 5}, "a & b", {.anchor = Anchor::end, .bold = true});

  const std::string text = svg.finished();
  EXPECT_TRUE(is_plain_xml(text));
  EXPECT_THAT(text, HasSubstr("<title>Rooms &lt; 20 &amp; &quot;more&quot;</title>"));
  EXPECT_THAT(text, HasSubstr("rx=\"8\" fill=\"#ffffff\""));
}

TEST(Svg, TheTestKnowsBadXml) {
  EXPECT_FALSE(is_plain_xml("<a><b></a></b>"));
  EXPECT_FALSE(is_plain_xml("<a>"));
  EXPECT_FALSE(is_plain_xml("<a>x & y</a>"));
  EXPECT_FALSE(is_plain_xml("<a href=\"x\"/>"));
  EXPECT_FALSE(is_plain_xml("<a b=\"c/>"));
  EXPECT_TRUE(is_plain_xml("<a><b c=\"d\"/>x &amp; y</a>"));
}

}  // namespace
}  // namespace recald::simulators::svg_test
