#include "daemon/site/setup/load_parts.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "core/text/ascii.hpp"

namespace recald::daemon {
namespace {

constexpr double kAtOnceMax = 0.02;      // of the intervals: where one tariff ends in an interval
constexpr std::size_t kSamplesMin = 10;  // with energy, of each tariff

/// Words for the parts of a load, a family each. "*" stands for a number from 1 on.
struct PartFamily {
  std::array<std::string_view, 8> words;
  bool are_phases = false;
};
constexpr std::array kFamilies{
    PartFamily{{"day", "night", "evening"}},
    PartFamily{{"dag", "nacht"}},
    PartFamily{{"tag", "nacht"}},
    PartFamily{{"jour", "nuit"}},
    PartFamily{{"giorno", "notte"}},
    PartFamily{{"dia", "noche"}},
    PartFamily{{"hp", "hc", "hpe", "hce", "pointe"}},
    PartFamily{{"hph", "hch", "hpb", "hcb", "hpete", "hcete"}},
    PartFamily{{"pleines", "creuses"}},
    PartFamily{{"ht", "nt"}},
    PartFamily{{"normaal", "laag", "hoog", "dal", "piek"}},
    PartFamily{{"normal", "high", "low", "peak", "offpeak", "shoulder"}},
    PartFamily{{"punta", "llano", "valle"}},
    PartFamily{{"t*"}},
    PartFamily{{"tariff*"}},
    PartFamily{{"tarif*"}},
    PartFamily{{"tarief*"}},
    PartFamily{{"rate*"}},
    PartFamily{{"f*"}},
    PartFamily{{"p*"}},
    PartFamily{{"l*"}, true},
    PartFamily{{"phase*"}, true},
};

bool is_word_byte(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return std::isalnum(byte) != 0 || byte >= 0x80;
}

bool matches(std::string_view word, std::string_view pattern) {
  if (pattern.empty() || !pattern.ends_with('*')) return !pattern.empty() && word == pattern;
  pattern.remove_suffix(1);
  if (!word.starts_with(pattern)) return false;
  word.remove_prefix(pattern.size());
  return word.size() == 1 && word.front() >= '1' && word.front() <= '9';
}

/// A number behind "tariff", "rate" or "phase" belongs to it; so does the end of an OBIS code,
/// whose rates are 1.8.1 and 1.8.2.
std::vector<std::string> words_of(std::string_view name) {
  std::vector<std::string> words;
  std::string word;
  const auto end_word = [&] {
    if (!word.empty()) words.push_back(std::exchange(word, ""));
  };
  for (const char c : name) {
    if (is_word_byte(c)) {
      word += to_lower(c);
    } else {
      end_word();
    }
  }
  end_word();
  const std::set<std::string_view> counted{"tariff", "tarif", "tarief", "rate", "phase"};
  for (std::size_t i = 0; i + 1 < words.size(); ++i) {
    if (!counted.contains(words[i]) || words[i + 1].size() != 1) continue;
    words[i] += words[i + 1];
    words.erase(words.begin() + static_cast<std::ptrdiff_t>(i) + 1);
  }
  for (std::size_t i = 0; i + 2 < words.size(); ++i) {
    const bool is_energy = (words[i] == "1" || words[i] == "2") && words[i + 1] == "8";
    if (is_energy && words[i + 2].size() == 1 && words[i + 2] != "0") words[i + 2].insert(0, "t");
  }
  if (const auto off = std::ranges::find(words, "off"); off != words.end()) {
    const auto next = std::next(off);
    if (next != words.end() && *next == "peak") {
      *off = "offpeak";
      words.erase(next);
    }
  }
  return words;
}

/// The families of a word. "nacht" is of two; meters of one load have one in common.
std::vector<std::size_t> families_of(const std::string& word) {
  std::vector<std::size_t> families;
  for (std::size_t i = 0; i < kFamilies.size(); ++i) {
    if (std::ranges::any_of(kFamilies[i].words,
                            [&](std::string_view one) { return matches(word, one); })) {
      families.push_back(i);
    }
  }
  return families;
}

/// A name taken apart.
struct PartName {
  std::string part;  ///< "night", "t1"
  std::string stem;  ///< The other words.
};

std::optional<PartName> part_of(std::string_view name) {
  std::vector<std::string> words = words_of(name);
  const auto part = std::find_if(words.rbegin(), words.rend(), [](const std::string& word) {
    return !families_of(word).empty();
  });
  if (part == words.rend()) return {};
  PartName found{.part = *part, .stem = {}};
  words.erase(std::next(part).base());
  for (const std::string& word : words) found.stem += (found.stem.empty() ? "" : " ") + word;
  return found;
}

bool are_alike(const SurveyedMeter& a, const SurveyedMeter& b) {
  return a.utility.value == b.utility.value && a.interval == b.interval &&
         a.is_register == b.is_register && a.unit.value == b.unit.value;
}

/// Whether hardly any interval has a row of both, or energy of both.
bool take_turns(const SurveyedMeter& a, const SurveyedMeter& b) {
  const auto& of_a = a.samples.kept();
  const auto& of_b = b.samples.kept();
  const auto with_energy = [](const auto& kept) {
    return static_cast<std::size_t>(
        std::ranges::count_if(kept, [](const auto& one) { return one.second != 0.0; }));
  };
  const auto common = static_cast<std::size_t>(
      std::ranges::count_if(of_a, [&](const auto& one) { return of_b.contains(one.first); }));
  const std::size_t fewer = std::min(of_a.size(), of_b.size());
  const bool have_own_rows = static_cast<double>(common) <= kAtOnceMax * static_cast<double>(fewer);
  if (have_own_rows && fewer >= kSamplesMin) return true;
  const std::size_t least = std::min(with_energy(of_a), with_energy(of_b));
  if (least < kSamplesMin) return false;
  std::size_t both = 0;
  for (const auto& [start, value] : of_a) {
    const auto other = of_b.find(start);
    if (value != 0.0 && other != of_b.end() && other->second != 0.0) ++both;
  }
  return static_cast<double>(both) <= kAtOnceMax * static_cast<double>(least);
}

/// Whether readings are those of parts of one load.
bool agree(std::span<const SurveyedMeter> meters, const std::vector<std::size_t>& parts,
           bool are_phases) {
  const SurveyedMeter& first = meters[parts.front()];
  const auto all = [&](auto is) {
    return std::ranges::all_of(parts, [&](std::size_t part) { return is(meters[part]); });
  };
  if (!all([&](const SurveyedMeter& one) { return are_alike(first, one); })) return false;
  // A site file lists rows of one column, or columns of one row.
  if (!all([&](const SurveyedMeter& one) { return one.column == first.column; }) &&
      !all([&](const SurveyedMeter& one) { return one.name_in_file == first.name_in_file; })) {
    return false;
  }
  if (are_phases) return parts.size() == 3;
  if (first.is_register) return true;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    for (std::size_t k = i + 1; k < parts.size(); ++k) {
      if (!take_turns(meters[parts[i]], meters[parts[k]])) return false;
    }
  }
  return true;
}

/// Whether a meter of the export is the sum of these.
bool have_a_total(std::span<const SurveyedMeter> meters, const std::vector<std::size_t>& parts) {
  std::vector<const SampledReadings*> samples;
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < meters.size(); ++i) {
    if (!are_alike(meters[parts.front()], meters[i])) continue;
    samples.push_back(&meters[i].samples);
    places.push_back(i);
  }
  return std::ranges::any_of(find_sums(samples), [&](const FoundSum& sum) {
    return std::ranges::any_of(sum.parts, [&](std::size_t part) {
      return std::ranges::find(parts, places[part]) != parts.end();
    });
  });
}

