// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "petal/run.hpp"
#include "petal/spec.hpp"
#include "petal/stage.hpp"
#include "sinks/detail/rawlog_writer.hpp"

namespace petal {

struct RawlogSinkParams {
    std::string file = "scene.rawlog";
    int compression = 1;
};

/// Writes scenes, or single observations, to a rawlog in the run folder.
class RawlogSink final : public Stage {
   public:
    using Params = RawlogSinkParams;
    static void describe(Spec<Params>& spec);
    explicit RawlogSink(Params params) : params_(std::move(params)) {}
    void run(Run& run) override;
    void finish(Run& run) override;

   private:
    bool each_scene() const;
    void write_scene(Run& run, const std::string& name);
    void write_truth(Run& run, const std::string& name);
    void close(Run& run);

    Params params_;
    std::unique_ptr<RawlogWriter> writer_;
    std::string truth_of_;  ///< the scene whose truth lies beside the file; empty: none yet
};

}  // namespace petal
