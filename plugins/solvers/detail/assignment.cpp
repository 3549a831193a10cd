// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/detail/assignment.hpp"

#include <limits>

namespace petal {

std::vector<int> assign(const Eigen::MatrixXd& cost, double unmatched) {
    // A column of its own for each row stands for "none".
    const auto rows = static_cast<std::size_t>(cost.rows());
    const auto real = static_cast<std::size_t>(cost.cols());
    const std::size_t columns = real + rows;
    const auto at = [&](std::size_t i, std::size_t j) {
        if (j >= real) return unmatched;
        const double value = cost(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
        return value <= unmatched ? value : 1e3 * unmatched + 1.0;
    };
    // Shortest augmenting paths with potentials; index 0 is a sentinel.
    std::vector<double> u(rows + 1, 0.0), v(columns + 1, 0.0);
    std::vector<std::size_t> row_of(columns + 1, 0), from(columns + 1, 0);
    for (std::size_t i = 1; i <= rows; ++i) {
        row_of[0] = i;
        std::size_t column = 0;
        std::vector<double> least(columns + 1, std::numeric_limits<double>::infinity());
        std::vector<bool> done(columns + 1, false);
        do {
            done[column] = true;
            const std::size_t row = row_of[column];
            double delta = std::numeric_limits<double>::infinity();
            std::size_t next = 0;
            for (std::size_t j = 1; j <= columns; ++j) {
                if (done[j]) continue;
                const double reduced = at(row - 1, j - 1) - u[row] - v[j];
                if (reduced < least[j]) {
                    least[j] = reduced;
                    from[j] = column;
                }
                if (least[j] < delta) {
                    delta = least[j];
                    next = j;
                }
            }
            for (std::size_t j = 0; j <= columns; ++j) {
                if (done[j]) {
                    u[row_of[j]] += delta;
                    v[j] -= delta;
                } else {
                    least[j] -= delta;
                }
            }
            column = next;
        } while (row_of[column] != 0);
        while (column != 0) {
            row_of[column] = row_of[from[column]];
            column = from[column];
        }
    }
    std::vector<int> result(rows, -1);
    for (std::size_t j = 1; j <= real; ++j)
        if (row_of[j] != 0) result[row_of[j] - 1] = static_cast<int>(j - 1);
    return result;
}

}  // namespace petal
