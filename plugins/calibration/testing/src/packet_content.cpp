// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "packet_content.hpp"

#include <mrpt/io/CMemoryStream.h>
#include <mrpt/serialization/CArchive.h>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "petal/calibration/boards.hpp"
#include "petal/calibration/cloud.hpp"
#include "petal/calibration/correspondences.hpp"
#include "petal/calibration/extrinsics.hpp"
#include "petal/calibration/images.hpp"
#include "petal/calibration/metrics.hpp"
#include "petal/calibration/observation.hpp"
#include "petal/calibration/planes.hpp"
#include "petal/calibration/truth.hpp"

namespace petal::testing {
namespace {

/// Puts values one behind the other as bytes; texts and lists with their length.
class Content {
   public:
    template <class T, std::enable_if_t<std::is_arithmetic_v<T> || std::is_enum_v<T>, int> = 0>
    Content& add(T value) {
        return add_bytes(&value, sizeof(value));
    }
    Content& add(const std::string& text) {
        add(text.size());
        return add_bytes(text.data(), text.size());
    }
    Content& add(mrpt::Clock::time_point stamp) { return add(stamp.time_since_epoch().count()); }
    template <class Derived>
    Content& add(const Eigen::PlainObjectBase<Derived>& matrix) {
        return add_bytes(matrix.derived().data(), sizeof(typename Derived::Scalar) *
                                                      static_cast<std::size_t>(matrix.size()));
    }
    Content& add(const Eigen::Isometry3d& pose) { return add(pose.matrix()); }
    Content& add(const mrpt::serialization::CSerializable& object) {
        mrpt::io::CMemoryStream stream;
        mrpt::serialization::archiveFrom(stream) << object;
        return add_bytes(stream.getRawBufferData(),
                         static_cast<std::size_t>(stream.getTotalBytesCount()));
    }
    Content& add(const mrpt::img::CImage& image) {
        if (image.isEmpty()) return add(0);
        const std::size_t row_bytes =
            image.getWidth() * (image.isColor() ? 3U : 1U);  // 8 bit a channel
        add(image.getWidth()).add(image.getHeight()).add(row_bytes);
        for (unsigned row = 0; row < image.getHeight(); ++row)
            add_bytes(image.ptrLine<std::uint8_t>(row), row_bytes);
        return *this;
    }
    template <class T>
    Content& add(const std::vector<T>& values) {
        add(values.size());
        for (const T& value : values) add(value);
        return *this;
    }
    template <class T>
    Content& add(const std::optional<T>& value) {
        add(value.has_value());
        return value ? add(*value) : *this;
    }
    Content& add(const std::map<std::string, double>& values) {
        add(values.size());
        for (const auto& [name, value] : values) add(name).add(value);
        return *this;
    }

