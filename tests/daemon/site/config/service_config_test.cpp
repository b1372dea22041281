/// [http], [modbus] and [recalibration] of a site file.
#include "daemon/site/config/service/service_config.hpp"

#include <gmock/gmock.h>

namespace recald::daemon::service_config_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

struct ReadHttp {
  HttpConfig config;
  Problems problems;
};

ReadHttp http(const char* text) {
  ReadHttp read;
  const toml::table table = toml::parse(text);
  TomlReader reader{table, "site.toml", "[http]", read.problems};
  read.config = read_http(reader, "/etc/recald/site.toml");
  return read;
}

struct ReadModbus {
  ModbusConfig config;
  Problems problems;
};

ReadModbus modbus(const std::string& text) {
  ReadModbus read;
  const toml::table table = toml::parse(text);
  TomlReader reader{table, "site.toml", "[modbus]", read.problems};
  read.config = read_modbus(reader);
  return read;
}

Problems recalibration_problems(const char* text) {
  Problems problems;
  const toml::table table = toml::parse(text);
  TomlReader reader{table, "site.toml", "[recalibration]", problems};
  static_cast<void>(read_recalibration(reader, "/etc/recald/site.toml"));
  return problems;
}

TEST(HttpConfig, StaysOnThisMachineUnlessTold) {
  const auto [config, problems] = http("");
  EXPECT_THAT(problems, IsEmpty());
  EXPECT_EQ(config.address, "127.0.0.1");
  EXPECT_EQ(config.port, 8080);
  EXPECT_TRUE(config.token_file.empty());
}

TEST(HttpConfig, ReadsAddressPortAndFiles) {
  const auto [config, problems] = http(
      "listen = \"[::]:443\"\ntoken_file = \"token\"\n"
      "certificate_file = \"/etc/cert.pem\"\nkey_file = \"key.pem\"");
  EXPECT_THAT(problems, IsEmpty());
  EXPECT_EQ(config.address, "::");
  EXPECT_EQ(config.port, 443);
  EXPECT_EQ(config.token_file, "/etc/recald/token");
  EXPECT_EQ(config.certificate_file, "/etc/cert.pem");
  EXPECT_EQ(config.key_file, "/etc/recald/key.pem");
}

TEST(HttpConfig, ThisMachineHasSeveralNames) {
  for (const char* text : {"listen = \"localhost:1\"", "listen = \"[::1]:1\"",
                           "listen = \"127.8.0.1:1\"", "listen = \"127.0.0.1:0\""}) {
    EXPECT_THAT(http(text).problems, IsEmpty()) << text;
  }
}

TEST(HttpConfig, OtherMachinesNeedATokenAndTls) {
  for (const char* text :
       {"listen = \"0.0.0.0:80\"", "listen = \"[::]:80\"",
        "listen = \"10.0.0.1:80\"\ntoken_file = \"token\"",
        "listen = \"10.0.0.1:80\"\ncertificate_file = \"c\"\nkey_file = \"k\""}) {
    EXPECT_THAT(http(text).problems, ElementsAre(HasSubstr("opens"))) << text;
  }
}

TEST(HttpConfig, HasTokensWithRightsAndNames) {
  const auto [config, problems] = http(
      "listen = \"10.0.0.1:80\"\nnames = \"Tower.example.org\"\ncertificate_file = \"c\"\n"
      "key_file = \"k\"\n[[token]]\nfile = \"a\"\nrights = [\"read\", \"push\"]\n"
      "[[token]]\nfile = \"b\"\nrights = \"operate\"");
  EXPECT_THAT(problems, IsEmpty());
  EXPECT_THAT(config.names, ElementsAre("tower.example.org"));
  ASSERT_EQ(config.tokens.size(), 2U);
  EXPECT_EQ(config.tokens[0].file, "/etc/recald/a");
  EXPECT_THAT(config.tokens[0].rights, ElementsAre("read", "push"));
  EXPECT_THAT(config.tokens[1].rights, ElementsAre("operate"));
  EXPECT_THAT(http("[[token]]\nfile = \"a\"\nrights = \"write\"").problems,
              ElementsAre(HasSubstr("'rights' must be of \"read\", \"push\" (readings)")));
  EXPECT_THAT(http("[[token]]\nfile = \"a\"").problems,
              ElementsAre(HasSubstr("'rights' is needed")));
  EXPECT_THAT(http("[[token]]\nrights = \"read\"").problems, ElementsAre(HasSubstr("file")));
  for (const char* wrong : {"https://a", "a:80", "", "a b", "-a"}) {
    EXPECT_THAT(http(("names = \"" + std::string{wrong} + "\"").c_str()).problems,
                ElementsAre(HasSubstr("'names'")))
        << wrong;
  }
}

