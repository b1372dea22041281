/// Register maps: those that are shipped decode what their documents say, and one sentence for each
/// mistake in a map of one's own.
#include "daemon/site/config/register_map_file.hpp"

#include <gmock/gmock.h>

#include <set>

#include "tests/support/sample_site.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::daemon::register_map_file_test {
namespace {

using recald::testing::edited;
using ::testing::Contains;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using ::testing::StartsWith;

const std::string kMap = R"(title = "A meter of ours"
source = "its manual"
trust = "one_source"
base = 1
fc = 4
order = "CDAB"
registers_max = 60
gap_max = 4
energy = ["energy"]
power = "power"
identity = ["serial"]

[register.energy]
at = 101
type = "u32"
scale = 0.1
unit = "kWh"
modulus = 1e8
absent = "0xFFFFFFFF"

[register.power]
at = 201
type = "i16"
order = "ABCD"
unit = "W"
scale_factor = "tens"

[register.tens]
at = 202
type = "i16"

[register.serial]
at = 1
type = "u32"

[register.status]
at = 300
type = "u16"
mask = "0x00FF"

[[golden]]
at = 101
words = "86A0 0001"
values = { energy = 10000 }
)";

Problems problems_of(const std::string& text) {
  const auto file = parse_register_map(text, "ours");
  return file ? Problems{} : file.error();
}

/// The problems of the sample with `from` replaced by `to`.
Problems problems_with(std::string_view from, std::string_view to) {
  return problems_of(edited(kMap, from, to));
}

