// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <mrpt/obs/CAction.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/obs/CSensoryFrame.h>

namespace petal {

/// Whether an object of that class may stand in a rawlog by itself.
inline bool stands_in_rawlogs(const mrpt::rtti::TRuntimeClassId& of) {
    using namespace mrpt::obs;
    return of.derivedFrom(CLASS_ID(CObservation)) || of.derivedFrom(CLASS_ID(CSensoryFrame)) ||
           of.derivedFrom(CLASS_ID(CActionCollection)) || of.derivedFrom(CLASS_ID(CAction));
}

}  // namespace petal
