/// `recald decode`: what a frame says, for people who stand before a meter with a log in hand.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <nlohmann/json.hpp>

#include "adapters/modbus/frame_explanation.hpp"
#include "daemon/commands/commands.hpp"
#include "daemon/commands/meters/field_words.hpp"
#include "daemon/site/config/register_map_file.hpp"

namespace recald::daemon {
namespace {

using modbus::FrameExplanation;
using modbus::Framing;
using Json = nlohmann::ordered_json;

/// What was given on the command line, understood.
struct Decoding {
  modbus::RegisterMap map;
  std::vector<std::uint8_t> bytes;
  FrameExplanation frame;
  std::optional<int> address;  ///< Of the first register, as the map counts.
  std::vector<FieldWords> fields;
};

Result<int> parse_address(std::string_view text) {
  int base = 10;
  std::string_view digits = text;
  if (digits.starts_with("0x") || digits.starts_with("0X")) {
    digits.remove_prefix(2);
    base = 16;
  }
  int address = -1;
  const auto [end, error] =
      std::from_chars(digits.data(), digits.data() + digits.size(), address, base);
  if (error == std::errc{} && end == digits.data() + digits.size() && address >= 0 &&
      address <= 0xFFFF) {
    return address;
  }
  return failure(ErrorCode::invalid_value,
                 fmt::format("--at is '{}'; write the address of the first register on the wire, "
                             "0 to 65535 or 0x0000 to 0xFFFF",
                             text));
}

/// Whether the reply answers the request; where the frame is sound in itself.
void compare(const modbus::FramedRequest& asked, Decoding& decoding) {
  FrameExplanation& frame = decoding.frame;
  const auto problem = [&](std::string sentence) { frame.problems.push_back(std::move(sentence)); };
  if (frame.framing == Framing::registers) {
    if (frame.registers.size() != asked.request.count) {
      problem(fmt::format("the request reads {} registers, but there are {} here",
                          asked.request.count, frame.registers.size()));
    }
    return;
  }
  if (frame.framing != asked.framing) {
    problem(fmt::format("the request is {}, but the reply is {}", modbus::to_string(asked.framing),
                        modbus::to_string(frame.framing)));
    return;
  }
  const auto reply = frame.framing == Framing::tcp
                         ? check_tcp_reply(decoding.bytes, asked.request, asked.transaction)
                         : check_rtu_reply(decoding.bytes, asked.request);
  const bool is_refusal = !reply && reply.error().fault == modbus::ReadFault::exception;
  if (!reply && !is_refusal && frame.problems.empty()) {
    problem("this is not a reply to the request: " + reply.error().what);
  }
}

void place_fields(Decoding& decoding) {
  FrameExplanation& frame = decoding.frame;
  if (frame.function && frame.problems.empty() &&
      *frame.function != static_cast<std::uint8_t>(decoding.map.function)) {
    frame.problems.push_back(fmt::format("the frame has function {}, but map '{}' uses function {}",
                                         *frame.function, decoding.map.name,
                                         static_cast<int>(decoding.map.function)));
  }
  if (!decoding.address || frame.registers.empty()) return;
  decoding.fields = words_of_fields(decoding.map.fields, *decoding.address, frame.registers);
}

/// @return or what is wrong with the command line, in one sentence.
Result<Decoding> understand(const DecodeArguments& arguments, modbus::RegisterMap map) {
  Decoding decoding{.map = std::move(map)};
  auto bytes = modbus::parse_hex_bytes(arguments.hex);
  if (!bytes) return failure(bytes.error().code, "--hex: " + bytes.error().message);
  decoding.bytes = std::move(*bytes);
  std::optional<Framing> as;
  if (!arguments.as.empty()) {
    const auto parsed = modbus::parse_framing(arguments.as);
    if (!parsed) return failure(parsed.error().code, "--as: " + parsed.error().message);
    as = *parsed;
  }
  decoding.frame = modbus::explain_reply(decoding.bytes, as);
  const bool is_relative = !decoding.map.sunspec_models.empty();
  if (!arguments.request.empty()) {
    const auto request_bytes = modbus::parse_hex_bytes(arguments.request);
    if (!request_bytes) {
      return failure(request_bytes.error().code, "--request: " + request_bytes.error().message);
    }
    const auto asked = modbus::parse_request(*request_bytes);
    if (!asked) return failure(asked.error().code, "--request: " + asked.error().message);
    compare(*asked, decoding);
    if (!is_relative) decoding.address = asked->request.address;
  }
  if (!arguments.at.empty()) {
    const auto at = TRY(parse_address(arguments.at));
    if (decoding.address && *decoding.address != at) {
      return failure(ErrorCode::invalid_value,
                     fmt::format("--at says {} but --request says {}; give only one of them", at,
                                 *decoding.address));
    }
    decoding.address = at;
  }
  place_fields(decoding);
  return decoding;
}

std::string_view title_of(Framing framing) {
  switch (framing) {
    case Framing::tcp:
      return "TCP frame";
    case Framing::rtu:
      return "RTU frame";
    case Framing::registers:
      break;
  }
  return "registers";
}

void print_line(const Console& console, std::span<const std::uint8_t> bytes, std::size_t begin,
                std::string_view meaning) {
  console.out << fmt::format("  {:>3}  {:<12} {}\n", begin,
                             fmt::format("{:02X}", fmt::join(bytes, " ")), meaning);
}

void print_registers(const Decoding& decoding, const Console& console) {
  const FrameExplanation& frame = decoding.frame;
  const std::span<const std::uint8_t> bytes{decoding.bytes};
  for (std::size_t i = 0; i < frame.registers.size(); ++i) {
    const std::size_t begin = frame.registers_begin + 2 * i;
    const int number = static_cast<int>(i);
    print_line(console, bytes.subspan(begin, 2), begin,
               decoding.address ? fmt::format("register @{} = {}", *decoding.address + number,
                                              frame.registers[i])
                                : fmt::format("register {} of {} = {}", i + 1,
                                              frame.registers.size(), frame.registers[i]));
  }
}

void print_bytes(const Decoding& decoding, const Console& console) {
  const FrameExplanation& frame = decoding.frame;
  const std::span<const std::uint8_t> bytes{decoding.bytes};
  console.out << fmt::format("{}, {} bytes\n", title_of(frame.framing), bytes.size());
  bool has_registers = frame.registers.empty();
  for (const modbus::FramePart& part : frame.parts) {
    if (!has_registers && part.begin >= frame.registers_begin) {
      print_registers(decoding, console);
      has_registers = true;
    }
    print_line(console, bytes.subspan(part.begin, part.size), part.begin, part.meaning);
  }
  if (!has_registers) print_registers(decoding, console);
}

void print_fields(const Decoding& decoding, const Console& console) {
  const modbus::RegisterMap& map = decoding.map;
  if (decoding.frame.registers.empty()) return;
  console.out << fmt::format("{} ({})\n", map.title, map.name);
  if (!decoding.address) {
    console.out
        << (map.sunspec_models.empty()
                ? "  the address of the first register is unknown: give --request or --at\n"
                : "  give --at: the first register, counted from the model's id register\n");
    return;
  }
  if (decoding.fields.empty()) {
    console.out << fmt::format(
        "  registers @{} to @{} contain none of its fields\n", *decoding.address,
        *decoding.address + static_cast<int>(decoding.frame.registers.size()) - 1);
  }
  for (const FieldWords& found : decoding.fields) {
    console.out << fmt::format("  @{:<6} {:<24} {:<20} {}\n", found.field->address,
                               found.field->name,
                               fmt::format("{:04X}", fmt::join(found.words, " ")), describe(found));
  }
}

Json json_of(const FieldWords& found) {
  Json words = Json::array();
  for (const std::uint16_t word : found.words) words.push_back(fmt::format("{:04X}", word));
  Json json{{"name", found.field->name},
            {"address", found.field->address},
            {"words", words},
            {"value", nullptr},
            {"unit", found.field->unit}};
  if (found.value) {
    json["value"] = found.value->value;
  } else {
    json["why_none"] = found.value.error();
  }
  return json;
}

Json json_of(const Decoding& decoding) {
  const FrameExplanation& frame = decoding.frame;
  const auto or_null = [](const auto& value) { return value ? Json(*value) : Json(); };
  Json parts = Json::array();
  for (const modbus::FramePart& part : frame.parts) {
    const std::span<const std::uint8_t> bytes{decoding.bytes};
    parts.push_back(
        {{"offset", part.begin},
         {"bytes", fmt::format("{:02X}", fmt::join(bytes.subspan(part.begin, part.size), ""))},
         {"meaning", part.meaning}});
  }
  Json fields = Json::array();
  for (const FieldWords& found : decoding.fields) fields.push_back(json_of(found));
  return {{"framing", modbus::to_string(frame.framing)},
          {"transaction", or_null(frame.transaction)},
          {"unit", or_null(frame.unit)},
          {"function", or_null(frame.function)},
          {"exception",
           frame.exception_code ? Json(modbus::describe_exception(*frame.exception_code)) : Json()},
          {"address", or_null(decoding.address)},
          {"registers", frame.registers},
          {"parts", parts},
          {"map", decoding.map.name},
          {"fields", fields},
          {"problems", frame.problems}};
}

}  // namespace

int run_decode(const DecodeArguments& arguments, const Console& console) {
  auto map = find_register_map(arguments.map, std::filesystem::current_path());
  if (!map) return console.fail(map.error());
  const auto decoding = understand(arguments, std::move(*map));
  if (!decoding) return console.misused(decoding.error().message);
  if (arguments.json) {
    console.out << json_of(*decoding).dump(2) << "\n";
  } else {
    print_bytes(*decoding, console);
    print_fields(*decoding, console);
  }
  return decoding->frame.problems.empty() ? kSuccess : console.fail(decoding->frame.problems);
}

}  // namespace recald::daemon
