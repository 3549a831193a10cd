// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "petal/calibration/same_projection.hpp"

namespace petal {

bool same_projection(const mrpt::img::TCamera& a, const mrpt::img::TCamera& b) {
    return a.ncols == b.ncols && a.nrows == b.nrows && a.fx() == b.fx() && a.fy() == b.fy() &&
           a.cx() == b.cx() && a.cy() == b.cy() && a.distortion == b.distortion && a.dist == b.dist;
}

}  // namespace petal
