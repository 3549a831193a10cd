// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <filesystem>
#include <iostream>

#include "command_main.hpp"
#include "result_diff.hpp"

/// petal diff: two calibrations compared, in units of their sigma.
int main(int argc, char** argv) {
    CLI::App app("compares two calibrations, in units of their sigma", "petal diff");
    app.footer(
        "Exit codes: 0 they agree (chi-square of the pose within its 99.9 % band), 4 they do not, "
        "1 failed, 2 wrong usage");
    std::filesystem::path a, b;
    bool json = false;
    double focal = 0.0;
    app.add_option("A", a, "a result.json, or the run folder that holds it")->required();
    app.add_option("B", b, "another one, of the same sensors")->required();
    app.add_flag("--json", json, "for programs, without rounding");
    app.add_option("--focal", focal,
                   "focal length in pixels, to tell what the difference means on the image; "
                   "without it that of the corners in A or B is used")
        ->check(CLI::PositiveNumber);
    return petal::command_main(app, argc, argv, [&] {
        const petal::ResultDifference difference = petal::compare_results(a, b, focal);
        std::cout << (json ? petal::difference_json(difference)
                           : petal::difference_table(difference));
        return difference.agree() ? 0 : 4;
    });
}
