// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstddef>
#include <string>

namespace petal {

/// What is wrong with a JPEG, in libjpeg's words; empty where it decodes. (What libjpeg only warns
/// of, such as a damaged stretch of the picture, is not.)
///
/// MRPT leaves libjpeg's own handler in place, which ends the process at an error. So that no file
/// can do that, petal looks first: at everything up to the picture's data, which is a small part of
/// the work of decoding, and at the data themselves where a marker stands in them.
std::string jpeg_problem(const void* bytes, std::size_t count);

}  // namespace petal
