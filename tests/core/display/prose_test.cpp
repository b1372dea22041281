#include "core/display/prose.hpp"

#include <gtest/gtest.h>

namespace recald::display {
namespace {

TEST(Prose, TemperaturesAreSaidInTheUnitOfDisplay) {
  const std::string text =
      "Compare weather between 8 and 18 °C with hours at -10 °C; chilled water at 8 to 14 °C.";
  EXPECT_EQ(with_temperatures_in(UnitSystem::si, text), text);
  EXPECT_EQ(with_temperatures_in(UnitSystem::ip, text),
            "Compare weather between 46 and 64 °F with hours at 14 °F; chilled water at 46 to 57 "
            "°F.");
  EXPECT_EQ(with_temperatures_in(UnitSystem::ip, "between 8.3 and 10.1 °C, too close"),
            "between 47 and 50 °F, too close");
  EXPECT_EQ(with_temperatures_in(UnitSystem::ip, "a 12 °C morning"), "a 54 °F morning");
  EXPECT_EQ(with_temperatures_in(UnitSystem::ip, "theta [°C]"), "theta [°C]");
}

}  // namespace
}  // namespace recald::display
