#include "adapters/ports/alive.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace recald {
namespace {

/// Is called back later, as by a loop.
class Watch {
 public:
  Watch(std::vector<std::function<void()>>& calls, int& count) : calls_(calls), count_(count) {}

  void look_later() {
    calls_.push_back(alive_.guard([this] { ++count_; }));
  }
  void forget() { alive_ = {}; }
  [[nodiscard]] auto adder() {
    return alive_.guard(
        [this](int number, std::string text) { count_ += number + static_cast<int>(text.size()); });
  }

 private:
  std::vector<std::function<void()>>& calls_;
  int& count_;
  Alive alive_;
};

class AliveTest : public ::testing::Test {
 protected:
  void call_all() {
    for (const auto& call : calls_) call();
  }

  std::vector<std::function<void()>> calls_;
  int count_ = 0;
  std::unique_ptr<Watch> watch_ = std::make_unique<Watch>(calls_, count_);
};

TEST_F(AliveTest, CallsWhileTheObjectLives) {
  watch_->look_later();
  watch_->look_later();
  call_all();
  EXPECT_EQ(count_, 2);
  watch_->adder()(3, "four");
  EXPECT_EQ(count_, 9);
}

TEST_F(AliveTest, DoesNothingAfterwards) {
  watch_->look_later();
  auto add = watch_->adder();
  watch_.reset();
  call_all();
  add(3, "four");
  EXPECT_EQ(count_, 0);
}

TEST_F(AliveTest, AnotherLifeHearsNoEarlierCall) {
  watch_->look_later();
  watch_->forget();
  watch_->look_later();
  call_all();
  EXPECT_EQ(count_, 1);
}

}  // namespace
}  // namespace recald
