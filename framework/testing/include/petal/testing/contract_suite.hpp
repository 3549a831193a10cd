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

/// Packets to try stages with, by packet type and name. The same name in several types goes
/// together: "empty" gives every port its empty packet. A type that lacks a name gives its
/// "typical", else its "empty". Names are free; "empty" and "typical" are used for the edges of
/// parameters too, and every type needs an "empty".
struct ContractInputs {
    using Maker = std::function<AnyPacket()>;
    using Content = std::function<std::string(const AnyPacket&)>;
    std::map<std::string, std::map<std::string, Maker>> packets;  ///< type, then name
    std::map<std::string, Content> contents;                      ///< by type
    /// By stage type: parameters to fire it with, where its defaults mean work for minutes.
    std::map<std::string, std::map<std::string, Value>> params;

    template <class T>
    void add(const std::string& name, std::function<T()> make) {
        packets[PacketTraits<T>::name][name] = [make] {
            return make_packet<T>(make(), FrameInfo{});
        };
    }
    /// Everything that a value holds, as bytes: two values are alike where these are. Needed to see
    /// whether a stage changes its inputs, and whether two firings give the same.
    template <class T>
    void add_content(std::function<std::string(const T&)> bytes) {
        contents[PacketTraits<T>::name] = [bytes](const AnyPacket& packet) {
            return bytes(*static_cast<const T*>(packet.value.get()));
        };
    }
};

/// A rule of the contract that a stage breaks.
struct Violation {
    std::string rule;  ///< "inputs unchanged", "range edge", ...
    std::string what;
};

/// Checks what all stages promise, without data of their own. The rules:
/// - "complete declaration"; "legal defaults", one by one and together;
/// - "unknown names", "wrong kind", "range" and "choices": refused by petal::Error where they must
///   be; "range edge": inclusive;
/// - "edges": at each edge of a number's range and with each choice (where the relations between
///   the parameters allow it) the stage can be made, and fired with "typical" and "empty";
/// - with each of the inputs, twice in a row as two frames, the stage writes every output, or
///   throws petal::Error with a message ("errors");
/// - "inputs unchanged";
/// - "same seed, same output": outputs, notes, verdicts and files of two instances are alike by
///   content; "threads": also with four threads to use, and where each call comes from another
///   thread;
/// - "cancel": cancelled before the call, the stage throws petal::Cancelled or ends in the ordinary
///   way, soon, and leaves no file that differs from that of the whole run.
/// A type without a content function is compared by size alone, which "contents" tells.
std::vector<Violation> contract_violations(const StageSpec& spec, const ContractInputs& inputs);

}  // namespace petal::testing
