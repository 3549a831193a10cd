// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "loader.hpp"
#include "nearest.hpp"

namespace petal {
namespace {

std::string plain(std::uint32_t value) {
    return std::to_string(value);
}

std::string bytes(std::uint32_t value) {
    return std::to_string(value) + " bytes";
}

std::string on_off(std::uint32_t value) {
    return value != 0 ? "on" : "off";
}

std::string string_abi(std::uint32_t value) {
    return value != 0 ? "new (_GLIBCXX_USE_CXX11_ABI=1)" : "old (_GLIBCXX_USE_CXX11_ABI=0)";
}

std::string sanitizers(std::uint32_t bits) {
    std::vector<std::string> names;
    if ((bits & 1U) != 0) names.emplace_back("address");
    if ((bits & 2U) != 0) names.emplace_back("thread");
    if ((bits & ~3U) != 0) names.emplace_back("unknown");
    return names.empty() ? "none" : join(names, "+");
}

std::string eigen_version(std::uint32_t value) {
    return plain(value / 10000) + "." + plain(value / 100 % 100) + "." + plain(value % 100);
}

/// MRPT writes its versions, and OpenCV's, as one hexadecimal digit a part: 0x258 is 2.5.8.
std::string hex_version(std::uint32_t value) {
    return plain(value >> 8U) + "." + plain(value >> 4U & 15U) + "." + plain(value & 15U);
}

struct Field {
    const char* name;
    std::uint32_t BuildKey::*member;
    std::string (*in_words)(std::uint32_t);
};

constexpr Field kFields[] = {
    {"sanitizers", &BuildKey::sanitizers, sanitizers},
    {"C++ ABI version (__GXX_ABI_VERSION)", &BuildKey::cxx_abi, plain},
    {"std::string ABI", &BuildKey::cxx11_strings, string_abi},
    {"debug mode of the standard library (_GLIBCXX_DEBUG)", &BuildKey::debug_stl, on_off},
    {"Eigen version", &BuildKey::eigen_version, eigen_version},
    {"Eigen alignment", &BuildKey::eigen_max_align, bytes},
    {"MRPT version", &BuildKey::mrpt_version, hex_version},
    {"MRPT's OpenCV version", &BuildKey::mrpt_opencv, hex_version},
};
static_assert(sizeof(kFields) / sizeof(Field) == sizeof(BuildKey) / sizeof(std::uint32_t),
              "every field of the build key is compared");

std::string differs(const std::string& field, const std::string& plugin, const std::string& host) {
    return field + ": plugin " + plugin + ", petal " + host;
}

}  // namespace

std::string mismatch(const PluginRecord& record, const BuildKey& host) {
    // Under another framework ABI the fields behind it may mean something else.
    if (record.framework_abi != kFrameworkAbi)
        return differs("framework ABI", plain(record.framework_abi), plain(kFrameworkAbi));
    std::vector<std::string> found;
    for (const Field& field : kFields) {
        const std::uint32_t plugin = record.build.*field.member;
        const std::uint32_t petal = host.*field.member;
        if (plugin != petal)
            found.push_back(differs(field.name, field.in_words(plugin), field.in_words(petal)));
    }
    return join(found, "; ");
}

}  // namespace petal
