/// One transition of the No-U-Turn sampler.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/calibration/samplers/hamiltonian.hpp"
#include "core/random/rng.hpp"

namespace recald::calibration {

/// The result of one transition.
struct Transition {
  double acceptance;  ///< Mean of min(1, exp(H_0 - H)) over the points visited.
  double energy;      ///< H of the chosen point, with the momentum at which it was reached.
  bool diverged;
  bool at_depth_limit;
};

/// Grows trajectories by doubling until they turn round, and chooses one of their points.
///
/// Multinomial sampling with weights exp(-H) within a trajectory, biased towards the newer half at
/// the top (Betancourt 2017, appendix A.3). A trajectory has turned when the sum rho of its momenta
/// points against the momentum at one of its ends. As in Stan, each half is also checked together
/// with the nearest point of the other, which catches turns whose length just fits a doubling.
///
/// All storage is allocated at construction, one stretch per depth, so a transition
/// does not allocate.
///
/// @see Hoffman, Gelman (2014), J. Mach. Learn. Res. 15, algorithm 3; Betancourt (2017),
///      arXiv:1701.02434.
class TrajectorySampler {
 public:
  /// @param depth_max          Longest trajectory: 2^depth_max steps.
  /// @param divergence_energy  A step that raises H above its start by more than this
  ///                           ends the trajectory.
  TrajectorySampler(Hamiltonian& hamiltonian, Rng& rng, int depth_max, double divergence_energy);

  /// Moves `current` (density and force known; the momentum is drawn anew) to the chosen point.
  /// @return what happened, or an error of the target, after which `current` is unchanged.
  [[nodiscard]] Result<Transition> transition(PhasePoint& current, double step);

 private:
  /// A candidate for the next point of the chain.
  struct Choice {
    explicit Choice(Eigen::Index d) : position(d), force(d) {}
    Eigen::VectorXd position;
    Eigen::VectorXd force;
    double log_density = 0.0;
    double energy = 0.0;
  };
  /// Part of a trajectory, in the order of its steps.
  struct Stretch {
    explicit Stretch(Eigen::Index d)
        : first_momentum(d), last_momentum(d), momentum_sum(d), choice(d) {}
    Eigen::VectorXd first_momentum;
    Eigen::VectorXd last_momentum;
    Eigen::VectorXd momentum_sum;  // rho
    double log_weight = 0.0;       // log of the sum of exp(H_0 - H)
    Choice choice;
  };
  enum class Outcome { whole, turned, diverged, failed };

  [[nodiscard]] static bool turns(const Stretch& first, const Stretch& second);
  static void append(Stretch& first, const Stretch& second);
  static void record(const PhasePoint& point, double log_weight, Stretch& stretch);

  void begin(const PhasePoint& current);
  [[nodiscard]] Outcome extend(int depth);
  [[nodiscard]] Outcome walk(int depth, Stretch& stretch);
  [[nodiscard]] Outcome walk_one_step(Stretch& stretch);
  void turn_round();

  Hamiltonian& hamiltonian_;
  Rng& rng_;
  int depth_max_;
  double divergence_energy_;

  PhasePoint front_;  // the end that moves
  PhasePoint back_;   // the other end
  Stretch whole_;     // its last momentum is that of front_ when the walk began
  Stretch extension_;
  std::vector<Stretch> second_halves_;  // (depth_max) one per depth of the recursion
  double step_ = 0.0;                   // signed
  double energy_0_ = 0.0;
  double acceptance_sum_ = 0.0;
  int points_ = 0;
  std::optional<Error> error_;  // of the target, once a step has failed
};

}  // namespace recald::calibration
