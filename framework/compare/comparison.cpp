// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "comparison.hpp"

namespace petal::compare {

const char* to_string(Direction direction) {
    switch (direction) {
        case Direction::lower:
            return "lower";
        case Direction::higher:
            return "higher";
        case Direction::none:
            return "none";
    }
    return "none";
}

const char* to_string(FailsOn fails_on) {
    switch (fails_on) {
        case FailsOn::error:
            return "error";
        case FailsOn::not_usable:
            return "not_usable";
        case FailsOn::weak:
            return "weak";
    }
    return "error";
}

}  // namespace petal::compare