TEST(RegisterMapFile, SaysWhatTheFileSays) {
  const auto file = parse_register_map(kMap, "ours");
  ASSERT_TRUE(file.has_value()) << file.error().front();
  const modbus::RegisterMap& map = file->map;
  EXPECT_EQ(map.name, "ours");
  EXPECT_EQ(map.title, "A meter of ours");
  EXPECT_EQ(map.trust, modbus::Trust::one_source);
  EXPECT_EQ(map.function, modbus::Function::read_input_registers);
  EXPECT_EQ(map.limits.registers_max, 60);
  EXPECT_EQ(map.limits.gap_max, 4);
  EXPECT_FALSE(map.limits.one_request_per_field);
  EXPECT_THAT(map.energy, ElementsAre("energy"));
  EXPECT_EQ(map.power, "power");
  EXPECT_THAT(map.identity, ElementsAre("serial"));
  const modbus::RegisterField* energy = map.find("energy");
  ASSERT_NE(energy, nullptr);
  EXPECT_EQ(energy->address, 100);  // base 1
  EXPECT_EQ(energy->format.order, modbus::WordOrder::CDAB);
  EXPECT_EQ(energy->format.absent, 0xFFFF'FFFFu);
  EXPECT_EQ(energy->modulus, 1e8);
  EXPECT_EQ(map.find("power")->format.order, modbus::WordOrder::ABCD);
  EXPECT_EQ(map.find("power")->scale_factor, "tens");
  EXPECT_EQ(map.find("status")->format.mask, 0x00FFu);
  EXPECT_EQ(map.find("voltage"), nullptr);
}

// Every shipped map decodes the registers that its document describes, and each register that is
// energy, power or weather is among them.
TEST(RegisterMapFile, ShippedMapsDecodeTheirGoldenReplies) {
  EXPECT_THAT(shipped_register_maps(), SizeIs(13));
  for (const std::string_view name : shipped_register_maps()) {
    SCOPED_TRACE(name);
    const auto file = parse_register_map(*shipped_register_map(name), std::string{name});
    ASSERT_TRUE(file.has_value()) << file.error().front();
    const modbus::RegisterMap& map = file->map;
    EXPECT_NE(map.trust, modbus::Trust::local);
    std::set<std::string> decoded;
    for (const GoldenReply& golden : file->golden) {
      const modbus::PlannedRead read{map.function, golden.address,
                                     static_cast<std::uint16_t>(golden.words.size()), [&] {
                                       std::vector<std::size_t> inside;
                                       for (std::size_t i = 0; i < map.fields.size(); ++i) {
                                         if (golden.values.contains(map.fields[i].name))
                                           inside.push_back(i);
                                       }
                                       return inside;
                                     }()};
      for (const modbus::FieldValue& found : decode_read(map.fields, read, golden.words)) {
        const std::string& field = map.fields[found.field].name;
        ASSERT_TRUE(found.value.has_value()) << field;
        EXPECT_DOUBLE_EQ(found.value->value, golden.values.at(field)) << field;
        decoded.insert(field);
      }
    }
    for (const std::string& energy : map.energy) EXPECT_THAT(decoded, Contains(energy));
    for (const std::string& weather : map.weather) EXPECT_THAT(decoded, Contains(weather));
    if (map.power) {
      EXPECT_THAT(decoded, Contains(*map.power));
    }
    EXPECT_TRUE(map.power.has_value() || !map.weather.empty());
  }
}

// em24_total_vs_partial: the two EM24 share a name and not a map. Of the RS-485 one the counter at
// 0x42 is the partial one, which people reset; of the Ethernet one 0x42 is no energy at all.
TEST(RegisterMapFile, Em24TotalVsPartial) {
  const std::pair<const char*, int> totals[] = {{"carlo-gavazzi-em24-din", 0x3E},
                                                {"carlo-gavazzi-em24-e1", 0x34}};
  for (const auto& [name, address] : totals) {
    const auto map = find_register_map(name, ".");
    ASSERT_TRUE(map.has_value()) << map.error().front();
    ASSERT_THAT(map->energy, SizeIs(1));
    EXPECT_EQ(map->find(map->energy.front())->address, address) << name;
    for (const modbus::RegisterField& field : map->fields) {
      EXPECT_FALSE(field.address <= 0x42 && 0x42 < field.end()) << name << ", " << field.name;
    }
  }
}

TEST(RegisterMapFile, ASiteNamesAShippedMapOrAFileBesideIt) {
  const recald::testing::TemporaryFolder folder;
  recald::testing::write_text(folder / "ours.toml", kMap);
  EXPECT_EQ(find_register_map("abb-b23", folder.path())->fields.size(), 3u);
  EXPECT_EQ(find_register_map("ours.toml", folder.path())->title, "A meter of ours");
  EXPECT_EQ(find_register_map((folder / "ours.toml").string(), "/nowhere")->title,
            "A meter of ours");
  EXPECT_THAT(find_register_map("abb-b32", folder.path()).error(),
              ElementsAre(HasSubstr("there is no register map 'abb-b32', did you mean 'abb-b23'")));
  EXPECT_THAT(find_register_map("theirs.toml", folder.path()).error(),
              ElementsAre(HasSubstr("theirs.toml' cannot be read")));
}

struct Mistake {
  std::string from;
  std::string to;
  std::string said;
};

TEST(RegisterMapFile, EveryMistakeHasItsSentence) {
  const std::vector<Mistake> mistakes{
      {"source = \"its manual\"\n", "", "ours.toml:1: 'source' is missing"},
      {"base = 1\n", "", "'base' is missing: 0 if the document's addresses are those on the wire"},
      {"base = 1", "base = 2", "'base' is 2; it must be between 0 and 1"},
      {"base = 1", "base = \"one\"", "'base' must be a number"},
      {"fc = 4", "fc = 6", "'fc' is 6; it must be between 3 and 4"},
      {"fc = 4", "fc = 3.5", "'fc' is 3.5; it must be a whole number"},
      {"order = \"CDAB\"", "order = \"little\"", "'little' is no word order"},
      {"order = \"ABCD\"", "order = 1", "'order' must be text in quotes"},
      {"registers_max = 60", "registers_max = 126", "it must be between 4 and 125"},
      {"gap_max = 4", "gap_max = -1", "'gap_max' is -1"},
      {"trust = \"one_source\"", "trust = \"sure\"", "it must be one of two_sources"},
      {"energy = [\"energy\"]", "energy = [\"import\"]", "there is no [register.import]"},
      {"energy = [\"energy\"]", "energy = [\"power\"]", "it must be an energy, such as kWh"},
      {"power = \"power\"", "power = \"energy\"", "it must be a power, such as kW"},
      {"identity = [\"serial\"]", "identity = [\"number\"]", "there is no [register.number]"},
      {"energy = [\"energy\"]\npower = \"power\"\n", "", "has neither 'energy' nor 'power'"},
      {"at = 101\ntype = \"u32\"\nscale", "type = \"u32\"\nscale", "'at' is missing"},
      {"at = 101\ntype", "at = 0\ntype", "'at' is 0; with base 1 and 2 registers"},
      {"at = 101\ntype", "at = 65536\ntype", "'at' is 65536; with base 1 and 2 registers"},
      {"at = 101\ntype", "at = 1.5\ntype", "'at' is 1.5; it must be a whole number"},
      {"type = \"u32\"\nscale", "type = \"uint\"\nscale", "'uint' is no register type"},
      {"type = \"u32\"\nscale", "scale", "'type' is missing"},
      {"scale = 0.1", "scale = 0", "'scale' is 0; every value would be 0"},
      {"scale = 0.1", "scale = \"0.1\"", "'scale' must be a number"},
      {"modulus = 1e8", "modulus = -1", "'modulus' is -1"},
      {"absent = \"0xFFFFFFFF\"", "absent = \"all\"", "write its bits as \"0x8000\""},
      {"absent = \"0xFFFFFFFF\"", "absent = \"0x1FFFFFFFF\"", "more than the type's 32 bits"},
      {"absent = \"0xFFFFFFFF\"", "absent = 65535", "'absent' must be text in quotes"},
      {"mask = \"0x00FF\"", "mask = \"0x1FFFF\"", "more than the type's 16 bits"},
      {"type = \"u16\"\nmask", "type = \"i16\"\nmask", "'mask' works on u16, u32 and u64"},
      {"scale_factor = \"tens\"", "scale_factor = \"ten\"", "there is no [register.ten]"},
      {"unit = \"kWh\"", "units = \"kWh\"", "unknown key 'units'; did you mean 'unit'?"},
      {"gap_max = 4", "gap_mx = 4", "unknown key 'gap_mx'; did you mean 'gap_max'?"},
      {"words = \"86A0 0001\"", "words = \"86A00001\"", "four hexadecimal digits each"},
      {"words = \"86A0 0001\"", "words = \"86A0 000G\"", "four hexadecimal digits each"},
      {"words = \"86A0 0001\"\n", "", "'words' is missing"},
      {"{ energy = 10000 }", "{ enery = 10000 }", "there is no [register.enery]"},
      {"values = { energy = 10000 }\n", "", "'values' is missing"},
      {"gap_max = 4", "sunspec_models = [\"2o3\"]", "write numbers such as \"203\""},
      {"base = 1", "base = ", "ours.toml:4: not valid TOML"},
      {"[[golden]]", "[{", "not valid TOML"},  // an assertion of the parser, where these are on
      {"scale = 0.1", "scale = inf", "'scale' is inf; it must be a finite number"},
      {"energy = [\"energy\"]", "energy = [\"energy\", \"energy\"]",
       "'energy' names 'energy' twice, so it would count twice"},
      {"energy = [\"energy\"]\npower = \"power\"\n", "energy = []\n", "'energy' is empty"},
      {"at = 202\ntype = \"i16\"", "at = 202\ntype = \"i16\"\nscale_factor = \"serial\"",
       "[register.power] 'scale_factor' names 'tens', which itself has a 'scale_factor'"},
      {"scale_factor = \"tens\"", "scale_factor = \"power\"",
       "[register.power] 'scale_factor' names 'power'"},
      {"at = 202", "at = 302", "must be read together and span 102 registers; the device gives 60"},
      {"source = \"its manual\"", "source = \"\"", "'source' is empty"},
      {"trust = \"one_source\"", "trust = \"one\\u001B[2J\"", "'trust' is \"one\\x1B[2J\""},
  };
  for (const Mistake& mistake : mistakes) {
    SCOPED_TRACE(mistake.to);
    const Problems problems = problems_with(mistake.from, mistake.to);
    EXPECT_THAT(problems, Contains(HasSubstr(mistake.said)));
    EXPECT_THAT(problems, Each(StartsWith("ours.toml:")));
  }
  EXPECT_THAT(problems_of("base = 0\nsource = \"x\"\n"),
              Contains(HasSubstr("there is no [register.NAME]")));
  EXPECT_THAT(problems_of(kMap), IsEmpty());
}

const std::string kStation = R"(source = "its manual"
base = 0
weather = ["dry_bulb_C", "ghi_W_m2"]

[register.dry_bulb_C]
at = 1
type = "i16"
scale = 0.5555556
offset = -17.777778
unit = "degC"

[register.ghi_W_m2]
at = 2
type = "u16"
unit = "W/m2"
)";

