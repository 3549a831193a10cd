// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <mrpt/config.h>
#include <mrpt/version.h>

#include <Eigen/Core>
#include <cstdint>
#include <string>

namespace petal {

/// What host and plugin must share so that C++ objects can cross between them. Compared field by
/// field before a library is opened; plain numbers, so that it can be read from the file.
struct BuildKey {
    std::uint32_t cxx_abi;          ///< __GXX_ABI_VERSION
    std::uint32_t cxx11_strings;    ///< _GLIBCXX_USE_CXX11_ABI
    std::uint32_t debug_stl;        ///< _GLIBCXX_DEBUG
    std::uint32_t sanitizers;       ///< bit 0 address, bit 1 thread
    std::uint32_t eigen_version;    ///< world * 10000 + major * 100 + minor
    std::uint32_t eigen_max_align;  ///< EIGEN_MAX_ALIGN_BYTES
    std::uint32_t mrpt_version;     ///< MRPT_VERSION
    std::uint32_t mrpt_opencv;      ///< MRPT_OPENCV_VERSION_NUM
};

namespace detail {
#ifdef _GLIBCXX_DEBUG
constexpr std::uint32_t kDebugStl = 1;
#else
constexpr std::uint32_t kDebugStl = 0;
#endif
#ifdef __SANITIZE_ADDRESS__
constexpr std::uint32_t kAddressSanitizer = 1;
#else
constexpr std::uint32_t kAddressSanitizer = 0;
#endif
#ifdef __SANITIZE_THREAD__
constexpr std::uint32_t kThreadSanitizer = 2;
#else
constexpr std::uint32_t kThreadSanitizer = 0;
#endif
}  // namespace detail

/// The key of the translation unit that asks.
constexpr BuildKey build_key() {
    return BuildKey{__GXX_ABI_VERSION,
                    _GLIBCXX_USE_CXX11_ABI,
                    detail::kDebugStl,
                    detail::kAddressSanitizer | detail::kThreadSanitizer,
                    EIGEN_WORLD_VERSION * 10000 + EIGEN_MAJOR_VERSION * 100 + EIGEN_MINOR_VERSION,
                    EIGEN_MAX_ALIGN_BYTES,
                    MRPT_VERSION,
                    MRPT_OPENCV_VERSION_NUM};
}

}  // namespace petal
