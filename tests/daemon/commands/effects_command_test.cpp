/// The catalogue of effects, for people.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "core/diagnosis/effects/support/effect.hpp"
#include "tests/daemon/command_line.hpp"

namespace recald::daemon::effects_command_test {
namespace {

using diagnosis::catalogue;
using diagnosis::Effect;
using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::Outcome;
using testing::run;

std::size_t columns(const std::string& line) {
  return static_cast<std::size_t>(
      std::ranges::count_if(line, [](char c) { return (c & 0xC0) != 0x80; }));
}

void expect_narrow(const std::string& text) {
  std::istringstream in{text};
  for (std::string line; std::getline(in, line);) EXPECT_LE(columns(line), 100u) << line;
}

TEST(EffectsCommand, ListsAllOnceInGroups) {
  const Outcome outcome = run({"effects"});
  ASSERT_EQ(outcome.exit_code, kSuccess);
  expect_narrow(outcome.out);
  ASSERT_EQ(catalogue().size(), 40u);
  for (const Effect& effect : catalogue()) {
    const std::string line = "\n  " + std::string{effect.id} + " ";
    const auto at = outcome.out.find(line);
    ASSERT_NE(at, std::string::npos) << effect.id;
    EXPECT_EQ(outcome.out.find(line, at + 1), std::string::npos) << effect.id;
    EXPECT_THAT(outcome.out.substr(at, 100), HasSubstr(std::string{effect.title}));
  }
  const auto group = outcome.out.find("Outdoor air\n");
  EXPECT_LT(outcome.out.find("  weekend_operation"), group);
  EXPECT_LT(group, outcome.out.find("  economiser_failed"));
}

/// Without line breaks and indents.
std::string unfolded(const std::string& text) {
  std::string flat;
  std::istringstream in{text};
  for (std::string word; in >> word;) flat += (flat.empty() ? "" : " ") + word;
  return flat;
}

TEST(EffectsCommand, ExplainsEach) {
  for (const Effect& effect : catalogue()) {
    SCOPED_TRACE(effect.id);
    // In the catalogue itself: sentences that say something.
    for (const std::string_view text : {effect.on_meters, effect.check}) {
      EXPECT_GT(text.size(), 25u);
      EXPECT_TRUE(text.ends_with('.')) << text;
    }
    const Outcome outcome = run({"effects", std::string{effect.id}});
    ASSERT_EQ(outcome.exit_code, kSuccess);
    expect_narrow(outcome.out);
    const std::string flat = unfolded(outcome.out);
    for (const std::string_view text :
         {effect.title, effect.meaning, effect.physics, effect.on_meters, effect.check}) {
      EXPECT_THAT(flat, HasSubstr(unfolded(std::string{text})));
    }
    for (const diagnosis::Confusable& rival : effect.confusable) {
      EXPECT_THAT(flat, HasSubstr(unfolded(std::string{rival.separated_by})));
    }
  }
}

TEST(EffectsCommand, TakesNamesAsPeopleWriteThem) {
  const std::string page = run({"effects", "weekend_operation"}).out;
  EXPECT_EQ(run({"effects", "weekend-operation"}).out, page);
  EXPECT_EQ(run({"effects", "Weekend operation"}).out, page);
  EXPECT_THAT(run({"effects", "-v"}).out, HasSubstr(std::string{catalogue().front().check}));
}

TEST(EffectsCommand, AnUnknownNameGetsTheNearest) {
  const Outcome near = run({"effects", "Weekend-Operaton"});
  EXPECT_EQ(near.exit_code, kUsage);
  EXPECT_EQ(near.err,
            "recald: there is no effect 'Weekend-Operaton'; did you mean 'weekend_operation'?\n");
  const Outcome far = run({"effects", "xyzzy"});
  EXPECT_EQ(far.exit_code, kUsage);
  EXPECT_EQ(far.err, "recald: there is no effect 'xyzzy'; recald effects lists them\n");
}

// A letter lost at the beginning, in the middle or at the end of every name leads back to it.
TEST(EffectsCommand, EveryLostLetterIsFound) {
  for (const Effect& effect : catalogue()) {
    for (const std::size_t i : {std::size_t{0}, effect.id.size() / 2, effect.id.size() - 1}) {
      std::string name{effect.id};
      name.erase(i, 1);
      EXPECT_THAT(run({"effects", name}).err,
                  HasSubstr("did you mean '" + std::string{effect.id} + "'?"))
          << name;
    }
  }
}

TEST(EffectsCommand, AsJson) {
  const auto all = nlohmann::json::parse(run({"effects", "--json"}).out);
  ASSERT_EQ(all.at("effects").size(), catalogue().size());
  const auto one = nlohmann::json::parse(run({"effects", "fouling", "--json"}).out);
  EXPECT_EQ(one.at("effect"), "fouling");
  EXPECT_EQ(one.at("class"), "plant");
  EXPECT_EQ(one.at("confusable").at(0).at("effect"), "scale_fault");
  EXPECT_NE(std::ranges::find(all.at("effects"), one), all.at("effects").end());
}

}  // namespace
}  // namespace recald::daemon::effects_command_test
