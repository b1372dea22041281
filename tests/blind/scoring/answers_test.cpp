#include "tests/blind/scoring/answers.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <ostream>

#include "tests/blind/scoring/made_up.hpp"

namespace recald::blind {
namespace {

using nlohmann::json;

TEST(Answers, ASingleIsReadWhole) {
  const auto answer = parse_answer(made_up::answer_json("sealed-017").dump(), "sealed-017");
  ASSERT_TRUE(answer.has_value()) << answer.error().message;
  EXPECT_EQ(answer->case_id, "sealed-017");
  EXPECT_EQ(answer->block, Block::single);
  EXPECT_EQ(answer->world, "own");
  ASSERT_EQ(answer->effects.size(), 1u);
  const HiddenEffect& effect = answer->effects.front();
  EXPECT_EQ(effect.effect, "night_setback_missing");
  EXPECT_EQ(effect.effect_class, "schedules");
  EXPECT_TRUE(effect.in_catalogue);
  EXPECT_EQ(effect.strength, 3.0);
  EXPECT_EQ(effect.unit, "K");
  EXPECT_EQ(effect.from, "2022-03-01");
  EXPECT_EQ(effect.to, std::nullopt);
  EXPECT_EQ(answer->true_parameters.at("cooling_setpoint_C"), 24.3);
  EXPECT_EQ(answer->prior_sd.at("cooling_setpoint_C"), 1.5);
  EXPECT_EQ(most_affected_meter(*answer), "steam");
}

TEST(Answers, MayBeOfAnotherWorld) {
  json text = made_up::answer_json("a");
  text["world"] = "energyplus";
  const auto answer = parse_answer(text.dump(), "a");
  ASSERT_TRUE(answer.has_value()) << answer.error().message;
  EXPECT_EQ(answer->world, "energyplus");
}

// A house without ventilation, of which the drawings say so.
TEST(Answers, WhatABuildingHasNoneOfIsNothingToFind) {
  json text = made_up::answer_json("a");
  text["true_parameters"]["outdoor_airflow"] = 0.0;
  text["prior_sd"]["outdoor_airflow"] = 0.0;
  const auto answer = parse_answer(text.dump(), "a");
  ASSERT_TRUE(answer.has_value()) << answer.error().message;
  EXPECT_EQ(answer->true_parameters.size(), 1u);
  EXPECT_EQ(answer->prior_sd.size(), 1u);
}

// The two effects of a pair may pull one meter apart; what counts is how much each moves it.
TEST(Answers, MostAffectedMeterGoesBySize) {
  HiddenEffect one = made_up::effect("a");
  one.share_of_meter = {{"electricity", 0.06}, {"steam", -0.04}};
  HiddenEffect other = made_up::effect("b");
  other.share_of_meter = {{"steam", 0.04}};
  HiddenEffect shifting;
  shifting.share_of_meter = {{"electricity", 0.001}, {"steam", 0.0}};
  shifting.moved_share = {{"electricity", 0.002}, {"steam", 0.05}};
  Answer shifted;
  shifted.effects = {shifting};
  EXPECT_EQ(most_affected_meter(shifted), "steam");
  EXPECT_EQ(most_affected_meter(made_up::pair("p", one, other)), "steam");
  EXPECT_EQ(most_affected_meter(made_up::nothing_hidden("n")), "");
}

struct Mistake {
  std::string name;
  std::function<void(json&)> make;
  std::string message;
  friend void PrintTo(const Mistake& mistake, std::ostream* out) { *out << mistake.name; }
};

class AnswerMistakes : public ::testing::TestWithParam<Mistake> {};

TEST_P(AnswerMistakes, AreNamedInOneSentence) {
  json text = made_up::answer_json("sealed-017");
  GetParam().make(text);
  const auto answer = parse_answer(text.dump(), "sealed-017");
  ASSERT_FALSE(answer.has_value());
  EXPECT_EQ(answer.error().code, ErrorCode::malformed);
  EXPECT_EQ(answer.error().message, "answer sealed-017: " + GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    Each, AnswerMistakes,
    ::testing::Values(
        Mistake{"OtherCase", [](json& a) { a["case"] = "sealed-018"; },
                "'case' is 'sealed-018', must be the file's name"},
        Mistake{"Missing", [](json& a) { a.erase("climate"); }, "'climate' is missing"},
        Mistake{"UnknownBlock", [](json& a) { a["block"] = "triple"; },
                "'block' is \"triple\", must be one of no_effect, single, out_of_catalogue, pair"},
        Mistake{"NotAnObject", [](json& a) { a = json::array({1}); },
                "must be a JSON object, not [1]"},
        Mistake{"NumberAsText", [](json& a) { a["effects"][0]["strength"] = "3"; },
                "'effects.0.strength' is \"3\", must be a number"},
        Mistake{"BadName", [](json& a) { a["effects"][0]["effect"] = "night | set-back"; },
                "'effects.0.effect' is \"night | set-back\", must be a name of letters, digits, "
                "dots, dashes and underscores"},
        Mistake{"BadDay", [](json& a) { a["effects"][0]["from"] = "March 2022"; },
                "'from' is 'March 2022', must be a day as in 2022-03-01"},
        Mistake{"BadFlag", [](json& a) { a["gaps"] = 0; }, "'gaps' is 0, must be true or false"},
        Mistake{"OtherWorld", [](json& a) { a["world"] = "mars"; },
                "'world' is \"mars\", must be one of own, energyplus"},
        Mistake{"NoEffectInSingle", [](json& a) { a["effects"] = json::array(); },
                "block 'single' with 0 effects, 0 of them in the catalogue; it must hide one of "
                "the catalogue"},
        Mistake{"EffectInNoEffect", [](json& a) { a["block"] = "no_effect"; },
                "block 'no_effect' with 1 effects, 1 of them in the catalogue; it must hide none"},
        Mistake{"TwinsInPair",
                [](json& a) {
                  a["block"] = "pair";
                  a["effects"].push_back(a["effects"][0]);
                },
                "block 'pair' with 2 effects, 2 of them in the catalogue; it must hide two "
                "different ones of the catalogue"},
        Mistake{"CataloguedOutside", [](json& a) { a["block"] = "out_of_catalogue"; },
                "block 'out_of_catalogue' with 1 effects, 1 of them in the catalogue; it must hide "
                "none of the catalogue"},
        Mistake{"NothingOutside",
                [](json& a) {
                  a["block"] = "out_of_catalogue";
                  a["effects"] = json::array();
                },
                "block 'out_of_catalogue' with 0 effects, 0 of them in the catalogue; it must hide "
                "one or have a decoy"},
        Mistake{"NoPriorSd", [](json& a) { a["prior_sd"] = json::object(); },
                "'prior_sd' lacks the parameter 'cooling_setpoint_C'"},
        Mistake{"ZeroPriorSd", [](json& a) { a["prior_sd"]["cooling_setpoint_C"] = 0.0; },
                "'prior_sd.cooling_setpoint_C' is 0, must be positive"},
        Mistake{"StrayPriorSd", [](json& a) { a["prior_sd"]["x"] = 1.0; },
                "'prior_sd' has parameters that 'true_parameters' lacks"}),
    [](const auto& instance) { return instance.param.name; });

TEST(Answers, WhatIsNotJsonIsNamed) {
  const auto answer = parse_answer("{\"case\": ", "sealed-017");
  ASSERT_FALSE(answer.has_value());
  EXPECT_EQ(answer.error().message, "answer sealed-017: not valid JSON");
}

TEST(Answers, AFolderIsReadByCase) {
  const testing::TemporaryFolder folder;
  testing::write_text(folder / "b.json", made_up::answer_json("b").dump());
  testing::write_text(folder / "a.json", made_up::answer_json("a").dump());
  testing::write_text(folder / "opened.json", "[]");
  testing::write_text(folder / "answers.sha256", "");
  const auto key = read_answers(folder.path());
  ASSERT_TRUE(key.has_value()) << key.error().message;
  EXPECT_EQ(key->size(), 2u);
  EXPECT_TRUE(key->contains("a") && key->contains("b"));
}

TEST(Answers, AFolderWithoutAnswersIsNamed) {
  const testing::TemporaryFolder folder;
  const auto empty = read_answers(folder.path());
  ASSERT_FALSE(empty.has_value());
  EXPECT_EQ(empty.error().code, ErrorCode::not_found);
  EXPECT_EQ(empty.error().message, "no answers (<case>.json) in '" + folder.path().string() + "'");

  const auto absent = read_answers(folder / "absent");
  ASSERT_FALSE(absent.has_value());
  EXPECT_EQ(absent.error().code, ErrorCode::not_found);
}

}  // namespace
}  // namespace recald::blind
