// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include "petal/testing/contract_suite.hpp"

namespace petal::testing {

/// Adds the content functions of all calibration types.
void add_calibration_contents(ContractInputs& inputs);

}  // namespace petal::testing
