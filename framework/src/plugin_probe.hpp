// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

namespace petal {

/// What became of a library that was loaded in a process of its own.
struct ProbeResult {
    enum class Outcome { ok, refused, crashed, hung };
    Outcome outcome = Outcome::ok;
    std::string reason;              ///< empty where it loaded; "signal 6 (Aborted)"
    std::string output;              ///< the end of what the library printed
    std::vector<std::string> types;  ///< of its stages, where it loaded
};

/// "ok", "refused", "crashed", "hung".
const char* to_string(ProbeResult::Outcome outcome);

struct Probed {
    std::filesystem::path library;
    ProbeResult result;
    std::vector<std::string> clashes;  ///< types that an earlier library has too, a sentence each
};

/// Loads one library in a child process, so that one that ends or blocks its host is named and does
/// no harm. Its record is read first. Whether its packet types agree with those of other plugins
/// only load_plugins can tell. The child is killed after `limit`. Call it before threads are
/// started: the child is a fork. \throws Error when no child can be started.
ProbeResult probe(const std::filesystem::path& library,
                  std::chrono::milliseconds limit = std::chrono::seconds(10));

/// Probes every library that load_plugins would try, in its order; tells types that two of them
/// have.
std::vector<Probed> probe_all(const std::vector<std::filesystem::path>& folders,
                              std::chrono::milliseconds limit = std::chrono::seconds(10));

}  // namespace petal
