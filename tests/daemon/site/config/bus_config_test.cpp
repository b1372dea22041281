/// Buses and live meters in a site file: what a right one says, and a sentence for each mistake.
#include "daemon/site/config/bus_config.hpp"

#include <gmock/gmock.h>

#include "daemon/site/config/weather_sensors.hpp"
#include "tests/support/sample_site.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::daemon::bus_config_test {
namespace {

using recald::testing::edited;
using recald::testing::TemporaryFolder;
using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const std::string kSite = R"([site]
id = "tower"
timezone = "America/Chicago"

[bus.plant]
type = "tcp"
host = "10.20.0.15"
port = 1502
connect_delay = "200ms"
request_gap = "20ms"
timeout = "2s"
down_after = 5
probe_max = "10m"

[bus.cellar]
type = "rtu"
port = "ttyUSB0"
baud = 19200
format = "8N2"

[[meter]]
id = "main"
source = "modbus"
utility = "electricity"
bus = "plant"
unit = 7
map = "siemens-pac3200"
rated_kW = 400
multiplier = 40
poll = "10s"

[[meter]]
id = "cooling"
source = "modbus"
utility = "chilled_water"
bus = "cellar"
unit = 3
map = "belimo-energy-valve"
rated_kW = 900
timeout = "1500ms"

[[meter]]
id = "heat"
source = "modbus"
utility = "heating"
bus = "cellar"
unit = 3
map = "belimo-energy-valve"
energy = ["energy_heating"]
power = "power_heating"
rated_kW = 500
)";

tl::expected<SiteConfig, Problems> loaded(const std::string& text) {
  const TemporaryFolder folder;
  recald::testing::write_text(folder / "site.toml", text);
  return load_site(folder / "site.toml");
}

Problems problems_with(std::string_view from, std::string_view to) {
  const auto site = loaded(edited(kSite, from, to));
  return site ? Problems{} : site.error();
}

TEST(BusConfig, SaysWhatTheFileSays) {
  const auto site = loaded(kSite);
  ASSERT_TRUE(site.has_value()) << site.error().front();
  ASSERT_EQ(site->buses.size(), 2u);
  const BusConfig& cellar = site->buses[0];
  EXPECT_EQ(cellar.name, "cellar");
  EXPECT_EQ(cellar.endpoint, modbus::Endpoint(modbus::SerialPort{"/dev/ttyUSB0", 19'200, 8,
                                                                 modbus::Parity::none, 2}));
  EXPECT_EQ(cellar.timeout, milliseconds{0});
  const BusConfig& plant = site->buses[1];
  EXPECT_EQ(plant.endpoint,
            modbus::Endpoint(modbus::TcpEndpoint{
                .host = "10.20.0.15", .port = 1502, .connect_delay = milliseconds{200}}));
  EXPECT_EQ(plant.request_gap, milliseconds{20});
  EXPECT_EQ(plant.timeout, seconds{2});
  EXPECT_EQ(plant.down_after, 5);
  EXPECT_EQ(plant.probe_max, std::chrono::minutes{10});
  ASSERT_EQ(site->meters.size(), 3u);
  const MeterConfig& main = site->meters[0];
  ASSERT_TRUE(main.live.has_value());
  EXPECT_TRUE(main.files.empty());
  EXPECT_EQ(main.live->bus, "plant");
  EXPECT_EQ(main.live->unit, 7);
  EXPECT_EQ(main.live->poll, seconds{10});
  EXPECT_EQ(main.multiplier, 40.0);
  EXPECT_THAT(main.live->map.energy, ElementsAre("energy_import_t1", "energy_import_t2"));
  EXPECT_EQ(site->meters[1].live->timeout, milliseconds{1500});
  EXPECT_EQ(site->meters[1].live->poll, seconds{60});
  EXPECT_THAT(site->meters[1].live->map.energy, ElementsAre("energy_cooling"));
  EXPECT_THAT(site->meters[2].live->map.energy, ElementsAre("energy_heating"));
  EXPECT_EQ(site->meters[2].live->map.power, "power_heating");
}

struct Mistake {
  std::string from;
  std::string to;
  std::string said;
};

