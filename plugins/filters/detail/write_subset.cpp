// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "filters/detail/write_subset.hpp"

#include <string>

namespace petal {

void write_subset(Run& run, const Cloud& cloud, const std::vector<std::uint32_t>& indices,
                  std::size_t finite, const Note& none_stays) {
    const std::size_t dropped = cloud.size() - finite;
    if (cloud.size() == 0)
        run.note({"points", "the cloud is empty", "", "see the notes of the stages before"});
    if (dropped > 0)
        run.note({"points with three finite coordinates",
                  std::to_string(dropped) + " of " + std::to_string(cloud.size()) +
                      " points are not finite and were dropped",
                  "", ""});
    if (finite > 0 && indices.empty()) {
        Note note = none_stays;
        if (note.nearest_miss.empty())
            note.nearest_miss = "none of " + std::to_string(finite) + " points stays";
        run.note(note);
    }
    run.log(LogLevel::info, std::to_string(indices.size()) + " of " + std::to_string(cloud.size()) +
                                " points stay");
    run.write("cloud", subset(cloud, indices));
}

}  // namespace petal
