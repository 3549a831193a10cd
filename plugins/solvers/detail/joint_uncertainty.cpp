// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/detail/joint_uncertainty.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace petal {
namespace {

Eigen::MatrixXd part(const Eigen::MatrixXd& matrix, const std::vector<Eigen::Index>& rows,
                     const std::vector<Eigen::Index>& columns) {
    Eigen::MatrixXd result(static_cast<Eigen::Index>(rows.size()),
                           static_cast<Eigen::Index>(columns.size()));
    for (std::size_t r = 0; r < rows.size(); ++r)
        for (std::size_t c = 0; c < columns.size(); ++c)
            result(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)) =
                matrix(rows[r], columns[c]);
    return result;
}

double variance_scale_of(double chi2, int freedom) {
    return freedom > 0 ? std::max(1.0, chi2 / freedom) : 1.0;
}

Matrix6d pose_block(const Eigen::MatrixXd& covariance, std::size_t camera) {
    const auto at = 6 * static_cast<Eigen::Index>(camera);
    return covariance.block<6, 6>(at, at);
}

}  // namespace

JointUncertainty::JointUncertainty(const JointModel& model, const JointOptions& options,
                                   const JointSolution& solution)
    : layout_(model.cameras.size()),
      free_focal_(options.free_focal),
      focal_(solution.state.focal),
      scenes_(scene_information(model, solution)),
      prior_(options.prior ? prior_information(layout_, *options.prior, solution.state)
                           : JointInformation(layout_.size())),
      total_(layout_.size()),
      range_offset_sigma_(options.range_offset_sigma),
      chi2_(solution.chi2) {
    free_focal_.resize(layout_.cameras(), false);
    // A scene that was left out has no say.
    if (options.without_scene) scenes_[*options.without_scene] = JointInformation(layout_.size());
    for (const JointInformation& scene : scenes_) total_ += scene;
    total_ += prior_;
    const Eigen::Index range = layout_.range();
    const double weight = 1.0 / (range_offset_sigma_ * range_offset_sigma_);
    total_.normal(range, range) += weight;
    total_.gradient(range) += weight * solution.state.range_offset;
    for (std::size_t c = 0; c < layout_.cameras(); ++c)
        for (Eigen::Index i = 0; i < 6; ++i) estimated_.push_back(layout_.pose(c) + i);
    estimated_.push_back(range);
    for (std::size_t c = 0; c < layout_.cameras(); ++c)
        if (free_focal_[c]) estimated_.push_back(layout_.focal(c));
    inverse_ = inverse_information(estimated_part(total_.normal));
    freedom_ = std::max(0, static_cast<int>(std::lround(solution.numbers)) -
                               static_cast<int>(estimated_.size()) + 1);  // its prior is a number
    scale_ = variance_scale_of(chi2_, freedom_);
}

Eigen::MatrixXd JointUncertainty::estimated_part(const Eigen::MatrixXd& normal) const {
    return part(normal, estimated_, estimated_);
}

/// What the estimate does when the range offset errs by the sigma that the weights know.
Eigen::VectorXd JointUncertainty::offset_answer(const Eigen::MatrixXd& inverse) const {
    return inverse.col(6 * static_cast<Eigen::Index>(layout_.cameras())) / range_offset_sigma_;
}

/// What noise does, scaled as its chi-square demands, and what the offset does, of which the
/// chi-square knows nothing; `inverse` holds the share of the offset that the weights allow for.
Eigen::MatrixXd JointUncertainty::with_offset(const Eigen::MatrixXd& inverse,
                                              double range_offset_sigma) const {
    const Eigen::VectorXd answer = offset_answer(inverse);
    const double share = range_offset_sigma / range_offset_sigma_;
    return scale_ * inverse + (share * share - scale_) * answer * answer.transpose();
}

Matrix6d JointUncertainty::covariance(std::size_t camera, double range_offset_sigma) const {
    return pose_block(with_offset(inverse_, range_offset_sigma), camera);
}

Matrix6d JointUncertainty::covariance_with_offset(std::size_t camera) const {
    return scale_ * pose_block(inverse_, camera);
}

Matrix6d JointUncertainty::covariance_without_prior(std::size_t camera,
                                                    double range_offset_sigma) const {
    const Eigen::MatrixXd normal = estimated_part(total_.normal - prior_.normal);
    return pose_block(with_offset(inverse_information(normal), range_offset_sigma), camera);
}

Eigen::Matrix<double, 7, 7> JointUncertainty::information(std::size_t camera) const {
    std::vector<Eigen::Index> both;
    for (Eigen::Index i = 0; i < 6; ++i) both.push_back(6 * static_cast<Eigen::Index>(camera) + i);
    both.push_back(6 * static_cast<Eigen::Index>(layout_.cameras()));
    Eigen::Matrix<double, 7, 7> known = part(inverse_, both, both).inverse();
    known(6, 6) -= 1.0 / (range_offset_sigma_ * range_offset_sigma_);
    return known;
}

Matrix6d JointUncertainty::covariance_considered(std::size_t camera,
                                                 const ConsiderParams& params) const {
    Eigen::MatrixXd all = with_offset(inverse_, params.range_offset_sigma);
    const auto consider = [&](Eigen::Index parameter, double sigma) {
        // How the estimate answers to that parameter's error.
        const Eigen::VectorXd shift =
            -inverse_ * part(total_.normal, estimated_, {parameter}) * sigma;
        all += shift * shift.transpose();
    };

    for (std::size_t c = 0; c < layout_.cameras(); ++c) {
        if (!free_focal_[c]) consider(layout_.focal(c), params.focal_sigma);
        consider(layout_.centre(c), params.principal_point_sigma_px);
        consider(layout_.centre(c) + 1, params.principal_point_sigma_px);
    }
    return pose_block(all, camera);
}

Diagnosis::FocalScale JointUncertainty::focal(std::size_t camera) const {
    Diagnosis::FocalScale result;
    const Eigen::Index at = layout_.focal(camera);
    std::vector<Eigen::Index> with = estimated_;
    if (free_focal_[camera]) {
        const auto place = std::find(with.begin(), with.end(), at) - with.begin();
        result.scale = focal_[camera];
        result.sigma = std::sqrt(scale_ * inverse_(place, place));
        result.estimated = true;
        return result;
    }
    with.push_back(at);
    const Eigen::MatrixXd inverse = inverse_information(part(total_.normal, with, with));
    const auto last = static_cast<Eigen::Index>(with.size()) - 1;
    double step = 0.0;
    for (Eigen::Index i = 0; i <= last; ++i)
        step -= inverse(last, i) * total_.gradient(with[static_cast<std::size_t>(i)]);
    const double variance = inverse(last, last);
    // What the parameter would take away from chi-square says nothing against the noise.
    const double left = chi2_ - step * step / variance;
    result.scale = focal_[camera] + step;
    result.sigma = std::sqrt(variance * variance_scale_of(left, freedom_ - 1));
    return result;
}

std::vector<double> JointUncertainty::influences() const {
    std::vector<double> shares;
    double sum = 0.0;
    for (const JointInformation& scene : scenes_) {
        shares.push_back(std::max(0.0, (inverse_ * estimated_part(scene.normal)).trace()));
        sum += shares.back();
    }
    for (double& share : shares) share = sum > 0.0 ? share / sum : 0.0;
    return shares;
}

}  // namespace petal