TEST(BusConfig, EveryMistakeHasItsSentence) {
  const std::vector<Mistake> mistakes{
      {"type = \"tcp\"\n", "", "[bus.plant] 'type' is missing"},
      {"type = \"tcp\"", "type = \"udp\"", "it must be one of tcp, rtu"},
      {"host = \"10.20.0.15\"\n", "", "'host' is missing"},
      {"host = \"10.20.0.15\"", "host = 10", "'host' must be text in quotes"},
      {"port = 1502", "port = 70000", "'port' is 70000; it must be between 1 and 65535"},
      {"port = 1502", "port = \"502\"", "'port' must be a number"},
      {"connect_delay = \"200ms\"", "connect_delay = 200", "'connect_delay' must be text"},
      {"connect_delay = \"200ms\"", "connect_delay = \"fast\"", "such as \"200ms\" or \"5s\""},
      {"timeout = \"2s\"", "timeout = \"-1s\"", "'timeout' is \"-1s\""},
      {"down_after = 5", "down_after = 0", "'down_after' is 0; it must be between 1 and 100"},
      {"down_after = 5", "down_afer = 5", "unknown key 'down_afer'; did you mean 'down_after'?"},
      {"port = \"ttyUSB0\"\n", "", "[bus.cellar] 'port' is missing"},
      {"baud = 19200", "baud = 12345", "'baud' is 12345; it must be one of 1200"},
      {"format = \"8N2\"", "format = \"9N1\"", "such as \"8E1\" or \"8N2\""},
      {"format = \"8N2\"", "format = \"8X1\"", "'format' is \"8X1\""},
      {"format = \"8N2\"", "format = \"8N\"", "'format' is \"8N\""},
      {"bus = \"plant\"", "bus = \"roof\"", "'bus' names 'roof', but there is no [bus.roof]"},
      {"bus = \"plant\"\n", "", "'bus' is missing"},
      {"unit = 7\n", "", "'unit' is missing: the device's Modbus address"},
      {"unit = 7", "unit = 300", "'unit' is 300; it must be between 0 and 255"},
      {"unit = 7", "unit = 1.5", "'unit' is 1.5; it must be a whole number"},
      {"map = \"siemens-pac3200\"\n", "", "'map' is missing"},
      {"map = \"siemens-pac3200\"", "map = \"siemens-pac\"", "there is no register map"},
      {"map = \"siemens-pac3200\"", "map = \"our.toml\"", "our.toml' cannot be read"},
      {"rated_kW = 400\n", "", "a live counter needs 'rated_kW'"},
      {"poll = \"10s\"", "poll = \"0s\"", "'poll' must lie between \"1s\" and \"15m\""},
      {"poll = \"10s\"", "poll = \"20m\"", "'poll' must lie between \"1s\" and \"15m\""},
      {"poll = \"10s\"", "file = \"x.csv\"", "unknown key 'file'"},
      {"energy = [\"energy_heating\"]", "energy = [\"heating\"]",
       "'energy' names 'heating', but map 'belimo-energy-valve' has"},
      {"power = \"power_heating\"", "power = \"watts\"", "'power' names 'watts'"},
      {"energy = [\"energy_heating\"]\n", "",
       "meters 'cooling' and 'heat' are the same registers of unit 3 on bus 'cellar'"},
      {"source = \"modbus\"\nutility = \"heating\"", "source = \"opc\"\nutility = \"heating\"",
       "it must be one of csv, modbus"},
  };
  for (const Mistake& mistake : mistakes) {
    SCOPED_TRACE(mistake.to);
    EXPECT_THAT(problems_with(mistake.from, mistake.to), Contains(HasSubstr(mistake.said)));
  }
}

