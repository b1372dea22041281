#include "adapters/record/files.hpp"

#include <gmock/gmock.h>

#include "tests/adapters/record/record_fixture.hpp"

namespace recald::record {
namespace {

using ::testing::ElementsAre;

const std::string kLong(100'000, 'x');

TEST(RecordFiles, APageIsCutAroundItsLongScripts) {
  const std::string head = "<html><script>short()</script><script type=\"application/json\">" +
                           kLong + "</script><script>";
  const std::string tail = "</script><p>text</p>";
  EXPECT_THAT(parts_of(head + kLong + tail), ElementsAre(head, kLong, tail));
  const std::string between = "</script><hr><script>";
  EXPECT_THAT(parts_of(head + kLong + between + kLong + tail),
              ElementsAre(head, kLong, between, kLong, tail));
  for (const std::string& whole :
       {std::string{}, std::string{"<script>"}, kLong, head, head + kLong, head + "f()" + tail}) {
    EXPECT_THAT(parts_of(whole), ElementsAre(whole));
  }
}

TEST_F(Record, AScriptOfManyPagesIsStoredOnce) {
  const auto page = [](const std::string& text) {
    return text + std::string{"\0\xff", 2} + "<script>" + kLong + "</script>" + text;
  };
  const std::map<std::string, std::string> files{
      {"a.html", page("a")}, {"b.html", page("b")}, {"c.json", "{}"}};
  const auto sums = connection_->transaction([&]() -> Result<void> {
    const auto put = put_files(*connection_, files);
    if (!put) return tl::unexpected(put.error());
    EXPECT_EQ(*put_files(*connection_, files), *put);
    for (const auto& [name, sum] : *put) {
      const auto read = connection_->run("SELECT bytes FROM whole_file WHERE sha256 = $1", {sum});
      EXPECT_EQ(read->bytes(0, 0), files.at(name)) << name;
    }
    return {};
  });
  ASSERT_TRUE(sums) << sums.error().message;
  EXPECT_EQ(
      ask("SELECT count(*), sum(length(bytes)) / 100000 FROM file WHERE bytes IS NOT NULL AND "
          "length(bytes) >= 100000"),
      "1|1\n");
  EXPECT_EQ(ask("SELECT count(*) FROM file_part"), "6\n");
}

}  // namespace
}  // namespace recald::record
