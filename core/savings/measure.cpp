#include "core/savings/measure.hpp"

#include "core/model/prior.hpp"

namespace recald::savings {

double Achieved::quantile(double probability) const {
  return is_certain() ? mode : Prior{min, mode, max}.quantile(probability);
}

double changed(ChangeKind kind, double before, double by) {
  switch (kind) {
    case ChangeKind::set:
      return by;
    case ChangeKind::scale:
      return before * by;
    case ChangeKind::add:
      return before + by;
  }
  return before;
}

}  // namespace recald::savings
