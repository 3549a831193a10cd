// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include "petal/error.hpp"

namespace petal {

/// What the user asked for cannot be done as asked: another command line can. Exit code 2.
class UsageError : public Error {
   public:
    using Error::Error;
};

/// The plugins that were found do not go together. Exit code 3.
class PluginError : public Error {
   public:
    using Error::Error;
};

}  // namespace petal
