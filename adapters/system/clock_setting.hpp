/// Whether the system's clock is about to be set.
#pragma once

namespace recald::system {

/// A machine that has booted within the last ten minutes, and whose kernel has not heard of a time
/// server yet: its clock may be hours wrong and look right. Later it is taken as it is; there are
/// places without a time server. Where the kernel does not tell, it is not about to be set.
[[nodiscard]] bool is_clock_settling();

}  // namespace recald::system
