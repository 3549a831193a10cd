// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "petal/packet.hpp"
#include "petal/run.hpp"
#include "petal/spec.hpp"

namespace petal::testing {

/// Fires one stage as the runner would, without a pipeline:
///
///     StageHarness stage = StageHarness::of<RadiusOutlier>();
///     stage.set("radius", 0.2).give<Cloud>("cloud", cloud);
///     stage.fire();
///     EXPECT_EQ(stage.out<Cloud>("cloud").size(), 3u);
///
/// Parameters go through the declaration: unknown names, wrong kinds and values out of range throw
/// petal::Error, as do violated relations. Packets are sealed. A source is fired until it ends.
class StageHarness {
   public:
    template <class S>
    static StageHarness of(std::string type = "test.stage") {
        return StageHarness(describe_stage<S>(std::move(type)));
    }
    explicit StageHarness(StageSpec spec);
    ~StageHarness();
    StageHarness(StageHarness&&) noexcept;
    StageHarness& operator=(StageHarness&&) noexcept;

    StageHarness& set(const std::string& param, Value value);
    StageHarness& set(const std::string& param, const char* value) {
        return set(param, Value(std::string(value)));
    }
    StageHarness& set(const std::string& param, int value) {
        return set(param, Value(static_cast<std::int64_t>(value)));
    }
    // Exact matches, or 0.2 and false would be taken for an int.
    StageHarness& set(const std::string& param, double value) { return set(param, Value(value)); }
    StageHarness& set(const std::string& param, bool value) { return set(param, Value(value)); }
    /// Adds a packet to an input port. On a reads() port the k-th packet is frame k; a gathers()
    /// port gets them all.
    template <class T>
    StageHarness& give(const std::string& port, T value, std::string frame_name = "") {
        const std::uint64_t number = given(port);
        return give_packet(
            port, make_packet(std::move(value), FrameInfo{number, std::move(frame_name), 0.0}));
    }
    StageHarness& give_packet(const std::string& port, AnyPacket packet);
    StageHarness& seed(std::uint64_t seed);
    StageHarness& threads(int count);
    StageHarness& debug(bool on);
    StageHarness& cancel();  ///< fire as if the user had cancelled already

    /// Cancels so many seconds after fire() begins.
    StageHarness& cancel_after(double seconds);
    /// Makes each call of the stage on a thread of its own.
    StageHarness& change_threads(bool on);

    /// Makes a fresh stage and runs it over what was given. Exceptions pass through. Earlier
    /// outputs are dropped.
    void fire();

    /// What was written to an output port, frame by frame.
    template <class T>
    std::vector<Packet<T>> all(const std::string& port) const {
        std::vector<Packet<T>> packets;
        for (const AnyPacket& any : written(port)) {
            if (!any.holds(PacketTraits<T>::name))
                throw Error("port " + port + " holds " + any.type);
            packets.push_back({std::static_pointer_cast<const T>(any.value), *any.frame});
        }
        return packets;
    }
    /// The only packet of a port. \throws Error when there is not exactly one.
    template <class T>
    const T& out(const std::string& port) const {
        const auto packets = all<T>(port);
        if (packets.size() != 1)
            throw Error("port " + port + ": " + std::to_string(packets.size()) + " packets, not 1");
        return *packets.front().value;
    }
    const std::vector<AnyPacket>& written(const std::string& port) const;

    const StageSpec& spec() const;
    const std::vector<Note>& notes() const;
    const std::vector<std::string>& logs() const;
    std::optional<Level> verdict() const;
    const std::vector<std::string>& reasons() const;
    const std::vector<std::filesystem::path>& used_files() const;
    /// What Run::progress() was told.
    struct Progress {
        double done = 0.0;
        double total = 0.0;
        std::string unit;
    };
    const std::vector<Progress>& progress() const;
    /// The run folder: save() and output() write below it. Removed with the harness.
    const std::filesystem::path& folder() const;

   private:
    std::uint64_t given(const std::string& port) const;

    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace petal::testing
