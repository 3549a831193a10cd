// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/obs/CObservationImage.h>

#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "petal/calibration/cloud.hpp"
#include "petal/calibration/images.hpp"

namespace petal {

/// Which sensors a scene is made of.
struct SensorChoice {
    std::string lidar;                 ///< label or glob; empty: the only one there is
    std::vector<std::string> cameras;  ///< labels or globs; empty: all
    std::string image = "sharpest";    ///< of several images of one camera: sharpest, first or last

    bool takes_camera(const std::string& label) const;
};

/// The sensors of a rawlog: classes by label, to be told when a choice fits none.
class SensorList {
   public:
    void add(const mrpt::obs::CObservation& observation);
    /// "'LIDAR' (mrpt::obs::CObservationPointCloud), 'CAM' (...)", or "none".
    std::string text() const;
    /// The labels of those that give points, and of those that give images.
    const std::set<std::string>& lidars() const { return lidars_; }
    const std::set<std::string>& cameras() const { return cameras_; }

   private:
    std::map<std::string, std::set<std::string>> classes_;
    std::set<std::string> lidars_;
    std::set<std::string> cameras_;
};

/// Accumulates the observations of one scene: all points of one LiDAR, one image of each camera,
/// and beside it the first, a middle one and the last, for who asks whether anything moved.
class SceneBuilder {
   public:
    explicit SceneBuilder(SensorChoice choice) : choice_(std::move(choice)) {}

    /// Takes the observation where the choice names it; `load` is called before its data are used.
    /// \throws Error where the data cannot be used (an image of another size than its camera's,
    /// ...).
    void add(const mrpt::obs::CObservation::Ptr& observation,
             const std::function<void(mrpt::obs::CObservation&)>& load);

    bool empty() const { return parts_ == 0 && cameras_.empty(); }
    /// The LiDAR taken; empty where none has come yet.
    const std::string& lidar() const { return cloud_.sensor_label; }
    const std::vector<std::string>& remarks() const { return remarks_; }
    /// s since the epoch of the first message or image that has a time; 0 where none has.
    double stamp() const { return stamp_; }

    /// What was gathered. Call each once.
    Cloud take_cloud();
    Images take_images();

   private:
    void add_points(mrpt::obs::CObservation& observation);
    void add_image(mrpt::obs::CObservationImage& observation);
    void note_stamp(mrpt::Clock::time_point stamp);

    /// An image with its number among those of its camera.
    struct Numbered {
        CameraImage image;
        int number = 0;
    };
    /// What is kept of one camera, however many images it took.
    struct Candidate {
        Numbered best;
        double sharpness = 0.0;
        int seen = 0;
        std::vector<Numbered> spread;  ///< every stride-th, beginning with the first
        int stride = 1;
        Numbered last;
    };
    static void spread_out(Candidate& candidate, Numbered image);

    SensorChoice choice_;
    Cloud cloud_{std::make_shared<mrpt::maps::CPointsMapXYZI>(), "", {}, {}, {}};
    std::shared_ptr<mrpt::maps::CPointsMapXYZI> points_ =
        std::make_shared<mrpt::maps::CPointsMapXYZI>();
    std::size_t parts_ = 0;
    std::map<std::string, Candidate> cameras_;
    std::vector<std::string> remarks_;
    double stamp_ = 0.0;
};

}  // namespace petal
