// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <stdexcept>
#include <string>

namespace petal {

/// What petal and its stages throw. One sentence that names the culprit, what was expected and what
/// to do. The runner adds the stage's id, its type and the frame.
class Error : public std::runtime_error {
   public:
    using std::runtime_error::runtime_error;
};

/// A file could not be written: the disk's fault, not the stage's or its input's.
class WriteError : public Error {
   public:
    using Error::Error;
};

/// Thrown by Run::check_cancelled(): the user asked the run to end. Not an error of the stage.
class Cancelled : public std::runtime_error {
   public:
    Cancelled() : std::runtime_error("cancelled") {}
};

}  // namespace petal
