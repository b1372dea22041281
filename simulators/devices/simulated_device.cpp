#include "simulators/devices/simulated_device.hpp"

namespace recald::simulators {

MeterReadout readout_of(const SimulatedDevice& device, SimulatedTime begin, SimulatedTime t,
                        std::span<const ScriptedFault> faults) {
  SimulatedTime counted_from = begin;
  double from_kWh = device.start_kWh;
  const double* held_kWh = nullptr;
  for (const ScriptedFault& fault : faults) {
    if (fault.kind == DeviceFaultKind::hold) held_kWh = &fault.amount;
    if (fault.kind != DeviceFaultKind::reset) continue;
    counted_from = begin + fault.begin;
    from_kWh = fault.amount;
  }
  const double counted_kWh = from_kWh + device.load->energy_kWh(counted_from, t);
  return {held_kWh != nullptr ? *held_kWh : counted_kWh, device.load->power_kW(t), device.unit};
}

}  // namespace recald::simulators
