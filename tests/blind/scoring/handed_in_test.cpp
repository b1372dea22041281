#include "tests/blind/scoring/handed_in.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/support/temporary_folder.hpp"

namespace recald::blind {
namespace {

using recald::testing::TemporaryFolder;
using recald::testing::write_text;
using ::testing::HasSubstr;

const EffectClasses kCatalogue{{"fouling", "plant"}, {"vacancy", "schedules"}};

constexpr const char* kTruth = R"({
 "plain": {"archetype": "retail", "weather": "newyork", "effects": {}},
 "dirty": {"archetype": "clinic", "weather": "sydney", "effects": {
   "fouling": {"strength": 0.4, "unit": "share", "from": "2021-03-01",
               "share_of_meter": {"electricity": 0.05}, "moved_share": {"electricity": 0.06}}}},
 "both": {"archetype": "clinic", "weather": "sydney", "effects": {
   "fouling": {"strength": 0.4, "unit": "share"}, "vacancy": {"strength": 0.5, "unit": "share"}}},
 "other": {"archetype": "strip", "weather": "tucson", "effects": {
   "aquarium": {"strength": 1, "unit": "m3"}}}
})";

TEST(HandedIn, BecomesAnswersThatTheScorerReads) {
  const TemporaryFolder folder;
  write_text(folder / "truth.json", kTruth);
  const auto count =
      write_handed_in(folder / "truth.json", "energyplus", kCatalogue, folder / "answers");
  ASSERT_TRUE(count.has_value()) << count.error().message;
  EXPECT_EQ(*count, 4u);
  const auto key = read_answers(folder / "answers");
  ASSERT_TRUE(key.has_value()) << key.error().message;
  EXPECT_EQ(key->at("plain").block, Block::no_effect);
  EXPECT_EQ(key->at("plain").world, "energyplus");
  EXPECT_EQ(key->at("dirty").block, Block::single);
  EXPECT_EQ(key->at("dirty").effects[0].effect_class, "plant");
  EXPECT_EQ(key->at("dirty").effects[0].from, "2021-03-01");
  EXPECT_EQ(largest_share(key->at("dirty")), 0.06);
  EXPECT_EQ(key->at("both").block, Block::pair);
  EXPECT_EQ(key->at("other").block, Block::out_of_catalogue);
}

TEST(HandedIn, MistakesNameTheCase) {
  const TemporaryFolder folder;
  const auto refusal = [&](const std::string& text) {
    write_text(folder / "truth.json", text);
    const auto count =
        write_handed_in(folder / "truth.json", "energyplus", kCatalogue, folder / "answers");
    return count ? "" : count.error().message;
  };
  EXPECT_THAT(refusal(R"({"a": {"archetype": "x", "weather": "y", "effects": {"fouling": {}}}})"),
              HasSubstr("case a: 'effects.fouling.strength'"));
  EXPECT_THAT(refusal(R"({"a": {"archetype": "x", "effects": {}}})"), HasSubstr("'weather'"));
  EXPECT_THAT(refusal("{}"), HasSubstr("names no case"));
  EXPECT_THAT(refusal("no"), HasSubstr("truth.json"));
}

TEST(HandedIn, TakesTheBuildingsThatOthersMade) {
  const char* const data = std::getenv("RECALD_DATA");
  const std::filesystem::path truth =
      std::filesystem::path(data == nullptr ? "" : data) / "eplus25" / "truth.json";
  if (!std::filesystem::exists(truth)) GTEST_SKIP() << "no data of others";
  const TemporaryFolder folder;
  const auto count = write_handed_in(truth, "energyplus", kCatalogue, folder / "answers");
  ASSERT_TRUE(count.has_value()) << count.error().message;
  const auto key = read_answers(folder / "answers");
  ASSERT_TRUE(key.has_value());
  for (const auto& [name, answer] : *key) EXPECT_EQ(answer.block, Block::no_effect) << name;
}

}  // namespace
}  // namespace recald::blind
