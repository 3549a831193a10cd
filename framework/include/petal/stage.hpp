// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

namespace petal {

class Run;

/// A unit of work with typed ports and declared parameters.
///
/// A subclass has a plain struct `Params`, a constructor that takes one, and
/// `static void describe(Spec<Params>&)`, which needs no instance and no data.
///
/// When it fires:
/// - no input port: a source. run() is called again and again; each call writes one frame to every
///   output, or calls Run::end_of_data().
/// - reads() ports only: run() once for each packet of its wires (once, where they are once wires),
///   then finish() once, e.g. to close a file; finish() then has no ports.
/// - any gathers() port: finish() alone, once, after the last frame. Then Run::all() has every
/// packet of
///   the gathering ports, and its reads() ports (which must be once wires) are there too.
///
/// Thread contract: one instance is used by one thread at a time, not always the same one; inputs
/// are const and shared with other stages, outputs are moved away; no globals, no thread-locals.
///
/// A stage that finds nothing writes an empty packet and a note. It throws petal::Error when its
/// input is invalid.
class Stage {
   public:
    Stage() = default;
    Stage(const Stage&) = delete;
    Stage& operator=(const Stage&) = delete;
    virtual ~Stage() = default;

    virtual void run(Run& run) { static_cast<void>(run); }
    virtual void finish(Run& run) { static_cast<void>(run); }
};

}  // namespace petal
