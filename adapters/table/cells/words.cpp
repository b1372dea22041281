#include "adapters/table/cells/words.hpp"

#include <algorithm>
#include <array>

#include "core/text/ascii.hpp"

namespace recald::table {
namespace {

constexpr std::array<std::string_view, 64> kLatin1{
    "a", "a", "a", "a", "ae", "aa", "ae", "c", "e",  "e", "e", "e", "i",  "i", "i",  "i",
    "d", "n", "o", "o", "o",  "o",  "oe", " ", "oe", "u", "u", "u", "ue", "y", "th", "ss",
    "a", "a", "a", "a", "ae", "aa", "ae", "c", "e",  "e", "e", "e", "i",  "i", "i",  "i",
    "d", "n", "o", "o", "o",  "o",  "oe", " ", "oe", "u", "u", "u", "ue", "y", "th", "y"};
constexpr std::string_view kLatinExtendedA =
    "aaaaaaccccccccddddeeeeeeeeeegggggggghhhhiiiiiiiiiiiijjkkkllllllllllnnnnnnnnnoooooooorrrrrr"
    "ssssssssttttttuuuuuuuuuuuuwwyyyzzzzzzs";
static_assert(kLatinExtendedA.size() == 128);

struct Sign {
  std::uint32_t point;
  std::string_view letters;
};
constexpr std::array kSigns{Sign{'%', " percent "}, Sign{'$', " usd "},  Sign{0xA2, " cent "},
                            Sign{0xA3, " gbp "},    Sign{0xB0, " deg "}, Sign{0xB2, "2"},
                            Sign{0xB3, "3"},        Sign{0xB5, "u"},     Sign{0x3BC, "u"},
                            Sign{0x20AC, " eur "},  Sign{0x2082, "2"},   Sign{0x2103, " deg c "},
                            Sign{0x2109, " deg f "}};

struct WordsOf {
  Meaning meaning;
  std::string_view words;  ///< Set apart by bars; a blank is where a word begins or ends.
};

constexpr std::array kWordsOf{
    WordsOf{Meaning::time,
            " time|time | date|date |zeit|datum| dato | data | fecha|horodat|tijd| aika|"
            "aika | pvm |paeivae| paiva| czas| day | tag | jour | dia | giorno | dag |"
            " dzien | tid |tidspunkt| tidpunkt| epoch| unix| ts | period| periode"},
    WordsOf{Meaning::from, " start| begin| debut| inicio| inicial| inizio| alku| alkaa| poczat"},
    WordsOf{Meaning::to,
            " end | ends | ended | ending | ende | endzeit| enddatum| stop | fin | fim |"
            " final | slut| einde| eind| loppu| paeaettyy| koniec"},
    WordsOf{Meaning::clock,
            " hour| uhrzeit| stunde| zeit | heure| hora| ora | ore | uur | tijd| time |"
            " klok| kl | klo | kello| tunti| timme| godzin| period | sp | interval|"
            " intervall| periodo | kwartier| viertelst| kvart| quarto| he | hr | std | tid "},
    WordsOf{Meaning::other_time,
            " created| updated| modified| inserted| received| exported| erstellt| invoice|"
            " revision| processed| uploaded| published| billing"},
    WordsOf{Meaning::date_part,
            " year | month | week| jahr | monat |wochentag| annee | mois | ano | mes |"
            " anno | mese | jaar | maand | aar | maaned | manad | vuosi | rok | miesiac |"
            " weekday| dow "},
    WordsOf{Meaning::use,
            "energ|power|consum|usage| use |demand|load| import | export |deliver|generat|"
            "produ|reading | kwh | kw |verbrauch|leistung|arbeit|bezug|lieferung|einspeis|"
            "zaehlerstand|lastgang|erzeugung|messwert|puissance|consomm|soutir|index |"
            "potencia|lectura|vertido|potenza|prelie|immess|lettura|verbruik|vermogen|"
            "afname|injectie|teruglever|meterstand|leitura|injec|forbrug|effekt|"
            "maalerstand|foerbruk|forbruk|maetarstaellning|inmatning|kulutus|teho |"
            "tuotanto|lukema|zuzyci|pobor| moc |wskazanie| value| wert| valeur| valor|"
            " waarde| maengde| maeaerae| maara | vaerdi| vaerde| arvo| wartosc| volume| menge| "
            "quantity| quantite"},
    WordsOf{Meaning::cost,
            "cost | costs | coste | costes | costo | precio| montant | custo | custos |"
            " euro | euros | charge inc| service charge| network charge| demand charge|"
            " capacity charge| fixed charge| energy charge| price|price | charges | fee |"
            " fees | tax | vat | usd | eur | gbp | chf | dkk | sek | nok | pln | zl | cad |"
            " aud | nzd | cent | cents | ct | pence | dollar|kosten |preis |preise | preis|"
            "betrag |entgelt|gebuehr| cout | couts | prix | importe | costi | prezzo|"
            " importo | spesa |prijs| bedrag| preco|pris | beloeb| belopp|avgift| kostnad|"
            "kostnad | omkostning| udgift|hinta | hinta|kustannu| maksu| koszt| cena|"
            " kwota| oplata|standing charge|grundpreis| unit rate | oere | revenue|"
            " savings | abonnement"},
    WordsOf{Meaning::meter,
            "meter | meter| point| sensor| channel| device| tag| series| register|name |"
            " variable| entity|zaehler | zahler|zaehlpunkt|messstelle|messpunkt|"
            "messlokation|marktlokation| kanal| obis| compteur| capteur| contador| medidor|"
            " contatore| misuratore| aansluiting| maaler | maalepunkt| maetare| matare|"
            " maetpunkt| matpunkt| anlaeggning| mittari| kaeyttoepaikka| kayttopaikka|"
            " licznik| punkt poboru| building | gebaeude"},
    WordsOf{
        Meaning::identifier,
        " mpan| mprn| ean| esi id| esiid| nmi | cups | cpe | prm | pdl | pod | pce |"
        " pdr | ppe | gsrn| malo | melo | iccp | serial| serien| serie | account|"
        " customer| contract| premise| service point| service agreement| id | identif|"
        " uuid |nummer |numer | number |numero |numeri | kunde| vertrag| contrat|"
        " client | cliente | tunnus|tunnus | contrato| contratto| klant| kund | asiakas| sopimus|"
        " klient| umow| avtal| matricola| nr | address| postcode | zip "},
    WordsOf{Meaning::tariff,
            " tariff| tarif| tarief| taryfa| taksa| tou | rate | band | fascia| discrimina|"
            " strefa| peak | piek | season"},
    WordsOf{Meaning::status,
            " status|status | state | quality| flag|flag | estimate| estimated | note|"
            " remark| comment| method| metodo| methode| valid| read type| reading type|"
            " event| alarm| qualitaet| bemerkung| ablesea| qualite| nature| statut| etat |"
            " calidad| estado| qualita| stato| kwaliteit| opmerking| qualidade| kvalitet|"
            " laatu| tila | jakosc| stan | uwagi| confidence"},
    WordsOf{Meaning::unit,
            " unit | units | uom |einheit | masseinheit| unite | unites | unidad| unita |"
            " eenheid| unidade|enhed |enhet | yksikko| yksikkoe| jednostk"},
    WordsOf{Meaning::counts,
            " index | row | rownum| record| line | lfd | zeile| ligne | fila | riga | rij |"
            " linha | raekke| rad | rivi | wiersz| lp | no | nr | unnamed | sequence| seq |"
            " count "},
    WordsOf{Meaning::other,
            " temp|temp |temperatur| deg | degc| degf| oat |laempoetila|lampotila|humid|"
            "feuchte|volt|spannung| tension| tensao| spanning| spaending| spaenning|"
            " jaennite| napiecie| amp | amps| ampere|strom a |reactiv|reaktiv|blindarbeit|"
            "blindleist|reattiv|blindenergie|reatec|reativ|loisteho|loisenerg|biern|"
            "blindstrom|apparent|scheinleist|aparente|schijnverm|kvar| varh| kva | kvah |"
            " va | mvar|power factor|powerfactor| pf | cos phi|cosphi|leistungsfaktor| hz |"
            "frequen|frekvens|pressure|druck |setpoint|sollwert| percent | pct | dry bulb| dew "
            "point|taupunkt|"
            " wet bulb| wind |windspeed|windgeschw|irradi|globalstrahl| soc | rssi|"
            " occupan| degree day| hdd | cdd | m2 |flow rate|durchfluss| thd| factor |"
            " multiplier| latitude| longitude| minutes | duration| dauer "},
    WordsOf{Meaning::emission, " co2|co2 | carbon|emission| ghg"},
};

/// Words that tell starts and ends only in front or at the end of a header: "Datum von", "Tot
/// (datum)", and not "hora do consumo".
constexpr std::string_view kFromWords =
    "from|since|von|vom|seit|ab|desde|depuis|du|dal|dalle|van|vanaf|fra|fraan|fran|od";
constexpr std::string_view kToWords = "to|until|till|bis|au|hasta|ate|al|alle|fine|tot|til|do";

bool has_word_of(std::string_view text, std::string_view words) {
  for (;;) {
    const std::size_t bar = words.find('|');
    if (text.find(words.substr(0, bar)) != std::string_view::npos) return true;
    if (bar == std::string_view::npos) return false;
    words.remove_prefix(bar + 1);
  }
}

/// Beginnings of the months' names.
constexpr auto kMonths = std::to_array<std::string_view>(
    {"jan|jaen|ene|gen|sty|tam", "feb|fev|lut|hel", "mar|mrz|maer|mrt|maa", "apr|avr|abr|kwi|huh",
     "may|mai|mag|maj|mei|tou", "jun|juin|giu|cze|kes", "jul|juil|lug|lip|hei",
     "aug|aou|ago|sie|elo", "sep|set|wrz|syy", "oct|okt|ott|out|paz|lok", "nov|lis",
     "dec|dez|dic|gru|jou"});

/// Of the days of a week: two letters alone, or at least three.
constexpr std::string_view kShortDays =
    "mo|tu|we|th|fr|sa|su|di|mi|do|so|ma|wo|vr|za|zo|ti|ke|to|pe|la|pn|wt|sr|nd";
constexpr std::string_view kDays =
    "mon|tue|wed|thu|fri|sat|sun|die|mit|don|fre|sam|son|lun|mar|mer|jeu|ven|dim|mie|jue|vie|sab|"
    "dom|gio|maa|din|woe|vri|zat|zon|seg|ter|qua|qui|sex|man|tir|ons|tor|loe|soe|tis|kes|per|lau|"
    "pon|wto|sro|czw|pia|sob|nie";

bool begins_with_one(std::string_view text, std::string_view words) {
  for (;;) {
    const std::size_t bar = words.find('|');
    const std::string_view word = words.substr(0, bar);
    if (text.substr(0, word.size()) == word) return true;
    if (bar == std::string_view::npos) return false;
    words.remove_prefix(bar + 1);
  }
}

/// Whether `text` is one of the words.
bool is_one_of(std::string_view text, std::string_view words) {
  for (;;) {
    const std::size_t bar = words.find('|');
    if (text == words.substr(0, bar)) return true;
    if (bar == std::string_view::npos) return false;
    words.remove_prefix(bar + 1);
  }
}

constexpr std::string_view kNothing =
    "na|n a|nan|null|none|nil|n d|nd|n v|nv|k a|s d|s n|no data|nodata|no value|missing|"
    "unavailable|unknown|undefined|invalid|not available|not read|no reading|no good data|bad|"
    "bad input|bad value|bad data|fault|down|stale|disabled|offline|error|err|fail|failed|"
    "comm fail|comm failure|timeout|i o timeout|not connected|out of service|calc failed|"
    "scan off|pt created|keine daten|kein wert|keine angabe|fehlt|fehler|ungueltig|"
    "nicht verfuegbar|unbekannt|indisponible|non disponible|manquant|aucune donnee|absent|"
    "sin datos|sin dato|no disponible|nessun dato|non disponibile|mancante|geen data|"
    "geen gegevens|geen waarde|onbekend|sem dados|ingen data|mangler|saknas|ei tietoa|puuttuu|"
    "brak danych|brak";

/// Of the cells of a spreadsheet, after their '#'.
constexpr std::string_view kErrors =
    "n a|value|ref|div 0|num|null|name|nv|wert|bezug|zahl|valeur|nombre";

}  // namespace

std::uint32_t take_character(std::string_view& text) {
  const auto byte = [&](std::size_t at) { return static_cast<unsigned char>(text[at]); };
  const unsigned char first = byte(0);
  const std::size_t more = first < 0xC2   ? 0
                           : first < 0xE0 ? 1
                           : first < 0xF0 ? 2
                           : first < 0xF5 ? 3
                                          : 0;
  std::uint32_t point = more == 0 ? first : first & (0x3Fu >> more);
  bool is_whole = more < text.size();
  for (std::size_t i = 1; is_whole && i <= more; ++i) {
    is_whole = (byte(i) & 0xC0u) == 0x80u;
    point = (point << 6) | (byte(i) & 0x3Fu);
  }
  text.remove_prefix(is_whole ? more + 1 : 1);
  return is_whole ? point : first;
}

bool is_wide_blank(std::uint32_t point) {
  return point == 0xA0 || point == 0x1680 || (point >= 0x2000 && point <= 0x200A) ||
         point == 0x2028 || point == 0x2029 || point == 0x202F || point == 0x205F ||
         point == 0x3000;
}

bool is_unseen(std::uint32_t point) {
  return point == 0xAD || (point >= 0x200B && point <= 0x200F) ||
         (point >= 0x202A && point <= 0x202E) || (point >= 0x2060 && point <= 0x2069) ||
         point == 0xFEFF;
}

std::string_view plain_letters(std::uint32_t point) {
  if (point >= 0xC0 && point < 0x100) return kLatin1[point - 0xC0];
  if (point == 0x152 || point == 0x153) return "oe";
  if (point >= 0x100 && point < 0x180) return kLatinExtendedA.substr(point - 0x100, 1);
  for (const Sign& sign : kSigns) {
    if (sign.point == point) return sign.letters;
  }
  return is_unseen(point) ? "" : " ";
}

std::string folded(std::string_view text) {
  std::string out{' '};
  std::size_t small = 0;  // letters in lower case that came last
  const auto add = [&](char c) {
    if (c != ' ' || out.back() != ' ') out += c;
  };
  while (!text.empty()) {
    const std::uint32_t point = take_character(text);
    const auto c = static_cast<char>(point);
    const bool is_large = point >= 'A' && point <= 'Z';
    const bool is_small = point >= 'a' && point <= 'z';
    if (is_large && small >= 2) add(' ');
    small = is_small ? small + 1 : 0;
    if (is_large || is_small || (point >= '0' && point <= '9')) {
      add(to_lower(c));
    } else {
      for (const char letter : plain_letters(point)) add(letter);
      if (point >= 0xDF && point < 0x180) ++small;
    }
  }
  add(' ');
  return out;
}

Meanings meanings_of(std::string_view header) {
  Meanings found;
  const std::string text = folded(header);
  for (const WordsOf& one : kWordsOf) {
    if (has_word_of(text, one.words)) found.add(one.meaning);
  }
  if (text == " a ") found.add(Meaning::to);  // French and Portuguese
  if (text.size() > 2) {
    const std::string_view words = std::string_view{text}.substr(1, text.size() - 2);
    for (const std::string_view word :
         {words.substr(0, words.find(' ')), words.substr(words.rfind(' ') + 1)}) {
      if (is_one_of(word, kFromWords)) found.add(Meaning::from);
      if (is_one_of(word, kToWords)) found.add(Meaning::to);
    }
  }
  return found;
}

int month_named(std::string_view word) {
  if (begins_with_one(word, "marr")) return 11;  // marraskuu, and mar is March
  for (std::size_t i = 0; i < kMonths.size(); ++i) {
    if (begins_with_one(word, kMonths[i])) return static_cast<int>(i) + 1;
  }
  return 0;
}

bool is_weekday(std::string_view word) {
  return word.size() == 2 ? begins_with_one(word, kShortDays) : begins_with_one(word, kDays);
}

bool is_word_for_nothing(std::string_view cell) {
  if (cell.empty()) return true;
  if (cell.size() > 24) return false;
  const bool is_error = cell.front() == '#';
  // What has a figure is no word; of the errors of a spreadsheet only #DIV/0! has one.
  if (!is_error && cell.find_first_of("0123456789") != std::string_view::npos) return false;
  const std::string text = folded(cell);
  const std::string_view inner =
      text.size() < 2 ? std::string_view{} : std::string_view{text}.substr(1, text.size() - 2);
  // Dashes and dots, but not a text of letters that have no plain ones.
  if (inner.empty()) {
    std::string_view rest = cell;
    while (!rest.empty()) {
      const std::uint32_t point = take_character(rest);
      if (point >= 0x80 && (point < 0x2010 || point > 0x2026) && !is_wide_blank(point))
        return false;
    }
    return true;
  }
  if (is_error) return is_one_of(inner, kErrors);
  return is_one_of(inner, kNothing);
}

}  // namespace recald::table
