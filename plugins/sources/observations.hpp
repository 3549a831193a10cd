// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "petal/calibration/observation.hpp"
#include "petal/rawlog/rawlog_reader.hpp"
#include "petal/run.hpp"
#include "petal/spec.hpp"
#include "petal/stage.hpp"

namespace petal {

struct ObservationsParams {
    std::vector<std::filesystem::path> files = {"${data}/scene.rawlog"};
    std::vector<std::string> labels;
    std::vector<std::string> classes;
};

/// Observations of rawlogs one by one, as a stream.
class ObservationsSource final : public Stage {
   public:
    using Params = ObservationsParams;
    static void describe(Spec<Params>& spec);
    explicit ObservationsSource(Params params) : params_(std::move(params)) {}
    void run(Run& run) override;

   private:
    bool selects() const { return !params_.labels.empty() || !params_.classes.empty(); }
    /// Notes which patterns the observation fits.
    bool takes(const mrpt::obs::CObservation& observation);
    /// Reads one object, or opens or closes a file. False when there is nothing more.
    bool advance(Run& run);
    void add(const mrpt::obs::CObservation::Ptr& observation, Run& run);
    void add_frame(const mrpt::serialization::CSerializable::Ptr& object, Run& run);
    void keep_the_rest();
    void emit(Run& run);
    void tell_progress(Run& run);
    void tell(Run& run);

    Params params_;
    std::size_t next_file_ = 0;
    std::uint64_t bytes_ = 0;       ///< of all files, as they lie on the disk
    std::uint64_t bytes_done_ = 0;  ///< of those that are read
    std::unique_ptr<RawlogReader> reader_;
    /// Read, not yet emitted. The last one waits until it is known what stands behind it.
    std::deque<Observation> ready_;
    RawlogPlace::Objects loose_;  ///< since the last observation: what is none
    std::uint64_t left_out_ = 0;  ///< actions that do not go along
    std::uint64_t emitted_ = 0;
    std::set<std::string> fitted_;   ///< patterns that have fitted an observation
    std::set<std::string> sensors_;  ///< "'label' (class)" of all that were read
};

}  // namespace petal
