// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/calibration/estimated_focal.hpp"

namespace petal {

mrpt::img::TCamera with_estimated_focal(mrpt::img::TCamera given, const CameraExtrinsics& solved) {
    if (!solved.diagnosis || !solved.diagnosis->focal || !solved.diagnosis->focal->estimated)
        return given;
    given.fx(solved.diagnosis->focal->scale * given.fx());
    given.fy(solved.diagnosis->focal->scale * given.fy());
    return given;
}

}  // namespace petal
