// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <string>

namespace petal {

/// A sensor's label or a scene's name as a part of a file's name: those are free text, file names
/// are not. ASCII letters, digits, '-', '_' and '.' stay; a '.' at the begin and every other byte
/// become % and two hexadecimal digits ("/cam/front": "%2Fcam%2Ffront"), so the result leads to no
/// other folder and two different labels give two different names. An empty label stays empty.
std::string file_name(const std::string& label);

}  // namespace petal
