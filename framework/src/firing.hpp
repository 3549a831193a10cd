// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "petal/run.hpp"
#include "petal/spec.hpp"

namespace petal {

/// What a firing needs of the run around it. The runner implements it, and the test harness. All of
/// it may be called from several threads at a time.
class RunServices {
   public:
    virtual ~RunServices() = default;
    virtual void log(const std::string& stage, LogLevel level, const std::string& message) = 0;
    virtual void note(const std::string& stage, const FrameInfo& frame, const Note& note) = 0;
    virtual void verdict(const std::string& stage, Level level,
                         const std::vector<std::string>& reasons) = 0;
    virtual void progress(const std::string& stage, double done, double total,
                          std::string_view unit) = 0;
    virtual void used_file(const std::filesystem::path& path) = 0;
    /// A stage is about to write the product `name`, relative to the folder.
    /// \throws Error when the name is the run's own, or was claimed before.
    virtual void claim_product(const std::string& stage, const std::filesystem::path& name) = 0;
    virtual bool debug(const std::string& stage) const = 0;
    virtual bool cancelled() const = 0;
    virtual int threads() const = 0;
    virtual std::uint64_t seed() const = 0;
    virtual const std::filesystem::path& folder() const = 0;
};

/// The packets that a firing sees, for each input port in the order of the declaration: those of
/// its wires, in order.
struct PortInput {
    bool wired = false;
    std::vector<AnyPacket> packets;
};
using PortPackets = std::vector<PortInput>;
/// What a firing wrote, for each output port in the order of the declaration.
using OutputPackets = std::vector<AnyPacket>;

/// A stage breaks the contract of its ports: a fault of the stage, not of its input.
class StageFault : public Error {
   public:
    using Error::Error;
};

/// One call of a stage's run() or finish(): its packets in, its packets out.
class Firing final : public Run {
   public:
    /// `frame` is that of the inputs; where it is null the firing has a frame of its own, `number`.
    /// \pre one entry of `inputs` a declared port.
    Firing(const StageSpec& spec, const std::string& id, std::shared_ptr<const FrameInfo> frame,
           std::uint64_t number, PortPackets inputs, RunServices& services);

    bool wired(std::string_view port) const override;
    const FrameInfo& frame() const override { return shared_frame_ ? *shared_frame_ : own_frame_; }
    void set_frame(std::string name, double stamp) override;
    void end_of_data() override;
    Rng& rng() override;
    int threads() const override { return services_.threads(); }
    bool cancelled() const override { return services_.cancelled(); }
    void log(LogLevel level, const std::string& message) override;
    void note(const Note& note) override;
    void verdict(Level level, const std::vector<std::string>& reasons) override;
    void progress(double done, double total, std::string_view unit) override {
        services_.progress(id_, done, total, unit);
    }
    void used_file(const std::filesystem::path& path) override { services_.used_file(path); }
    bool debug() const override { return services_.debug(id_); }
    void save(const std::string& name,
              const std::function<void(const std::filesystem::path&)>& writer) override;
    void output(const std::string& name,
                const std::function<void(const std::filesystem::path&)>& writer) override;
    std::filesystem::path output_path(const std::filesystem::path& name) override;

    /// True once a source said that there are no more frames.
    bool ended() const { return ended_; }
    /// What was written. Empty where a source ended. \throws Error unless every output port was
    /// written (none, where a source ended).
    OutputPackets take_outputs();
    /// \throws Error when something was written: finish() of a stage that does not gather has no
    /// ports.
    void expect_no_outputs() const;

   protected:
    const AnyPacket& input(std::string_view port) const override;
    const std::vector<AnyPacket>& inputs(std::string_view port) const override;
    void publish(std::string_view port, AnyPacket packet) override;

   private:
    /// The port's entry, or null where it is not wired.
    const PortInput* find_input(std::string_view port) const;
    /// The name of a port that was written; null where none was.
    const std::string* written_port() const;

    const StageSpec& spec_;
    const std::string& id_;
    std::shared_ptr<const FrameInfo> shared_frame_;  ///< of the inputs; may be null
    FrameInfo own_frame_;                            ///< where it is
    PortPackets inputs_;
    RunServices& services_;
    OutputPackets outputs_;
    std::optional<Rng> rng_;
    bool ended_ = false;
};

}  // namespace petal