TEST(RegisterMapFile, AWeatherSensorNamesWhatItMeasures) {
  const auto file = parse_register_map(kStation, "ours");
  ASSERT_TRUE(file.has_value()) << file.error().front();
  EXPECT_THAT(file->map.weather, ElementsAre("dry_bulb_C", "ghi_W_m2"));
  EXPECT_THAT(metered_fields(file->map), SizeIs(2));
  const std::vector<Mistake> mistakes{
      {"\"dry_bulb_C\", \"ghi_W_m2\"", "\"dry_bulb_C\", \"dew_point_C\"",
       "'weather' names 'dew_point_C'; a weather sensor measures degC (dry_bulb_C), %"},
      {"[register.ghi_W_m2]", "[register.sun]", "there is no [register.ghi_W_m2]"},
      {"unit = \"degC\"", "unit = \"F\"",
       "'weather' names 'dry_bulb_C', whose unit is \"F\"; it must be \"degC\""},
      {"weather = [\"dry_bulb_C\", \"ghi_W_m2\"]\n", "",
       "has neither 'energy' nor 'power' nor 'weather'"},
  };
  for (const Mistake& mistake : mistakes) {
    SCOPED_TRACE(mistake.to);
    EXPECT_THAT(problems_of(edited(kStation, mistake.from, mistake.to)),
                Contains(HasSubstr(mistake.said)));
  }
}

TEST(RegisterMapFile, SeveralMistakesAreAllSaid) {
  EXPECT_THAT(problems_of(edited(edited(kMap, "fc = 4", "fc = 5"), "scale = 0.1", "scale = 0")),
              SizeIs(2));
}

}  // namespace
}  // namespace recald::daemon::register_map_file_test
