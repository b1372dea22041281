#include "adapters/csv/line_reader.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <string>
#include <vector>

#include "tests/support/temporary_folder.hpp"

namespace recald::csv::line_reader_test {
namespace {

struct Seen {
  std::string text;
  bool terminated;
  bool operator==(const Seen&) const = default;
};

/// Hands out `text` in pieces of `piece` bytes.
ByteSource in_pieces(std::string text, std::size_t piece) {
  return [text = std::move(text), piece, at = std::size_t{0}](
             char* buffer, std::size_t size) mutable -> Result<std::size_t> {
    const std::size_t got = std::min({piece, size, text.size() - at});
    text.copy(buffer, got, at);
    at += got;
    return got;
  };
}

std::vector<Seen> lines_of(ByteSource source) {
  LineReader reader{std::move(source)};
  std::vector<Seen> seen;
  Line line{};
  while (reader.next(line)) seen.push_back({std::string{line.text}, line.terminated});
  EXPECT_FALSE(reader.error().has_value());
  return seen;
}

TEST(LineReader, LineEndsAndMarkWhateverThePieces) {
  const std::string text =
      "\xEF\xBB\xBF"
      "first\r\nsecond\n\nlast";
  const std::vector<Seen> expected{{"first", true}, {"second", true}, {"", true}, {"last", false}};
  for (const std::size_t piece : {1u, 2u, 3u, 7u, 1000u}) {
    EXPECT_EQ(lines_of(in_pieces(text, piece)), expected) << piece;
  }
  EXPECT_TRUE(lines_of(bytes_of("")).empty());
}

TEST(LineReader, ALineOf64KiBPassesALongerOneIsNamedAndTheRestGoesOn) {
  for (const std::size_t extra : {0u, 1u, 500'000u}) {
    const std::string text = std::string(kLineMax + extra, 'x') + "\nnext\n";
    LineReader reader{in_pieces(text, 4096)};
    Line line{};
    ASSERT_TRUE(reader.next(line));
    EXPECT_EQ(line.too_long, extra > 0);
    EXPECT_EQ(line.number, 1u);
    ASSERT_TRUE(reader.next(line));
    EXPECT_EQ(line.text, "next");
    EXPECT_EQ(line.number, 2u);
    EXPECT_FALSE(reader.next(line));
  }
}

// Reading fails at the n-th call: the lines before are whole and the failure is told.
TEST(LineReader, AFailingSourceIsTold) {
  for (int good_calls = 0; good_calls < 4; ++good_calls) {
    int calls = 0;
    LineReader reader{[&](char* buffer, std::size_t) -> Result<std::size_t> {
      if (calls++ == good_calls) return failure(ErrorCode::io_failed, "the disk is gone");
      std::string{"ab\ncd"}.copy(buffer, 5);
      return std::size_t{5};
    }};
    Line line{};
    int lines = 0;
    while (reader.next(line)) ++lines;
    ASSERT_TRUE(reader.error().has_value());
    EXPECT_EQ(reader.error()->message, "the disk is gone");
    EXPECT_EQ(lines, good_calls);
  }
}

TEST(OpenFile, SaysWhatIsWrong) {
  const auto missing = open_file("/no/such/file.csv", "readings file");
  ASSERT_FALSE(missing.has_value());
  EXPECT_EQ(missing.error().code, ErrorCode::not_found);
  EXPECT_EQ(missing.error().message, "readings file '/no/such/file.csv' does not exist");
  EXPECT_EQ(open_file("/", "readings file").error().message,
            "readings file '/' is a folder, not a file");
}

// Opening a pipe that nobody writes to would wait for ever.
TEST(OpenFile, APipeIsRefusedAtOnce) {
  const recald::testing::TemporaryFolder folder;
  const std::string pipe = (folder / "readings.csv").string();
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(open_file(pipe, "readings file").error().message,
            "readings file '" + pipe + "' is a pipe, not a file; save its content to a file first");
  EXPECT_EQ(open_file("/dev/null", "readings file").error().message,
            "readings file '/dev/null' is a device, not a file; save its content to a file first");
}

}  // namespace
}  // namespace recald::csv::line_reader_test
