/// What has been learnt from simulated buildings, for names by signatures.
#pragma once

#include "core/diagnosis/naming/signature_names.hpp"
#include "core/diagnosis/naming/signature_null.hpp"

namespace recald::diagnosis {

[[nodiscard]] const SignatureNull& learnt_null();
[[nodiscard]] const NameWeights& learnt_weights();

}  // namespace recald::diagnosis
