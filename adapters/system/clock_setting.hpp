/// Whether the system's clock is about to be set.
#pragma once

namespace recald::system {

/// True on a machine that booted within the last ten minutes and whose kernel has not heard from a
/// time server: its clock may be hours wrong yet look right. Later the clock is accepted, because
/// some places have no time server. False if the kernel does not tell.
[[nodiscard]] bool is_clock_settling();

/// Whether the kernel hears from a time server, as it is told by chrony or systemd-timesyncd.
[[nodiscard]] bool is_clock_synchronised();

}  // namespace recald::system
