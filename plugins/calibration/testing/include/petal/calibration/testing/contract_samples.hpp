// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include "petal/testing/contract_suite.hpp"

namespace petal::testing {

/// Packets of every calibration type that a stage must survive, for contract_violations(): "empty",
/// "typical" (one board of four holes in front of both sensors, seen alike by all types), "nan",
/// and too few, on one line, in one point, or of a wrong size; and the types' content functions.
/// Add those of your own types to it.
ContractInputs calibration_samples();

}  // namespace petal::testing
