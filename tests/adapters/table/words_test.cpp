#include "adapters/table/cells/words.hpp"

#include <gtest/gtest.h>

#include <array>
#include <utility>
#include <vector>

namespace recald::table::words_test {
namespace {

TEST(Words, AreComparedWithoutAccentsSignsAndCase) {
  EXPECT_EQ(folded("MeterReading (Z\xC3\xA4hler-Nr.)"), " meter reading zaehler nr ");
  EXPECT_EQ(folded("consumo_kWh"), " consumo kwh ");
  EXPECT_EQ(folded("Zu\xC5\xBCycie energii"), " zuzycie energii ");
  EXPECT_EQ(folded("Co\xC3\xBBt \xE2\x82\xAC/kWh"), " cout eur kwh ");
  EXPECT_EQ(folded("\xEF\xBB\xBFTime\xE2\x80\xAF(UTC)"), " time utc ");
  EXPECT_EQ(folded("\xFC"
                   "ber"),
            " ueber ");  // Latin-1
  EXPECT_EQ(folded(""), " ");
}

struct Header {
  const char* text;
  Meaning meaning;
};

// What the headers of portals mean, language by language.
TEST(Words, HeadersMeanTheSameInElevenLanguages) {
  using enum Meaning;
  constexpr std::array kHeaders{
      Header{"Estimated Cost Inc. Tax (p)", cost},
      Header{"Stromkosten [EUR]", cost},
      Header{"Co\xC3\xBBt (\xE2\x82\xAC)", cost},
      Header{"Importe (EUR)", cost},
      Header{"Costo", cost},
      Header{"Kosten", cost},
      Header{"Pre\xC3\xA7o", cost},
      Header{"Bel\xC3\xB8"
             "b",
             cost},
      Header{"Kostnad", cost},
      Header{"Hinta", cost},
      Header{"Koszt", cost},
      Header{"ct/kWh", cost},
      Header{"Serial number", identifier},
      Header{"Z\xC3\xA4hlernummer", identifier},
      Header{"Identifiant PRM", identifier},
      Header{"CUPS", identifier},
      Header{"Numero contratto", identifier},
      Header{"EAN-code", identifier},
      Header{"N\xC3\xBAmero de cliente", identifier},
      Header{"Serienummer", identifier},
      Header{"Kundnummer", identifier},
      Header{"Sopimusnumero", identifier},
      Header{"Numer licznika", meter},
      Header{"M\xC3\xA4tare", Meaning::meter},
      Header{"Status", status},
      Header{"Qualit\xC3\xA4t", status},
      Header{"Qualit\xC3\xA9", status},
      Header{"Calidad", status},
      Header{"Stato", status},
      Header{"Kwaliteit", status},
      Header{"Estado", status},
      Header{"Kvalitet", status},
      Header{"Laatu", status},
      Header{"Jako\xC5\x9B\xC4\x87", status},
      Header{"Unit", unit},
      Header{"Einheit", unit},
      Header{"Unit\xC3\xA9", unit},
      Header{"Unidad", unit},
      Header{"Unit\xC3\xA0", unit},
      Header{"Eenheid", unit},
      Header{"Unidade", unit},
      Header{"Enhed", unit},
      Header{"Enhet", unit},
      Header{"Yksikk\xC3\xB6", unit},
      Header{"Jednostka", unit},
      Header{"Verbrauch", use},
      Header{"Consommation", use},
      Header{"Consumo", use},
      Header{"Prelievo", use},
      Header{"Afname", use},
      Header{"Forbrug", use},
      Header{"F\xC3\xB6rbrukning", use},
      Header{"Kulutus", use},
      Header{"Zu\xC5\xBCycie", use},
      Header{"Start time", from},
      Header{"Van (datum)", from},
      Header{"Datum von", from},
      Header{"D\xC3\xA9"
             "but",
             from},
      Header{"Inicio", from},
      Header{"Fr\xC3\xA5n", from},
      Header{"End time", to},
      Header{"Tot (datum)", to},
      Header{"Zeit bis", to},
      Header{"Fin", to},
      Header{"Fim", to},
      Header{"Slut", to},
      Header{"Data do", to},
      Header{"kvarh", other},
      Header{"Blindarbeit", other},
      Header{"Reactive energy", other},
      Header{"\xC3\x89nergie r\xC3\xA9"
             "active",
             other},
      Header{"Outdoor temp (\xC2\xB0"
             "C)",
             other},
      Header{"Spannung L1", other},
      Header{"kg CO2", emission},
  };
  for (const Header& one : kHeaders) {
    EXPECT_TRUE(meanings_of(one.text).has(one.meaning)) << one.text;
  }
}

TEST(Words, PartsOfOtherWordsMeanNothing) {
  const auto has = [](const char* text, Meaning meaning) { return meanings_of(text).has(meaning); };
  EXPECT_FALSE(has("Hora do consumo", Meaning::to));
  EXPECT_FALSE(has("Kalender", Meaning::to));
  EXPECT_FALSE(has("Tijdstip van meting", Meaning::from));
  EXPECT_FALSE(has("Kostenstelle 4711", Meaning::cost));
  EXPECT_FALSE(has("Prise bureau", Meaning::cost));
  EXPECT_FALSE(has("Customer load", Meaning::cost));
  EXPECT_FALSE(has("Windows", Meaning::other));
}

TEST(Words, MonthsInElevenLanguages) {
  const std::array<std::vector<const char*>, 12> months{{
      {"january", "jaenner", "janvier", "enero", "gennaio", "januari", "janeiro", "tammikuu",
       "stycznia"},
      {"february", "fevrier", "febrero", "fevereiro", "helmikuu", "lutego"},
      {"march", "maerz", "mrz", "mars", "marzo", "maart", "mrt", "marco", "maaliskuu", "marca"},
      {"april", "avril", "abril", "aprile", "huhtikuu", "kwietnia"},
      {"may", "mai", "mayo", "maggio", "mei", "maio", "maj", "toukokuu", "maja"},
      {"june", "juni", "juin", "junio", "giugno", "junho", "kesaekuu", "czerwca"},
      {"july", "juli", "juillet", "julio", "luglio", "julho", "heinaekuu", "lipca"},
      {"august", "aout", "agosto", "augustus", "elokuu", "sierpnia"},
      {"september", "septembre", "settembre", "setembro", "syyskuu", "wrzesnia"},
      {"october", "oktober", "octobre", "ottobre", "outubro", "lokakuu", "pazdziernika"},
      {"november", "novembre", "noviembre", "novembro", "marraskuu", "listopada"},
      {"december", "dezember", "decembre", "diciembre", "dicembre", "dezembro", "joulukuu",
       "grudnia"},
  }};
  for (std::size_t i = 0; i < months.size(); ++i) {
    for (const char* name : months[i])
      EXPECT_EQ(month_named(name), static_cast<int>(i) + 1) << name;
  }
  for (const char* word : {"", "ma", "xyz", "total"}) EXPECT_EQ(month_named(word), 0) << word;
}

TEST(Words, WordsForNothing) {
  for (const char* cell : {"",
                           "-",
                           "---",
                           "\xE2\x80\x93",
                           "n/a",
                           "N.A.",
                           "NaN",
                           "NULL",
                           "#N/A",
                           "#DIV/0!",
                           "no data",
                           "unavailable",
                           "Unknown",
                           "{fault}",
                           "{down}",
                           "Bad",
                           "I/O Timeout",
                           "keine Daten",
                           "k.A.",
                           "fehlt",
                           "manquant",
                           "sin datos",
                           "n/d",
                           "non disponibile",
                           "geen gegevens",
                           "sem dados",
                           "mangler",
                           "saknas",
                           "ei tietoa",
                           "brak danych"}) {
    EXPECT_TRUE(is_word_for_nothing(cell)) << cell;
  }
  for (const char* cell : {"0", "-1", "12 kWh", "on", "nano", "Real", "E", "\xE7\x84\xA1", "A7"}) {
    EXPECT_FALSE(is_word_for_nothing(cell)) << cell;
  }
}

}  // namespace
}  // namespace recald::table::words_test