TEST(BusConfig, AMeterWithoutACounterIsReadMoreOftenAndNeedsNoRating) {
  const std::string text = edited(edited(kSite, "energy = [\"energy_heating\"]\n", "energy = []\n"),
                                  "rated_kW = 500\n", "");
  const auto site = loaded(text);
  ASSERT_TRUE(site.has_value()) << site.error().front();
  EXPECT_EQ(site->meters[2].live->poll, seconds{15});
  EXPECT_THAT(site->meters[2].live->map.energy, IsEmpty());
  const auto seldom = loaded(text + "poll = \"3m\"\n");
  ASSERT_FALSE(seldom.has_value());
  EXPECT_THAT(seldom.error(),
              Contains(HasSubstr("'poll' must lie between \"1s\" and \"2m\": the meter has no "
                                 "counter")));
  const auto twice = loaded(text + R"(
[[meter]]
id = "again"
source = "modbus"
utility = "heating"
bus = "cellar"
unit = 3
map = "belimo-energy-valve"
energy = []
power = "power_heating"
)");
  ASSERT_FALSE(twice.has_value());
  EXPECT_THAT(twice.error(), Contains(HasSubstr("meters 'heat' and 'again' are the same")));
}

constexpr const char* kRoof = R"(
[[meter]]
id = "roof"
role = "weather"
source = "modbus"
bus = "cellar"
unit = 9
map = "sunspec-weather"
)";

TEST(BusConfig, AWeatherSensorIsNoMeter) {
  const auto site = loaded(kSite + kRoof + "poll = \"30s\"\ninterval = \"10m\"\n");
  ASSERT_TRUE(site.has_value()) << site.error().front();
  EXPECT_EQ(site->meters.size(), 3U);
  EXPECT_FALSE(site->meter_index("roof").has_value());
  ASSERT_EQ(site->sensors.size(), 1U);
  const MeterConfig& roof = site->sensors[0];
  EXPECT_EQ(roof.role, MeterRole::weather);
  EXPECT_EQ(roof.live->unit, 9);
  EXPECT_EQ(roof.live->poll, seconds{30});
  EXPECT_EQ(roof.meter.interval, std::chrono::minutes{10});
  ASSERT_TRUE(site->weather.has_value());  // without a [weather] table
  EXPECT_TRUE(site->weather->files.empty());
  ASSERT_EQ(channels_of(roof).size(), 4U);
  EXPECT_EQ(channels_of(roof)[0].id(), "roof.dry_bulb_C");
  EXPECT_EQ(find_channel(*site, "roof.wind_dir_deg")->quantity->unit, "deg");
  EXPECT_FALSE(find_channel(*site, "roof.ghi_W_m2").has_value());
  EXPECT_FALSE(find_channel(*site, "roof").has_value());
  EXPECT_EQ(loaded(kSite + kRoof)->sensors[0].live->poll, seconds{60});
}

TEST(BusConfig, EveryMistakeOfAWeatherSensorHasItsSentence) {
  const std::string site = kSite + kRoof;
  const std::vector<Mistake> mistakes{
      {"role = \"weather\"", "role = \"sub\"", "'role' is \"sub\"; it must be one of weather"},
      {"role = \"weather\"\n", "utility = \"heating\"\nrated_kW = 1\n",
       "map 'sunspec-weather' describes a weather sensor; add role = \"weather\""},
      {"role = \"weather\"\n", "role = \"weather\"\nutility = \"heating\"\n",
       "unknown key 'utility'"},
      {"map = \"sunspec-weather\"", "map = \"abb-b23\"", "map 'abb-b23' has no weather registers"},
      {"map = \"sunspec-weather\"", "map = \"sunspec-irradiance\"",
       "no weather sensor measures dry_bulb_C; add one that does, or a [weather] file"},
      {"map = \"sunspec-weather\"\n", "map = \"sunspec-weather\"\npoll = \"5m\"\n",
       "'poll' must lie between \"1s\" and \"2m\": the weather is averaged"},
      {"role = \"weather\"\nsource = \"modbus\"", "role = \"weather\"\nsource = \"csv\"",
       "name a weather file, which may grow, in [weather] file"},
      {"source = \"modbus\"\nbus = \"cellar\"\nunit = 9\nmap = \"sunspec-weather\"\n",
       "source = \"http\"\n", "a pushed weather sensor needs an 'interval'"},
      {"map = \"sunspec-weather\"\n", "map = \"sunspec-weather\"\nvalues = \"instant\"\n",
       "unknown key 'values'"},
      {"map = \"sunspec-weather\"\n",
       "map = \"sunspec-weather\"\n[weather]\nvalues = \"instant\"\n",
       "'values' describes a file, but 'file' is missing"},
      {"map = \"sunspec-weather\"\n", "map = \"sunspec-weather\"\n[weather]\nstamps = \"end\"\n",
       "'stamps' describes a file, but 'file' is missing"},
      {"id = \"roof\"", "id = \"main\"", "two meters have the id 'main'"},
      {"unit = 9", "unit = 3", "have different SunSpec models"},
  };
  for (const Mistake& mistake : mistakes) {
    SCOPED_TRACE(mistake.to);
    const auto found = loaded(edited(site, mistake.from, mistake.to));
    ASSERT_FALSE(found.has_value());
    EXPECT_THAT(found.error(), Contains(HasSubstr(mistake.said)));
  }
  EXPECT_THAT(loaded(site + edited(kRoof, "id = \"roof\"", "id = \"roof2\"")).error(),
              Contains(HasSubstr("meters 'roof' and 'roof2' are the same registers of unit 9")));
}

