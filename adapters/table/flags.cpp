#include "adapters/table/flags.hpp"

#include <algorithm>
#include <array>

#include "core/text/ascii.hpp"

namespace recald::table {
namespace {

// Words between bars, in lower case; letters beyond ASCII as they are usually written.
constexpr std::string_view kMeasuredWords =
    "|actual|act|real|measured|metered|ok|{ok}|good|valid|validated|verified|normal|billable|final|"
    "raw"
    "|wahr|wahrer "
    "wert|gemessen|messwert|gültig|gueltig|mesuré|mesurée|mesure|réel|réelle|reel|reelle"
    "|medida|medido|lectura real|leitura real|lida|reale|effettivo|effettiva|misurato|misurata"
    "|gemeten|uitgelezen|gevalideerd|målt|maalt|aflæst|aflaest|avläst|uppmätt|mätt|mitattu|luettu"
    "|zmierzony|zmierzone|odczyt|rzeczywisty|rzeczywista|rzeczywiste|";
constexpr std::string_view kEstimatedWords =
    "|estimated|estimate|est|est.|substituted|substitute|interpolated|edited|manual|profiled"
    "|ersatzwert|ersatz|geschätzt|geschaetzt|interpoliert|korrigiert|rechnerisch|estimé|estimée"
    "|estime|estimee|corrigé|corrige|estimado|estimada|lectura estimada|leitura estimada|stimato"
    "|stimata|stima|geschat|schatting|berekend|uppskattat|uppskattad|estimerad|estimerat|beregnet"
    "|estimeret|skønnet|arvio|arvioitu|szacowany|szacowana|szacowane|szacunkowy|oszacowane|";
constexpr std::string_view kMissingWords =
    "|missing|no data|nodata|null|void|invalid|bad|fault|{fault}|down|{down}|error|offline|fehlt"
    "|fehlend|fehlwert|ausfall|ungültig|ungueltig|kein wert|manquant|manquante|absent|absente"
    "|invalide|ausente|faltante|falta|sin datos|sem dados|mancante|assente|ontbreekt|ontbrekend"
    "|saknas|mangler|puuttuu|puuttuva|brak|brak danych|brakuje|n/a|no value|no reading|not "
    "available"
    "|unavailable|keine daten|nicht verfügbar|pas de données|indisponible|non disponible|sin dato"
    "|sin lectura|no disponible|em falta|sem dado|sem leitura|não disponível|nessun dato"
    "|non disponibile|geen data|geen waarde|niet beschikbaar|ingen data|ikke tilgængelig"
    "|ej tillgänglig|ei dataa|ei saatavilla|niedostępne|niedostępny|";
constexpr std::string_view kNegations =
    "|no|not|without|kein|keine|nicht|ohne|pas|sans|sin|sem|não|senza|non|geen|niet|zonder|ingen|"
    "ikke"
    "|uden|utan|inga|ej|ei|bez|nie|";
/// Parts of headers.
constexpr std::array<std::string_view, 32> kHeaderParts{
    "status",       "quality",         "qualit",          "calidad",
    "kwaliteit",    "kvalitet",        "laatu",           "jako",
    "flag",         "kennzeich",       "validat",         "validier",
    "estimat",      "estima",          "obtenci",         "read type",
    "reading type", "readtype",        "type lecture",    "type de lecture",
    "nature",       "tipo de lectura", "tipo de leitura", "tipo lettura",
    "statut",       "estado",          "stato",           "tila",
    "actual/est",   "ersatzwert",      "messart",         "meetwijze"};

bool is_one_of(const std::string& text, std::string_view words) {
  return !text.empty() && words.find("|" + text + "|") != std::string_view::npos;
}

/// The letter of "E", and of "E52", which names the method as well; 0: it is something else.
char letter_of(std::string_view flag) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  const bool has_method = flag.size() == 3 && is_digit(flag[1]) && is_digit(flag[2]);
  return flag.size() == 1 || has_method ? to_lower(flag.front()) : '\0';
}

FlagMeaning by_word(std::string_view flag) {
  const std::string word = to_lower(flag);
  if (is_one_of(word, kMeasuredWords)) return FlagMeaning::measured;
  if (is_one_of(word, kEstimatedWords)) return FlagMeaning::estimated;
  if (is_one_of(word, kMissingWords)) return FlagMeaning::missing;
  // "value missing", "valor em falta": what is missing stands beside it; "no error" is none.
  if (is_one_of(word.substr(0, word.find(' ')), kNegations)) return FlagMeaning::unknown;
  for (std::size_t at = word.find(' '); at != std::string::npos; at = word.find(' ', at + 1)) {
    if (is_one_of(word.substr(at + 1), kMissingWords)) return FlagMeaning::missing;
    if (is_one_of(word.substr(0, at), kMissingWords)) return FlagMeaning::missing;
  }
  return FlagMeaning::unknown;
}

bool has_flag(std::span<const FlagCount> all, char letter) {
  return std::ranges::any_of(all,
                             [&](const FlagCount& one) { return letter_of(one.flag) == letter; });
}

bool is_always_empty(const FlagCount& flag) { return flag.rows > 0 && flag.empty == flag.rows; }

/// NEM12: actual, estimated, final or other substitute, null. German: wahr, Ersatz, fehlt. Others:
/// real, estimated or "stimata"; good, bad.
FlagMeaning by_letter(const FlagCount& flag, std::span<const FlagCount> all) {
  switch (letter_of(flag.flag)) {
    case 'a':
    case 'w':
    case 'g':
      return is_always_empty(flag) ? FlagMeaning::unknown : FlagMeaning::measured;
    case 'r':
      return has_flag(all, 'e') || has_flag(all, 's') ? FlagMeaning::measured
                                                      : FlagMeaning::unknown;
    case 'e':
    case 's':
      return is_always_empty(flag) ? FlagMeaning::missing : FlagMeaning::estimated;
    case 'f':
      if (has_flag(all, 'w')) return FlagMeaning::missing;
      if (is_always_empty(flag)) return FlagMeaning::missing;
      return has_flag(all, 'a') ? FlagMeaning::estimated : FlagMeaning::unknown;
    case 'n':
      return is_always_empty(flag) ? FlagMeaning::missing : FlagMeaning::unknown;
    case 'b':
      return has_flag(all, 'g') ? FlagMeaning::missing : FlagMeaning::unknown;
    case 'm': {
      if (is_always_empty(flag)) return FlagMeaning::missing;
      const bool has_other = has_flag(all, 'a') || has_flag(all, 'r') || has_flag(all, 'w');
      return has_flag(all, 'e') && !has_other ? FlagMeaning::measured : FlagMeaning::unknown;
    }
    default:
      return FlagMeaning::unknown;
  }
}

}  // namespace

