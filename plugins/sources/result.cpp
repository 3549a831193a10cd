// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sources/result.hpp"

#include <string>
#include <utility>

#include "petal/calibration/read_result.hpp"
#include "sources/detail/scene_name.hpp"

namespace petal {

void ResultSource::describe(Spec<Params>& spec) {
    spec.summary("Reads the extrinsics of an earlier run from its result.json.");
    spec.doc(
        R"(Labels of camera and LiDAR, `T_camera_lidar`, its covariance, the verdict and its reasons are read, and a focal length that was
estimated with the pose (`focal`: a factor on that of the data); residuals and intrinsics are not in the file. It is one frame. Who reads it beside the scenes of another source gathers it: `metric.agreement` holds it against
new data, as `petal verify` does.

Refused, with file, line and key: what is no result.json, a result without extrinsics, a matrix that is no rigid motion, a
covariance that is not symmetric or has a negative variance, two entries of one camera and LiDAR.)");
    spec.writes<Extrinsics>("extrinsics", "the cameras of that result, without intrinsics");
    spec.param("file", &Params::file).doc("a result.json");
}

void ResultSource::run(Run& run) {
    if (std::exchange(done_, true)) return run.end_of_data();
    Extrinsics extrinsics = read_result(params_.file);
    run.used_file(params_.file);
    run.set_frame(scene_name(params_.file), 0.0);
    run.log(LogLevel::info, params_.file.string() + ": " +
                                std::to_string(extrinsics.cameras.size()) + " cameras, " +
                                to_string(extrinsics.level));
    run.write("extrinsics", std::move(extrinsics));
}

}  // namespace petal
