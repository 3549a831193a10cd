// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include "detectors/detail/plane_search.hpp"
#include "petal/calibration/cloud.hpp"
#include "petal/calibration/planes.hpp"
#include "petal/run.hpp"
#include "petal/spec.hpp"
#include "petal/stage.hpp"

namespace petal {

struct PlanesRansacParams : PlaneSearchParams {
    int max_planes = 20;
};

/// Plane patches of the size of a board among margin points: equations (2)(3) and lines 6 to 12 of
/// Algorithm 1 of the letter.
class PlanesRansac final : public Stage {
   public:
    using Params = PlanesRansacParams;
    static void describe(Spec<Params>& s);
    explicit PlanesRansac(Params p) : p_(p) {}
    void run(Run& run) override;

   private:
    Params p_;
};

}  // namespace petal
