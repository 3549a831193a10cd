// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "petal/error.hpp"
#include "petal/packet.hpp"

namespace petal {

/// Why a stage found nothing, or less than it looked for. Empty fields are left out when told.
struct Note {
    std::string looked_for;    ///< "boards with four square holes"
    std::string nearest_miss;  ///< "3 of 4 holes; the fourth has rectangularity 1.41"
    std::string threshold;     ///< "max_rectangularity 1.25"
    std::string hint;          ///< one thing to try
};

/// How far a result can be used. The run's level is the worst of its stages' levels.
enum class Level { usable, weak, not_usable };

/// "usable", "weak", "not_usable".
const char* to_string(Level level);

enum class LogLevel { debug, info, warning };

/// The only source of randomness: seeded by (run seed, stage id, frame).
using Rng = std::mt19937_64;

/// What a stage sees of the run while it fires: its packets, and where it tells what it did.
/// Valid only inside run() or finish(), and only on that thread.
class Run {
   public:
    virtual ~Run() = default;

    // --- packets
    // -----------------------------------------------------------------------------------
    /// The packet on a reads() port. \throws Error when an optional port is not wired.
    template <class T>
    const T& in(std::string_view port) const {
        return *static_cast<const T*>(checked<T>(port, input(port)).value.get());
    }
    /// The same, shared: to keep it, or to hand it on with forward().
    template <class T>
    std::shared_ptr<const T> in_ptr(std::string_view port) const {
        return std::static_pointer_cast<const T>(checked<T>(port, input(port)).value);
    }
    /// Null where an optional port is not wired.
    template <class T>
    std::shared_ptr<const T> find(std::string_view port) const {
        return wired(port) ? in_ptr<T>(port) : nullptr;
    }
    /// All packets of a gathers() port, ordered by wire as the pipeline lists them, then by frame.
    template <class T>
    std::vector<Packet<T>> all(std::string_view port) const {
        std::vector<Packet<T>> packets;
        for (const AnyPacket& any : inputs(port))
            packets.push_back({std::static_pointer_cast<const T>(checked<T>(port, any).value),
                               any.frame ? *any.frame : FrameInfo{}});
        return packets;
    }
    virtual bool wired(std::string_view port) const = 0;

    /// Publishes a value on an output port: sealed, then shared. Pass it with std::move.
    template <class T>
    void write(std::string_view port, T value) {
        publish(port, make_packet(std::move(value)));
    }
    /// Publishes a value that is shared already (an input passed on): no copy.
    template <class T>
    void forward(std::string_view port, std::shared_ptr<const T> value) {
        if (!value)
            throw Error("forward() on port '" + std::string(port) + "' was given no packet");
        const std::size_t bytes = PacketTraits<T>::bytes(*value);
        publish(port, AnyPacket{std::move(value), PacketTraits<T>::name, bytes, nullptr});
    }

    /// The frame in work. In finish() it has no name.
    virtual const FrameInfo& frame() const = 0;
    /// A source names the frame that it is about to write; the number is the framework's.
    virtual void set_frame(std::string name, double stamp) = 0;
    /// A source has no more frames. It writes nothing in that call.
    virtual void end_of_data() = 0;

    // --- the run
    // -----------------------------------------------------------------------------------
    virtual Rng& rng() = 0;
    /// Threads this stage may use inside one call (at least 1). Sums must not depend on it.
    virtual int threads() const = 0;
    /// True once the user cancelled. Poll it in long loops.
    virtual bool cancelled() const = 0;
    void check_cancelled() const {
        if (cancelled()) throw Cancelled();
    }

    // --- telling
    // -----------------------------------------------------------------------------------
    virtual void log(LogLevel level, const std::string& message) = 0;
    virtual void note(const Note& note) = 0;
    /// How far the result can be used, and why. One call a run for each stage that judges.
    virtual void verdict(Level level, const std::vector<std::string>& reasons) = 0;
    /// A source tells how far it is, e.g. progress(3, 40, "files"), for the remaining time that a
    /// terminal shows; bytes are told as "B". Cheap: once a frame will do. `total` is 0 where it is
    /// not known.
    virtual void progress(double done, double total, std::string_view unit) = 0;
    /// Records a file that the result depends on: run.json tells its checksum.
    virtual void used_file(const std::filesystem::path& path) = 0;

    // --- files
    // -------------------------------------------------------------------------------------
    /// True where the user asked for this stage's debug files.
    virtual bool debug() const = 0;
    /// Writes stages/<id>/[<frame name>/]<name> under the run folder: `writer` fills the path that
    /// it is given (same extension), which then gets its name. Whole or not at all.
    virtual void save(const std::string& name,
                      const std::function<void(const std::filesystem::path&)>& writer) = 0;
    /// Writes a product, <run folder>/<name>: result.json and the like. Whole or not at all.
    virtual void output(const std::string& name,
                        const std::function<void(const std::filesystem::path&)>& writer) = 0;
    /// Where a product of that name will lie, for a stage that streams into it with a PendingFile.
    /// The name is the stage's from then on: ask once a product. \throws Error when `name` leads
    /// out of the run folder, is one of the run's own (run.json, log.txt, stages), or was taken
    /// before.
    virtual std::filesystem::path output_path(const std::filesystem::path& name) = 0;

   protected:
    /// These live as long as the firing.
    virtual const AnyPacket& input(std::string_view port) const = 0;
    virtual const std::vector<AnyPacket>& inputs(std::string_view port) const = 0;
    virtual void publish(std::string_view port, AnyPacket packet) = 0;

   private:
    template <class T>
    static const AnyPacket& checked(std::string_view port, const AnyPacket& any) {
        if (!any.holds(PacketTraits<T>::name))
            throw Error("port '" + std::string(port) + "' holds " + (any ? any.type : "no packet") +
                        ", the stage asked for " + PacketTraits<T>::name);
        return any;
    }
};

}  // namespace petal
