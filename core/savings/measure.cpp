#include "core/savings/measure.hpp"

#include "core/model/prior.hpp"

namespace recald::savings {

double Achieved::quantile(double probability) const {
  return is_certain() ? mode : Prior{min, mode, max}.quantile(probability);
}

}  // namespace recald::savings
