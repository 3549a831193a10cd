// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "petal/packet.hpp"
#include "petal/spec.hpp"

namespace petal::testing {

/// Inputs that a stage must survive, by packet type. The same name in several types goes together:
/// "empty" gives every port its empty packet. A type that lacks a name gets its "empty".
struct ContractInputs {
    using Maker = std::function<AnyPacket()>;
    std::map<std::string, std::map<std::string, Maker>> packets;  ///< type, then name

    template <class T>
    void add(const std::string& name, std::function<T()> make) {
        packets[PacketTraits<T>::name][name] = [make] {
            return make_packet<T>(make(), FrameInfo{});
        };
    }
};

/// A rule of the contract that a stage breaks.
struct Violation {
    std::string rule;  ///< "empty input", "range edge", ...
    std::string what;
};

/// Checks everything that all stages promise and that needs no data of their own:
/// - complete declaration;
/// - defaults are legal, one by one and together;
/// - values at the edges of each range are taken, values outside, of a wrong kind, and unknown
/// names are
///   refused by petal::Error;
/// - with each of the inputs the stage writes every output, or throws petal::Error with a message;
/// a stage
///   that writes does so twice alike as far as the kind and size of packets show;
/// - a cancelled run ends by petal::Cancelled or in the ordinary way, never by another error than
/// with the
///   same input uncancelled.
std::vector<Violation> contract_violations(const StageSpec& spec, const ContractInputs& inputs);

}  // namespace petal::testing