FlagMeaning meaning_of(const FlagCount& flag, std::span<const FlagCount> all) {
  if (flag.flag.empty()) return FlagMeaning::measured;
  const FlagMeaning word = by_word(flag.flag);
  return word == FlagMeaning::unknown ? by_letter(flag, all) : word;
}

bool is_flag_header(std::string_view header) {
  const std::string lower = to_lower(header);
  return std::ranges::any_of(
      kHeaderParts, [&](std::string_view part) { return lower.find(part) != std::string::npos; });
}

bool are_flags(std::span<const std::string_view> texts) {
  return texts.size() >= 2 && std::ranges::all_of(texts, [](std::string_view text) {
           return by_word(text) != FlagMeaning::unknown;
         });
}

FlagMeanings meanings_of(std::span<const FlagCount> flags) {
  FlagMeanings meanings;
  for (const FlagCount& flag : flags) {
    switch (meaning_of(flag, flags)) {
      case FlagMeaning::missing:
        meanings.missing.push_back(flag.flag);
        break;
      case FlagMeaning::estimated:
        meanings.estimated.push_back(flag.flag);
        break;
      case FlagMeaning::unknown:
        meanings.unknown.push_back(flag);
        break;
      case FlagMeaning::measured:
        break;
    }
  }
  return meanings;
}

}  // namespace recald::table
