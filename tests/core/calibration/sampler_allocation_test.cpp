// What a sampler does ten thousand times must not touch the heap.

#include <gtest/gtest.h>

#include <functional>

#include "core/calibration/samplers/dram.hpp"
#include "core/calibration/samplers/nuts.hpp"
#include "core/calibration/samplers/particles.hpp"
#include "core/calibration/samplers/seed_rwm.hpp"
#include "tests/core/calibration/sampling_targets.hpp"
#include "tests/support/allocations.hpp"

namespace recald::calibration {
namespace {

/// The heap is closed to Eigen from iteration `from` to the end of the run, and counted.
class HeapWatch {
 public:
  explicit HeapWatch(int from) : from_(from) {}
  ~HeapWatch() { testing::let_eigen_allocate(true); }
  HeapWatch(const HeapWatch&) = delete;
  HeapWatch& operator=(const HeapWatch&) = delete;

  bool operator()(int done, int total) {
    if (done < from_) return true;
    if (first_ < 0) first_ = testing::allocation_count();
    last_ = testing::allocation_count();
    testing::let_eigen_allocate(done == total);
    return true;
  }
  [[nodiscard]] long allocations() const { return last_ - first_; }

 private:
  int from_;
  long first_ = -1;
  long last_ = -1;
};

TEST(SamplerAllocation, NoneInATrajectoryOfNuts) {
  Logistic target(13);
  Rng rng(1);
  HeapWatch watch(300);
  ASSERT_TRUE(nuts(target, {600, 300, {}}, rng, std::ref(watch)).has_value());
  EXPECT_EQ(watch.allocations(), 0);
}

// Between two windows of the burn-in, iterations 451 to 949 of a thousand, only the step adapts.
TEST(SamplerAllocation, NoneWhileNutsCollectsAWindow) {
  Logistic target(13);
  Rng rng(2);
  HeapWatch watch(451);
  const SamplerObserver observer = [&](int done, int total) {
    if (done < 949) return watch(done, total);
    testing::let_eigen_allocate(true);
    return true;
  };
  ASSERT_TRUE(nuts(target, {1'010, 1'000, {}}, rng, observer).has_value());
  EXPECT_EQ(watch.allocations(), 0);
}

TEST(SamplerAllocation, NoneInAStepOfARandomWalk) {
  for (const SampleFunction& sampler : {SampleFunction(dram), SampleFunction(seed_rwm)}) {
    Logistic target(13);
    Rng rng(3);
    HeapWatch watch(1'000);
    ASSERT_TRUE(sampler(target, {2'000, 1'000, {}}, rng, std::ref(watch)).has_value());
    EXPECT_EQ(watch.allocations(), 0);
  }
}

TEST(SamplerAllocation, NoneInASweepOfParticles) {
  Logistic target(13);
  Rng rng(5);
  Particles particles = draw_particles(target, 100, rng).value();
  ParticleMover mover(target, rng, particles.count(), {});
  ASSERT_TRUE(mover.set_shape(covariance(particles)).has_value());
  const long before = testing::allocation_count();
  testing::let_eigen_allocate(false);
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(mover.move(particles, 0.5).has_value());
  testing::let_eigen_allocate(true);
  EXPECT_EQ(testing::allocation_count() - before, 0);
}

}  // namespace
}  // namespace recald::calibration
