// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "petal/packet.hpp"

namespace petal {

/// What Metric::scene holds for a frame: its name, or its number where it has none, since a name is
/// what tells a scene from the total.
inline std::string scene_name(const FrameInfo& frame) {
    return frame.name.empty() ? std::to_string(frame.number) : frame.name;
}

/// "'a', 'b' and 12 more": names for a note.
inline std::string listed(const std::vector<std::string>& names) {
    constexpr std::size_t kShown = 8;
    std::string text;
    for (std::size_t i = 0; i < names.size() && i < kShown; ++i)
        text += (i > 0 ? ", '" : "'") + names[i] + "'";
    if (names.size() > kShown) text += " and " + std::to_string(names.size() - kShown) + " more";
    return text;
}

}  // namespace petal
