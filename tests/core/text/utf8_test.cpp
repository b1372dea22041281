/// Texts in the code pages of older programs, as iconv has them.
#include "core/text/utf8.hpp"

#include <gtest/gtest.h>

namespace recald::utf8_test {
namespace {

TEST(Utf8, WhatIsItStays) {
  for (const char* text : {"", "Zählerstand", "Ciepło", "20 °C", "m³", "€ – “x”"}) {
    EXPECT_TRUE(is_utf8(text));
    EXPECT_EQ(utf8_of(text), text);
  }
  for (const char* text : {"\xC0\x80", "\xED\xA0\x80", "\xF4\x90\x80\x80", "\xE2\x82", "\x80"}) {
    EXPECT_FALSE(is_utf8(text)) << text;
  }
}

TEST(Utf8, WesternTextHasSignsOfWindows) {
  EXPECT_EQ(utf8_of("00:00 \x96 00:15"), "00:00 – 00:15");
  EXPECT_EQ(utf8_of("Z\xE4hler (m\xB3)"), "Zähler (m³)");
  EXPECT_EQ(utf8_of("kWh/m\xB3"
                    "a"),
            "kWh/m³a");
  EXPECT_EQ(utf8_of("\xBFQu\xE9?"), "¿Qué?");
  EXPECT_EQ(utf8_of("\x80 12"), "€ 12");
}

TEST(Utf8, CentralEuropeanTextShowsInItsWords) {
  EXPECT_EQ(utf8_of("Ciep\xB3o"), "Ciepło");
  EXPECT_EQ(utf8_of("Pr\xB9"
                    "d \xA3\xF3"
                    "d\x9F"),
            "Prąd Łódź");
  EXPECT_EQ(utf8_of("Zu\xBFycie energii"), "Zużycie energii");
  EXPECT_EQ(utf8_of("g\xB3\xF3wny"), "główny");
}

}  // namespace
}  // namespace recald::utf8_test
