// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <mrpt/core/Clock.h>
#include <mrpt/img/TCamera.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/poses/CPose3D.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace petal {

/// The smallest and the largest of some numbers.
struct Extent {
    double min = 0.0;
    double max = 0.0;
    std::size_t count = 0;

    void add(double value);
};

/// The middle one of some numbers (the upper of the two middle ones); 0 where there are none.
double median(std::vector<double> values);

/// The stamps of one sensor's messages, in the order of the file.
class StampInventory {
   public:
    void add(mrpt::Clock::time_point stamp);

    std::optional<mrpt::Clock::time_point> first() const { return first_; }  ///< the earliest
    std::optional<mrpt::Clock::time_point> last() const { return last_; }    ///< the latest
    std::size_t unknown() const { return unknown_; }    ///< messages without a stamp
    std::size_t backward() const { return backward_; }  ///< stamps before the one before
    /// s, the median of the intervals that run forward; 0 where there is none.
    double interval() const { return median(intervals_); }
    /// Hz, of the median interval; 0 where there is none.
    double rate() const;
    /// More than a tenth of the intervals is off their median by more than half of it.
    bool unsteady() const;
    /// Intervals longer than three times their median: how many, and the longest in s.
    std::pair<std::size_t, double> gaps() const;

   private:
    std::optional<mrpt::Clock::time_point> first_, last_, latest_;
    std::size_t unknown_ = 0;
    std::size_t backward_ = 0;
    std::vector<double> intervals_;  ///< s, those that are not negative
};

/// The points of one sensor.
struct PointsInventory {
    std::size_t total = 0;
    std::vector<double> per_message;
    bool has_intensity = false;
    Extent intensity;  ///< as petal reads it: bytes divided by 255
    Extent range;      ///< m from the sensor, of the points that are finite and not its origin
    std::size_t not_finite = 0;
    std::size_t at_origin = 0;  ///< exactly (0, 0, 0): how some drivers write "no return"
    std::string no_cloud;       ///< why petal makes no cloud of them; empty where it does
};

/// The images of one sensor, or of one of its eyes.
struct ImagesInventory {
    std::size_t count = 0;
    std::size_t empty = 0;
    int width = 0, height = 0;        ///< px, of the first image
    int channels = 0;                 ///< of the first image
    std::size_t other_sizes = 0;      ///< images of another size or number of channels
    mrpt::img::TCamera camera;        ///< of the first image; fx = 0 where it was never calibrated
    std::size_t other_cameras = 0;    ///< images with other camera parameters
    std::size_t size_mismatches = 0;  ///< images of another size than their camera parameters
};

/// All messages of one label and class.
struct SensorInventory {
    std::string label;
    std::string class_name;  ///< with its namespace
    std::size_t messages = 0;
    StampInventory stamps;
    std::optional<mrpt::poses::CPose3D> pose;  ///< on the vehicle, of the first message
    std::size_t other_poses = 0;
    std::size_t external = 0;    ///< messages that keep data in files of their own
    std::size_t unloaded = 0;    ///< of those, how many could not be loaded
    std::string first_unloaded;  ///< why
    std::optional<PointsInventory> points;
    std::map<std::string, ImagesInventory> images;  ///< by eye: "", "left", "right", "intensity"
};

/// What a rawlog holds, gathered object by object as they are read. Holds no observation: its
/// memory is some numbers a message.
class RawlogInventory {
   public:
    /// What an observation keeps outside is loaded by this, which throws Error where it cannot.
    using Load = std::function<void(mrpt::obs::CObservation&)>;

    /// An object as it stands in the rawlog: an observation, a sensory frame or an action.
    void add(mrpt::serialization::CSerializable& object, const Load& load);

    enum class Layout { empty, observations, sensory_frames, mixed };
    Layout layout() const;
    std::size_t observations() const { return observations_; }  ///< those of frames too
    std::size_t sensory_frames() const { return frames_; }
    const std::map<std::string, std::size_t>& actions() const { return actions_; }  ///< by class
    /// By label, then class.
    const std::map<std::pair<std::string, std::string>, SensorInventory>& sensors() const {
        return sensors_;
    }
    /// The earliest and the latest stamp; comments, which are no measurement, do not count.
    std::optional<std::pair<mrpt::Clock::time_point, mrpt::Clock::time_point>> time() const;

   private:
    void add_observation(mrpt::obs::CObservation& observation, const Load& load);

    std::size_t observations_ = 0;
    std::size_t free_observations_ = 0;  ///< outside of sensory frames
    std::size_t frames_ = 0;
    std::size_t action_objects_ = 0;
    std::map<std::string, std::size_t> actions_;
    std::map<std::pair<std::string, std::string>, SensorInventory> sensors_;
};

}  // namespace petal
