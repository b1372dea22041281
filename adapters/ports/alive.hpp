/// Whether an object still lives when a loop or a worker calls it back.
#pragma once

#include <memory>
#include <utility>

namespace recald {

/// A member of the object. Calls come on the thread that destroys the object.
class Alive {
 public:
  Alive() = default;
  /// Another life: what was guarded before is not called any more.
  Alive& operator=(Alive&&) = default;

  /// @param run  Has the object's `this`. What comes back calls it while the object lives, and does
  ///             nothing afterwards.
  template <class Run>
  [[nodiscard]] auto guard(Run run) const {
    return [token = std::weak_ptr{token_}, run = std::move(run)](auto&&... arguments) mutable {
      if (!token.expired()) run(std::forward<decltype(arguments)>(arguments)...);
    };
  }

 private:
  std::shared_ptr<bool> token_ = std::make_shared<bool>();
};

}  // namespace recald