TEST(HttpConfig, OriginsAreAsBrowsersSendThem) {
  const auto [config, problems] =
      http("allow_origin = [\"https://bms.example.org\", \"http://10.0.0.7:8081\"]");
  EXPECT_THAT(problems, IsEmpty());
  EXPECT_THAT(config.origins, ElementsAre("https://bms.example.org", "http://10.0.0.7:8081"));
  for (const char* wrong :
       {"bms.example.org", "https://bms.example.org/", "https://BMS.example.org",
        "https://bms.example.org:443", "http://a:80", "https://u@a", "*"}) {
    EXPECT_THAT(http((std::string{"allow_origin = \""} + wrong + "\"").c_str()).problems,
                ElementsAre(HasSubstr("'allow_origin' has")))
        << wrong;
  }
}

TEST(HttpConfig, MistakesAreNamedWithTheirKey) {
  for (const char* text :
       {"listen = \"8080\"", "listen = \":8080\"", "listen = \"127.0.0.1:\"",
        "listen = \"127.0.0.1:70000\"", "listen = \"::1:8080\"", "listen = \"127.0.0.1:80a\""}) {
    EXPECT_THAT(http(text).problems, ElementsAre(HasSubstr("site.toml:1: [http] 'listen' is")))
        << text;
  }
  EXPECT_THAT(http("certificate_file = \"c\"").problems, ElementsAre(HasSubstr("TLS needs both")));
  EXPECT_THAT(http("key_file = \"c\"").problems, ElementsAre(HasSubstr("TLS needs both")));
  EXPECT_THAT(http("token = \"c\"").problems, ElementsAre(HasSubstr("[[http.token]]")));
  EXPECT_THAT(http("listen = 8080").problems, ElementsAre(HasSubstr("listen")));
  EXPECT_THAT(http("token_file = \"$RECALD_NO_SUCH/token\"").problems,
              ElementsAre(HasSubstr("'token_file' begins with $RECALD_NO_SUCH")));
}

TEST(ModbusConfig, ReadsAddressAndPort) {
  const auto [config, problems] = modbus("listen = \"10.20.0.5:502\"");
  EXPECT_THAT(problems, IsEmpty());
  EXPECT_EQ(config.address, "10.20.0.5");
  EXPECT_EQ(config.port, 502);
  EXPECT_EQ(modbus("listen = \"[fd00::5]:1502\"").config.address, "fd00::5");
  EXPECT_EQ(modbus("listen = \"localhost:0\"").config.address, "127.0.0.1");
}

TEST(ModbusConfig, OneInterfaceIsNamed) {
  for (const char* all : {"0.0.0.0:502", "[::]:502", "[0:0::0]:502"}) {
    EXPECT_THAT(modbus("listen = \"" + std::string{all} + "\"").problems,
                ElementsAre(HasSubstr("which is every interface")))
        << all;
  }
  for (const char* wrong : {"502", "10.20.0.5", "10.20.0.5:", ":502", "plant-room:502",
                            "10.20.0:502", "10.20.0.5:70000", "fd00::5:502"}) {
    EXPECT_THAT(modbus("listen = \"" + std::string{wrong} + "\"").problems,
                ElementsAre(HasSubstr("site.toml:1: [modbus] 'listen' is")))
        << wrong;
  }
  EXPECT_THAT(modbus("").problems, ElementsAre(HasSubstr("listen")));
  EXPECT_THAT(modbus("listen = \"\"").problems, ElementsAre(HasSubstr("listen")));
  EXPECT_THAT(modbus("listen = \"10.20.0.5:502\"\nunit = 1").problems,
              ElementsAre(HasSubstr("unit")));
}

TEST(RecalibrationConfig, MistakesAreNamedWithTheirKey) {
  EXPECT_THAT(recalibration_problems("schedule = \"monthly\"\nmonths = 12"), IsEmpty());
  EXPECT_THAT(recalibration_problems("schedule = \"weekly\""),
              ElementsAre(HasSubstr("site.toml:1: [recalibration] 'schedule'")));
  EXPECT_THAT(recalibration_problems("months = 5"), ElementsAre(HasSubstr("months")));
  EXPECT_THAT(recalibration_problems("months = 6.5"), ElementsAre(HasSubstr("months")));
  EXPECT_THAT(recalibration_problems("month = 12"), ElementsAre(HasSubstr("months")));
}

}  // namespace
}  // namespace recald::daemon::service_config_test
