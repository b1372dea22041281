#include "adapters/modbus/sunspec.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <utility>

namespace recald::modbus {
namespace {

constexpr std::array<std::uint16_t, 3> kBases{40'000, 50'000, 0};
constexpr std::array<std::uint16_t, 2> kMark{0x5375, 0x6E53};  // "SunS"
constexpr std::uint16_t kEndOfChain = 0xFFFF;
/// A longer chain is not real: headers of length 0 would go on forever.
constexpr std::size_t kModelsMax = 100;
constexpr int kRegisters = 0x10000;

bool is_nothing_there(const ReadFailure& failure) {
  return failure.fault == ReadFault::exception && failure.exception_code >= 2 &&
         failure.exception_code <= 4;
}

}  // namespace

SunSpecWalk::SunSpecWalk(std::uint8_t unit, std::vector<std::uint16_t> wanted)
    : unit_(unit), wanted_(std::move(wanted)) {}

std::optional<ReadRequest> SunSpecWalk::next() const {
  if (is_over_) return {};
  const int address = header_.value_or(kBases[base_]);
  return ReadRequest{unit_, Function::read_holding_registers, static_cast<std::uint16_t>(address),
                     kHeader};
}

void SunSpecWalk::take(const ReadResult& result) {
  assert(!is_over_);
  if (result) {
    assert(result->size() == kHeader);
    header_ ? take_header(*result) : take_mark(*result);
    return;
  }
  if (!is_nothing_there(result.error())) {
    failure_ = result.error();
    is_over_ = true;
  } else if (header_) {
    is_over_ = true;
  } else {
    try_next_base();
  }
}

void SunSpecWalk::take_mark(const Words& words) {
  if (std::ranges::equal(words, kMark)) {
    header_ = kBases[base_] + kHeader;
  } else {
    try_next_base();
  }
}

void SunSpecWalk::try_next_base() {
  ++base_;
  is_over_ = base_ == kBases.size();
}

void SunSpecWalk::take_header(const Words& words) {
  const SunSpecModel model{words[0], static_cast<std::uint16_t>(*header_), words[1]};
  if (model.id == kEndOfChain) {
    is_over_ = true;
    return;
  }
  models_.push_back(model);
  if (std::ranges::find(wanted_, model.id) != wanted_.end()) found_ = model;
  header_ = *header_ + kHeader + model.length;
  is_over_ = found_ || models_.size() == kModelsMax || *header_ + kHeader > kRegisters;
}

ReadFailure SunSpecWalk::failure() const {
  assert(is_over_ && !found_);
  if (failure_) return *failure_;
  if (!header_) {
    return {ReadFault::mismatch, 0,
            fmt::format("no SunSpec device: \"SunS\" stands at none of the addresses {}",
                        fmt::join(kBases, ", "))};
  }
  std::vector<std::uint16_t> ids;
  for (const SunSpecModel& model : models_) ids.push_back(model.id);
  return {ReadFault::mismatch, 0,
          fmt::format("the SunSpec device has the models {}, and none of {}", fmt::join(ids, ", "),
                      fmt::join(wanted_, ", "))};
}

}  // namespace recald::modbus