TEST(BusConfig, AWeatherSensorThatSendsSaysWhatItsValuesAre) {
  const std::string sender =
      "\n[[meter]]\nid = \"web\"\nrole = \"weather\"\nsource = \"http\"\ninterval = \"1h\"\n";
  EXPECT_EQ(loaded(kSite + sender)->sensors[0].values, weather::RecordedValues::mean);
  EXPECT_EQ(loaded(kSite + sender + "values = \"instant\"\n")->sensors[0].values,
            weather::RecordedValues::instant);
}

// A file is only for the time before.
TEST(BusConfig, AWeatherSensorAndAFile) {
  const auto site = loaded(kSite + kRoof + "\n[weather]\nfile = \"before.csv\"\n");
  ASSERT_TRUE(site.has_value()) << site.error().front();
  EXPECT_EQ(site->weather->files.front().filename(), "before.csv");
  const auto sun =
      loaded(edited(kSite + kRoof, "map = \"sunspec-weather\"", "map = \"sunspec-irradiance\"") +
             "\n[weather]\nfile = \"before.csv\"\n");
  EXPECT_TRUE(sun.has_value()) << sun.error().front();
}

TEST(BusConfig, SunSpecDevicesShareNoUnitWithOtherMaps) {
  const auto site = loaded(edited(kSite, "map = \"siemens-pac3200\"", "map = \"sunspec-meter\""));
  ASSERT_TRUE(site.has_value()) << site.error().front();
  EXPECT_THAT(site->meters[0].live->map.sunspec_models, ElementsAre(201, 202, 203, 204));
  EXPECT_THAT(problems_with("map = \"belimo-energy-valve\"\nrated_kW = 900",
                            "map = \"sunspec-meter\"\nrated_kW = 900"),
              Contains(HasSubstr("give both maps the same 'sunspec_models'")));
}

TEST(BusConfig, ABrokenMapIsToldWithItsLine) {
  const TemporaryFolder folder;
  recald::testing::write_text(folder / "ours.toml", "base = 0\nsource = \"x\"\nenergy = [\"e\"]\n");
  recald::testing::write_text(folder / "site.toml",
                              edited(kSite, "map = \"siemens-pac3200\"", "map = \"ours.toml\""));
  const auto site = load_site(folder / "site.toml");
  ASSERT_FALSE(site.has_value());
  EXPECT_THAT(site.error(), Contains(HasSubstr("ours.toml:")));
}

// 6.2 of the bus's arithmetic: twenty registers at 9600 baud take some 150 ms.
TEST(BusConfig, PollTimeOfASerialLine) {
  const auto site = loaded(kSite);
  BusConfig line{.name = "line", .endpoint = modbus::SerialPort{.baud = 9600}};
  LiveMeterConfig meter = *site->meters[0].live;
  meter.map.power.reset();
  meter.map.energy = {"energy_import_t1", "energy_import_t2"};  // 8 registers, one read
  // (8 + 5 + 16 + 7) characters of 11 bits at 9600 baud: 41.25 ms, and 60 ms of thinking.
  EXPECT_EQ(poll_time(line, meter), milliseconds{102});
  EXPECT_EQ(poll_time({.endpoint = modbus::TcpEndpoint{}, .request_gap = milliseconds{25}}, meter),
            milliseconds{45});
}

}  // namespace
}  // namespace recald::daemon::bus_config_test
