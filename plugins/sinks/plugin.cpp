// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/plugin.hpp"

#include <opencv2/core/utility.hpp>

#include "sinks/calibrated_rawlog.hpp"
#include "sinks/colored_cloud.hpp"
#include "sinks/export.hpp"
#include "sinks/overlay.hpp"
#include "sinks/projection.hpp"
#include "sinks/rawlog.hpp"
#include "sinks/report.hpp"
#include "sinks/result.hpp"

PETAL_PLUGIN("sinks", "0.1.0", [](petal::Registrar& r) {
    r.add<petal::CalibratedRawlog>("sink.calibrated_rawlog");
    r.add<petal::ColoredCloud>("sink.colored_cloud");
    r.add<petal::Export>("sink.export");
    r.add<petal::Overlay>("sink.overlay");
    r.add<petal::Projection>("sink.projection");
    r.add<petal::RawlogSink>("sink.rawlog");
    r.add<petal::Report>("sink.report");
    r.add<petal::ResultSink>("sink.result");
    r.on_thread_limit([](int threads) { cv::setNumThreads(threads); });
});
