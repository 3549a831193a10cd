// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solvers/detail/joint_input.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "petal/calibration/angles.hpp"
#include "petal/error.hpp"
#include "solvers/detail/corner_covariance.hpp"

namespace petal {
namespace {

constexpr std::size_t kFewestPoints = 4;  // three leave up to four poses

/// What one camera saw of one scene.
struct SeenScene {
    std::uint64_t number = 0;
    std::string name;
    const CameraPairs* pairs = nullptr;
};

/// By scene number.
std::vector<SeenScene> seen_scenes(const std::vector<Packet<Correspondences>>& packets) {
    std::vector<SeenScene> seen;
    for (const auto& packet : packets)
        for (const CameraPairs& pairs : packet->cameras) {
            SeenScene scene{pairs.scene, pairs.scene_name, &pairs};
            if (scene.name.empty()) scene.name = packet.frame.name;
            if (scene.name.empty()) scene.name = "scene " + std::to_string(scene.number);
            seen.push_back(std::move(scene));
        }
    std::stable_sort(seen.begin(), seen.end(),
                     [](const SeenScene& a, const SeenScene& b) { return a.number < b.number; });
    return seen;
}

bool has_geometry(const CameraPairs::BoardPair& board) {
    return !board.corners_board.empty();
}

/// The LiDAR's board behind a pair: what cameras of one scene may share.
using BoardKey = std::pair<std::uint64_t, int>;

/// Puts one group together, camera by camera.
class GroupBuilder {
   public:
    GroupBuilder(const std::vector<SeenScene>& seen, const JointNoiseParams& params)
        : seen_(seen), params_(params) {
        input_.model.point_sigma = params.point_sigma;
    }

    void add(const SolveInput& camera) {
        const std::size_t index = input_.cameras.size();
        input_.cameras.push_back(camera);
        input_.model.cameras.push_back(camera_model(camera.model, params_.use_distortion));
        for (const SeenScene& seen : seen_)
            if (seen.pairs->camera == camera.camera && seen.pairs->lidar == camera.lidar &&
                !seen.pairs->pairs.empty())
                add(index, seen);
    }
    JointInput take() { return std::move(input_); }

   private:
    std::size_t scene_index(const SeenScene& seen) {
        auto& scenes = input_.model.scenes;
        const auto known = std::find_if(scenes.begin(), scenes.end(), [&](const auto& scene) {
            return scene.number == seen.number;
        });
        if (known != scenes.end()) return static_cast<std::size_t>(known - scenes.begin());
        scenes.push_back({seen.number, seen.name});
        return scenes.size() - 1;
    }

    void add(std::size_t camera, const SeenScene& seen) {
        const std::size_t scene = scene_index(seen);
        const auto& boards = seen.pairs->boards;
        for (std::size_t b = 0; b < boards.size(); ++b)
            if (has_geometry(boards[b])) add_board(camera, scene, seen, b);
        for (const PointPair& pair : seen.pairs->pairs) {
            const bool of_board = pair.board >= 0;
            if (of_board && static_cast<std::size_t>(pair.board) < boards.size() &&
                has_geometry(boards[static_cast<std::size_t>(pair.board)]))
                continue;
            check_pair(pair, seen);
            JointPoint point;
            point.camera = camera;
            point.scene = scene;
            point.lidar = pair.lidar;
            point.image = pair.image;
            point.covariance = params_.sigma_px * params_.sigma_px * pair.covariance;
            point.redundancy = of_board ? params_.board_redundancy : 1.0;
            input_.model.points.push_back(point);
        }
    }

    static void check_pair(const PointPair& pair, const SeenScene& seen) {
        const std::string who = "scene '" + seen.name + "', camera '" + seen.pairs->camera +
                                "': a pair (board " + std::to_string(pair.board) + ", corner " +
                                std::to_string(pair.corner) + ")";
        if (!pair.lidar.allFinite() || !pair.image.allFinite())
            throw Error(who + " holds NaN or infinity; remove it, or repair what detected it");
        if (!pair.covariance.allFinite() || pair.covariance.llt().info() != Eigen::Success)
            throw Error(who +
                        " has an image covariance that is not positive definite; give px^2, or "
                        "the identity where it is unknown");
    }

    void add_board(std::size_t camera, std::size_t scene, const SeenScene& seen, std::size_t b) {
        const CameraPairs::BoardPair& pair = seen.pairs->boards[b];
        const std::string who = "scene '" + seen.name + "', camera '" + seen.pairs->camera +
                                "', board " + std::to_string(b);
        bool finite = pair.T_lidar_board.matrix().allFinite();
        for (const auto& corner : pair.corners_board) finite = finite && corner.allFinite();
        for (const auto& pixel : pair.corners_image) finite = finite && pixel.allFinite();
        if (!finite)
            throw Error(who + " holds NaN or infinity; remove it, or repair what detected it");
        if (pair.corners_image.size() != pair.corners_board.size())
            throw Error(who + " has " + std::to_string(pair.corners_board.size()) +
                        " corners but " + std::to_string(pair.corners_image.size()) +
                        " pixels; a pair needs one pixel a corner");
        JointBoard& board = shared_board(scene, pair, who);
        JointBoard::View view;
        view.camera = camera;
        view.image = pair.corners_image;
        // Another camera may see the same board in another order: its frame is turned to the first
        // one's.
        const Eigen::Isometry3d turn = board.T_lidar_board.inverse() * pair.T_lidar_board;
        for (const auto& corner : pair.corners_board) view.corners.push_back(turn * corner);
        view.whitening = pixel_whitening(image_covariance(seen, static_cast<int>(b), who),
                                         params_.min_sigma_px, who);
        board.views.push_back(std::move(view));
    }

