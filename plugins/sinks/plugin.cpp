// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/plugin.hpp"

#include "sinks/rawlog.hpp"

PETAL_PLUGIN("sinks", "0.1.0",
             [](petal::Registrar& r) { r.add<petal::RawlogSink>("sink.rawlog"); });
