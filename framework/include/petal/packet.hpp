// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

namespace petal {

/// Which frame (an observation, or a scene) a packet belongs to. Branches meet again by `number`.
struct FrameInfo {
    std::uint64_t number = 0;  ///< counts from 0 in the order in which the source emits
    std::string name;          ///< what the user calls it, e.g. the file's stem; may be empty
    double stamp = 0.0;        ///< s since the Unix epoch (UTC); 0 where unknown
};

/// What the framework must know of a packet type. A library of packet types specialises it:
///
///     template <> struct PacketTraits<Cloud> {
///         static constexpr const char* name = "Cloud";      // unique; this is the type's identity
///         static void seal(Cloud& value);                   // warm every lazy cache
///         static std::size_t bytes(const Cloud& value);     // memory held, for run.json
///     };
///
/// `seal` runs once, before the value becomes shared: after it, const access from several threads
/// must be free of writes. (MRPT's const is not: CPose3D caches its angles, CPointsMap its bounding
/// box.) The name, not the C++ type_info, identifies a type: it survives RTLD_LOCAL and hidden
/// visibility.
template <class T>
struct PacketTraits;

/// A value of any type on a wire: immutable, shared, with its frame. Copying it copies pointers.
struct AnyPacket {
    std::shared_ptr<const void> value;
    const char* type = "";
    std::size_t bytes = 0;
    std::shared_ptr<const FrameInfo> frame;  ///< one for all packets of a frame; null before
                                             ///< the framework has published the packet

    explicit operator bool() const { return value != nullptr; }
    bool holds(std::string_view type_name) const { return value && type_name == type; }
};

/// A typed packet.
template <class T>
struct Packet {
    std::shared_ptr<const T> value;
    FrameInfo frame;

    const T& operator*() const { return *value; }
    const T* operator->() const { return value.get(); }
};

/// Seals `value` and makes a packet of it, of no frame yet. The value is moved, never copied.
template <class T>
AnyPacket make_packet(T value) {
    auto owned = std::make_shared<T>(std::move(value));
    PacketTraits<T>::seal(*owned);
    const std::size_t bytes = PacketTraits<T>::bytes(*owned);
    return AnyPacket{std::shared_ptr<const void>(std::move(owned)), PacketTraits<T>::name, bytes,
                     nullptr};
}
/// The same, as a packet of that frame.
template <class T>
AnyPacket make_packet(T value, FrameInfo frame) {
    AnyPacket packet = make_packet(std::move(value));
    packet.frame = std::make_shared<const FrameInfo>(std::move(frame));
    return packet;
}

}  // namespace petal