    Eigen::MatrixXd image_covariance(const SeenScene& seen, int b, const std::string& who) const {
        const CameraPairs::BoardPair& board = seen.pairs->boards[static_cast<std::size_t>(b)];
        const auto size = static_cast<Eigen::Index>(2 * board.corners_image.size());
        if (board.image_covariance.size() > 0 &&
            (board.image_covariance.rows() != size || board.image_covariance.cols() != size))
            throw Error(who + ": the covariance of its corners is " +
                        std::to_string(board.image_covariance.rows()) + " x " +
                        std::to_string(board.image_covariance.cols()) + ", not " +
                        std::to_string(size) + " x " + std::to_string(size));
        const double unit = params_.sigma_px * params_.sigma_px;
        std::vector<Eigen::Matrix2d> each(board.corners_image.size(),
                                          unit * Eigen::Matrix2d::Identity());
        for (const PointPair& pair : seen.pairs->pairs)
            if (pair.board == b && pair.corner >= 0 &&
                static_cast<std::size_t>(pair.corner) < each.size())
                each[static_cast<std::size_t>(pair.corner)] = unit * pair.covariance;
        return corner_covariance(board.image_covariance, each, each.size(),
                                 params_.board_redundancy);
    }

    JointBoard& shared_board(std::size_t scene, const CameraPairs::BoardPair& pair,
                             const std::string& who) {
        const BoardKey key{input_.model.scenes[scene].number, pair.lidar};
        const auto known = boards_.find(key);
        if (pair.lidar >= 0 && known != boards_.end()) return input_.model.boards[known->second];
        boards_[key] = input_.model.boards.size();
        JointBoard board;
        board.scene = scene;
        board.T_lidar_board = pair.T_lidar_board;
        for (const auto& corner : pair.corners_board)
            board.centre +=
                pair.T_lidar_board * corner / static_cast<double>(pair.corners_board.size());
        board.assumed = !pair.pose_covariance;
        board.covariance = pair.pose_covariance.value_or(covariance_about(
            board.centre, params_.assumed_board_sigma, params_.assumed_board_sigma_deg / kDegrees));
        const Eigen::LLT<Matrix6d> root(board.covariance);
        if (!board.covariance.allFinite() || root.info() != Eigen::Success)
            throw Error(who +
                        ": the covariance of the LiDAR's pose is not positive definite; leave it "
                        "out where it is unknown");
        board.whitening = root.matrixL().solve(Matrix6d::Identity());
        input_.model.boards.push_back(std::move(board));
        return input_.model.boards.back();
    }

    const std::vector<SeenScene>& seen_;
    const JointNoiseParams& params_;
    JointInput input_;
    std::map<BoardKey, std::size_t> boards_;
};

/// The boards of one camera, as keys that cameras of one LiDAR may share.
std::set<BoardKey> board_keys(const SolveInput& camera, const std::vector<SeenScene>& seen) {
    std::set<BoardKey> keys;
    for (const SeenScene& scene : seen)
        if (scene.pairs->camera == camera.camera && scene.pairs->lidar == camera.lidar)
            for (const auto& board : scene.pairs->boards)
                if (has_geometry(board) && board.lidar >= 0)
                    keys.insert({scene.number, board.lidar});
    return keys;
}

}  // namespace

JointInputs joint_inputs(const std::vector<Packet<Correspondences>>& packets,
                         const JointNoiseParams& params,
                         const std::function<bool(const SolveInput&)>& wanted) {
    JointInputs result;
    const auto seen = seen_scenes(packets);
    struct Group {
        std::string lidar;
        std::set<BoardKey> keys;
        std::vector<SolveInput> cameras;
    };
    std::vector<Group> groups;
    for (SolveInput& camera : gather(packets)) {
        if (wanted && !wanted(camera)) continue;
        if (camera.pairs.size() < kFewestPoints) {
            result.too_few.push_back(std::move(camera));
            continue;
        }
        Group group{camera.lidar, board_keys(camera, seen), {}};
        const auto linked = [&](const Group& other) {
            return other.lidar == group.lidar &&
                   std::any_of(other.keys.begin(), other.keys.end(),
                               [&](const BoardKey& key) { return group.keys.count(key) > 0; });
        };
        // The new camera may link groups that were apart; they keep the order of their first one.
        auto home = groups.end();
        for (auto other = groups.begin(); other != groups.end();) {
            if (!linked(*other)) {
                ++other;
            } else if (home == groups.end()) {
                home = other++;
            } else {
                const auto at = home - groups.begin();
                home->keys.insert(other->keys.begin(), other->keys.end());
                home->cameras.insert(home->cameras.end(), other->cameras.begin(),
                                     other->cameras.end());
                other = groups.erase(other);
                home = groups.begin() + at;
            }
        }
        if (home == groups.end()) home = groups.insert(groups.end(), Group{group.lidar, {}, {}});
        home->keys.insert(group.keys.begin(), group.keys.end());
        home->cameras.push_back(std::move(camera));
    }
    for (const Group& group : groups) {
        GroupBuilder builder(seen, params);
        for (const SolveInput& camera : group.cameras) builder.add(camera);
        result.solvable.push_back(builder.take());
    }
    return result;
}

}  // namespace petal