    Content& add(const Cloud::Part& part) { return add(part.begin).add(part.stamp); }
    Content& add(const Cloud& cloud) {
        for (std::size_t i = 0; i < cloud.size(); ++i) {
            float x = 0.0F;
            float y = 0.0F;
            float z = 0.0F;
            cloud.points->getPoint(i, x, y, z);
            add(x).add(y).add(z).add(cloud.points->getPointIntensity(i));
        }
        return add(cloud.size())
            .add(cloud.sensor_label)
            .add(static_cast<const mrpt::serialization::CSerializable&>(cloud.sensor_pose))
            .add(cloud.parts)
            .add(cloud.scene_index);
    }
    Content& add(const mrpt::img::TCamera& camera) {
        return add(static_cast<const mrpt::serialization::CSerializable&>(camera));
    }
    Content& add(const CameraImage& camera) {
        return add(camera.label)
            .add(camera.image)
            .add(camera.camera)
            .add(camera.stamp)
            .add(static_cast<const mrpt::serialization::CSerializable&>(camera.sensor_pose));
    }
    Content& add(const Images& images) { return add(images.cameras); }
    Content& add(const Plane& plane) {
        return add(plane.normal)
            .add(plane.offset)
            .add(plane.covariance)
            .add(plane.rms)
            .add(plane.inliers);
    }
    Content& add(const Planes& planes) { return add(planes.planes); }
    Content& add(const LidarBoard& board) {
        return add(board.target)
            .add(board.T_lidar_board)
            .add(board.corners)
            .add(board.covariance)
            .add(board.quality);
    }
    Content& add(const LidarBoards& boards) {
        return add(boards.lidar).add(boards.boards).add(boards.findings);
    }
    Content& add(const ImageBoard& board) {
        return add(board.target)
            .add(board.camera)
            .add(board.corners)
            .add(board.covariance)
            .add(board.joint_covariance)
            .add(board.quality);
    }
    Content& add(const CameraInfo& info) { return add(info.label).add(info.camera); }
    Content& add(const ImageBoards& boards) {
        return add(boards.cameras).add(boards.boards).add(boards.findings);
    }
    Content& add(const PointPair& pair) {
        return add(pair.lidar)
            .add(pair.image)
            .add(pair.covariance)
            .add(pair.board)
            .add(pair.corner);
    }
    Content& add(const OrderDecision& order) {
        return add(order.by)
            .add(order.rms_px)
            .add(order.runner_up_rms_ratio)
            .add(order.runner_up_chi2)
            .add(order.contradicts_priors)
            .add(order.reason);
    }
    Content& add(const CameraPairs::BoardPair& pair) {
        return add(pair.lidar)
            .add(pair.image)
            .add(pair.T_lidar_board)
            .add(pair.pose_covariance)
            .add(pair.corners_board)
            .add(pair.corners_image)
            .add(pair.image_covariance);
    }
    Content& add(const CameraPairs& pairs) {
        return add(pairs.scene)
            .add(pairs.scene_name)
            .add(pairs.camera)
            .add(pairs.lidar)
            .add(pairs.model)
            .add(pairs.pairs)
            .add(pairs.order)
            .add(pairs.initial)
            .add(pairs.boards);
    }
    Content& add(const Correspondences& all) { return add(all.cameras); }
    Content& add(const Residual& residual) {
        return add(residual.scene)
            .add(residual.board)
            .add(residual.corner)
            .add(residual.image)
            .add(residual.error_px);
    }
    Content& add(const CameraExtrinsics& camera) {
        return add(camera.camera)
            .add(camera.lidar)
            .add(camera.model)
            .add(camera.T_camera_lidar)
            .add(camera.covariance)
            .add(camera.sigma_translation)
            .add(camera.sigma_rotation)
            .add(camera.weakest_direction)
            .add(camera.chi2)
            .add(camera.degrees_of_freedom)
            .add(camera.residuals)
            .add(camera.order)
            .add(camera.diagnosis);
    }
    Content& add(const Diagnosis::Scene& scene) {
        return add(scene.scene)
            .add(scene.name)
            .add(scene.chi2)
            .add(scene.degrees_of_freedom)
            .add(scene.influence)
            .add(scene.shift)
            .add(scene.shift_sigmas)
            .add(scene.solvable_without)
            .add(scene.outlier);
    }
    Content& add(const Diagnosis::Drift& drift) {
        return add(drift.range).add(drift.px).add(drift.considered_px);
    }
    Content& add(const Diagnosis::Advice& advice) {
        return add(advice.sentence)
            .add(advice.range)
            .add(advice.u)
            .add(advice.v)
            .add(advice.pitch)
            .add(advice.yaw)
            .add(advice.sigma_translation_before)
            .add(advice.sigma_translation_after)
            .add(advice.sigma_rotation_before)
            .add(advice.sigma_rotation_after);
    }
    Content& add(const Diagnosis::FocalScale& focal) {
        return add(focal.scale).add(focal.sigma).add(focal.estimated);
    }
    Content& add(const Diagnosis::Prior& prior) {
        return add(prior.distance).add(prior.sigmas).add(prior.covariance_without_prior);
    }
    Content& add(const Diagnosis& diagnosis) {
        return add(diagnosis.covariance_considered)
            .add(diagnosis.variance_scale)
            .add(diagnosis.scenes)
            .add(diagnosis.drifts)
            .add(diagnosis.advice)
            .add(diagnosis.focal)
            .add(diagnosis.prior);
    }
    Content& add(const Extrinsics& extrinsics) {
        return add(extrinsics.cameras).add(extrinsics.level).add(extrinsics.reasons);
    }
    Content& add(const Metric& metric) {
        return add(metric.name).add(metric.value).add(metric.unit).add(metric.scene);
    }
    Content& add(const Finding& finding) { return add(finding.level).add(finding.reason); }
    Content& add(const Metrics& metrics) { return add(metrics.values).add(metrics.findings); }
    Content& add(const Truth::Board& board) {
        return add(board.target)
            .add(board.T_lidar_board)
            .add(board.corners_lidar)
            .add(board.corners_image);
    }
    Content& add(const Truth& truth) {
        return add(truth.T_camera_lidar).add(truth.boards).add(truth.labels);
    }
    Content& add(const Observation& observation) {
        const RawlogPlace& place = observation.place;
        for (const auto* objects : {&place.before, &place.after}) {
            add(objects->size());
            for (const auto& object : *objects) add(*object);
        }
        return add(place.in_frame)
            .add(place.ends_frame)
            .add(static_cast<const mrpt::serialization::CSerializable&>(*observation.observation));
    }

    std::string bytes;

   private:
    Content& add_bytes(const void* data, std::size_t size) {
        bytes.append(static_cast<const char*>(data), size);
        return *this;
    }
};

template <class T>
void add_content(ContractInputs& inputs) {
    inputs.add_content<T>([](const T& value) {
        Content content;
        content.add(value);
        return content.bytes;
    });
}

}  // namespace

void add_calibration_contents(ContractInputs& inputs) {
    add_content<Cloud>(inputs);
    add_content<Images>(inputs);
    add_content<Planes>(inputs);
    add_content<LidarBoards>(inputs);
    add_content<ImageBoards>(inputs);
    add_content<Correspondences>(inputs);
    add_content<Extrinsics>(inputs);
    add_content<Metrics>(inputs);
    add_content<Truth>(inputs);
    add_content<Observation>(inputs);
}

}  // namespace petal::testing
