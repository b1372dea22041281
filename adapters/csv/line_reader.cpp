#include "adapters/csv/line_reader.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>

#include "adapters/system/files/regular_file.hpp"

namespace recald::csv {
namespace {

constexpr std::size_t kBufferBytes = 256 * 1024;
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

}  // namespace

LineReader::LineReader(ByteSource source, std::size_t line_max)
    : source_{std::move(source)},
      line_max_{line_max},
      buffer_(std::max(kBufferBytes, 2 * line_max)) {}

bool LineReader::refill() {
  if (begin_ > 0) {
    std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
    end_ -= begin_;
    begin_ = 0;
  }
  const auto got = source_(buffer_.data() + end_, buffer_.size() - end_);
  if (!got) {
    error_ = got.error();
    return false;
  }
  end_ += *got;
  return *got > 0;
}

void LineReader::deliver(Line& line, const char* end, bool terminated) {
  const char* begin = buffer_.data() + begin_;
  begin_ = static_cast<std::size_t>(end - buffer_.data()) + (terminated ? 1 : 0);
  if (terminated && end > begin && end[-1] == '\r') --end;
  line = {{begin, static_cast<std::size_t>(end - begin)}, ++number_, terminated, false};
  if (number_ == 1 && line.text.substr(0, 3) == kByteOrderMark) line.text.remove_prefix(3);
  if (line.text.size() > line_max_) {
    line.text = {};
    line.too_long = true;
  }
}

bool LineReader::next(Line& line) {
  std::size_t searched = 0;
  for (;;) {
    const char* from = buffer_.data() + begin_ + searched;
    const std::size_t left = end_ - begin_ - searched;
    const auto* newline =
        left == 0 ? nullptr : static_cast<const char*>(std::memchr(from, '\n', left));
    if (newline != nullptr) {
      deliver(line, newline, true);
      return true;
    }
    searched = end_ - begin_;
    if (searched > line_max_ + kByteOrderMark.size() + 1) return skip_long_line(line);
    if (!refill()) return last_line(line);
  }
}

bool LineReader::last_line(Line& line) {
  if (begin_ == end_ || error_) return false;
  deliver(line, buffer_.data() + end_, false);
  return true;
}

bool LineReader::skip_long_line(Line& line) {
  line = {{}, ++number_, true, true};
  for (;;) {
    const char* from = buffer_.data() + begin_;
    const auto* newline = static_cast<const char*>(std::memchr(from, '\n', end_ - begin_));
    if (newline != nullptr) {
      begin_ = static_cast<std::size_t>(newline - buffer_.data()) + 1;
      return true;
    }
    begin_ = end_ = 0;
    if (!refill()) return !error_;
  }
}

Result<ByteSource> open_file(const std::filesystem::path& file, std::string_view what) {
  TRY(system::require_file(file, what));
  const std::string named = std::string{what} + " '" + file.string() + "'";
  std::shared_ptr<std::FILE> handle{std::fopen(file.c_str(), "rb"), CloseFile{}};
  if (!handle) {
    return failure(ErrorCode::io_failed, named + " cannot be opened: " + std::strerror(errno));
  }
  std::setvbuf(handle.get(), nullptr, _IONBF, 0);  // the line reader has its own buffer
  return ByteSource{[handle, named](char* buffer, std::size_t size) -> Result<std::size_t> {
    const std::size_t got = std::fread(buffer, 1, size, handle.get());
    if (got == 0 && std::ferror(handle.get()) != 0) {
      return failure(ErrorCode::io_failed, named + " cannot be read: " + std::strerror(errno));
    }
    return got;
  }};
}

ByteSource bytes_of(std::string_view text) {
  return [text](char* buffer, std::size_t size) mutable -> Result<std::size_t> {
    const std::size_t got = std::min(size, text.size());
    std::copy_n(text.data(), got, buffer);
    text.remove_prefix(got);
    return got;
  };
}

}  // namespace recald::csv
