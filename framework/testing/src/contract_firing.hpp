// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "petal/testing/contract_suite.hpp"
#include "petal/value.hpp"

namespace petal::testing {

/// What a firing is given: for each port its packet.
using GivenPackets = std::vector<std::pair<std::string, AnyPacket>>;

/// How to fire.
struct FiringWay {
    std::map<std::string, Value> params;  ///< the others have their defaults
    int threads = 1;
    bool change_threads = false;
    bool cancelled = false;
    double cancel_after_s = 0.0;  ///< 0: not
};

/// How it ended, and everything that it told and wrote.
struct FiringOutcome {
    enum class End { wrote, refused, cancelled, broke };
    End end = End::wrote;
    std::string message;
    std::string told;                          ///< outputs, notes and verdict, by content
    std::map<std::string, std::string> files;  ///< content by name
    double seconds = 0.0;

    bool operator==(const FiringOutcome& other) const {
        return end == other.end && message == other.message && told == other.told &&
               files == other.files;
    }
};

/// Fires a fresh instance with the packets, as two frames; catches what it throws.
FiringOutcome fire_once(const StageSpec& spec, const ContractInputs& inputs,
                        const GivenPackets& given, const FiringWay& way);

/// The content of a packet; its size where no function is known for its type.
std::string content_of(const ContractInputs& inputs, const AnyPacket& packet);

}  // namespace petal::testing
