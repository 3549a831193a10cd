// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/plugin.hpp"

#include "statistical_outlier.hpp"

PETAL_PLUGIN("example", "0.1.0", [](petal::Registrar& registrar) {
    registrar.add<example::StatisticalOutlier>("example.statistical_outlier");
});