/// Parts of one stem whose words are of one family, each once.
std::vector<std::size_t> of_one_family(
    const std::vector<std::pair<std::size_t, std::string>>& named, bool& are_phases) {
  for (const std::size_t family : families_of(named.front().second)) {
    std::set<std::string> words;
    std::vector<std::size_t> parts;
    for (const auto& [meter, part] : named) {
      const auto families = families_of(part);
      if (std::ranges::find(families, family) == families.end()) break;
      if (!words.insert(part).second) break;
      parts.push_back(meter);
    }
    if (parts.size() != named.size() || parts.size() < 2) continue;
    are_phases = kFamilies[family].are_phases;
    return parts;
  }
  return {};
}

std::string name_of_load(std::span<const SurveyedMeter> meters,
                         const std::vector<std::size_t>& parts, const std::string& stem) {
  if (!stem.empty()) return stem;
  std::string name;
  for (const std::size_t part : parts) name += (name.empty() ? "" : " + ") + meters[part].name;
  return name;
}

}  // namespace

std::vector<FoundLoad> find_loads(std::span<const SurveyedMeter> meters) {
  std::map<std::string, std::vector<std::pair<std::size_t, std::string>>> by_stem;
  for (std::size_t i = 0; i < meters.size(); ++i) {
    const auto part = part_of(meters[i].name);
    if (part) by_stem[part->stem].emplace_back(i, part->part);
  }
  std::vector<FoundLoad> loads;
  for (const auto& [stem, named] : by_stem) {
    bool are_phases = false;
    const std::vector<std::size_t> parts = of_one_family(named, are_phases);
    if (parts.empty() || !agree(meters, parts, are_phases) || have_a_total(meters, parts)) continue;
    std::string because = are_phases ? "the phases of one load, added up"
                          : meters[parts.front()].is_register
                              ? "registers of tariffs by their names, added up"
                              : "tariffs of one load, which take turns";
    loads.push_back({parts, name_of_load(meters, parts, stem), std::move(because)});
  }
  return loads;
}

void join_loads(std::span<const FoundLoad> loads, std::vector<SurveyedMeter>& meters) {
  std::set<std::size_t> joined;
  for (const FoundLoad& load : loads) {
    SurveyedMeter& first = meters[load.parts.front()];
    first.name = load.name;
    first.parts_because = load.because;
    for (const std::size_t part : load.parts) {
      if (part == load.parts.front()) continue;
      const SurveyedMeter& other = meters[part];
      RegisterVerdict& shown = first.as_register;
      shown.rated_kW = std::max(shown.rated_kW, other.as_register.rated_kW);
      if (other.name_in_file != first.name_in_file)
        first.further_names.push_back(other.name_in_file);
      if (other.column != first.column) first.further_columns.push_back(other.column);
      joined.insert(part);
    }
  }
  std::size_t place = 0;
  std::erase_if(meters, [&](const SurveyedMeter&) { return joined.contains(place++); });
}

}  // namespace recald::daemon
