// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/detail/corner_covariance.hpp"

#include <Eigen/Eigenvalues>

#include "petal/printed.hpp"

namespace petal {

Eigen::MatrixXd corner_covariance(const Eigen::MatrixXd& joint,
                                  const std::vector<Eigen::Matrix2d>& each, std::size_t corners,
                                  double redundancy) {
    if (joint.size() > 0) return joint;
    const auto rows = 2 * static_cast<Eigen::Index>(corners);
    Eigen::MatrixXd covariance = Eigen::MatrixXd::Identity(rows, rows);
    for (std::size_t i = 0; i < each.size() && i < corners; ++i)
        covariance.block<2, 2>(2 * static_cast<Eigen::Index>(i), 2 * static_cast<Eigen::Index>(i)) =
            each[i];
    return redundancy * covariance;
}

std::string covariance_fault(const Eigen::MatrixXd& covariance) {
    constexpr double kRounding = 1e-6;
    if (!covariance.allFinite()) return "holds NaN or infinity";
    if (covariance.size() == 0) return "";
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(covariance, Eigen::EigenvaluesOnly);
    const double least = eigen.eigenvalues()[0];
    const double largest = eigen.eigenvalues()[covariance.rows() - 1];
    if (least < 0.0 && !(least >= -kRounding * largest))
        return printed("has a negative variance, %.3g beside a largest of %.3g", least, largest);
    return "";
}

}  // namespace petal
