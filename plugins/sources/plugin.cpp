// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/plugin.hpp"

#include "sources/files.hpp"
#include "sources/observations.hpp"
#include "sources/pairs.hpp"
#include "sources/rawlog.hpp"
#include "sources/result.hpp"
#include "sources/simulator.hpp"

PETAL_PLUGIN("sources", "0.1.0", [](petal::Registrar& r) {
    r.add<petal::FilesSource>("source.files");
    r.add<petal::ObservationsSource>("source.observations");
    r.add<petal::PairsSource>("source.pairs");
    r.add<petal::RawlogSource>("source.rawlog");
    r.add<petal::ResultSource>("source.result");
    r.add<petal::SimulatorSource>("source.simulator");
});
