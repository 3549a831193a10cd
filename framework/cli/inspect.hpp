// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "petal/rawlog/inventory.hpp"

namespace petal::cli {

/// What reading one rawlog showed, up to its end or to where it broke.
struct Inspection {
    std::filesystem::path file;
    bool opened = false;
    bool compressed = false;
    std::uint64_t file_bytes = 0;  ///< on the disk
    std::uint64_t bytes = 0;       ///< read, uncompressed
    std::size_t objects = 0;       ///< read whole
    RawlogInventory inventory;
    std::vector<std::string> errors;    ///< the rawlog, or what belongs to it, is not whole
    std::vector<std::string> warnings;  ///< it is whole, and something in it is odd
};

/// Notes what in the inventory is an error or odd.
void judge(Inspection& inspection);

/// "2018-02-26T09:24:21.085268Z", of 100 ns ticks cut to microseconds.
std::string iso_time(mrpt::Clock::time_point stamp);

/// "none", "plumb_bob" or "kannala_brandt", and the coefficients that the model has.
std::string distortion_name(const mrpt::img::TCamera& camera);
std::vector<double> coefficients(const mrpt::img::TCamera& camera);

/// For people. Lines are broken at `width` columns; 0: never.
std::string inspection_text(const Inspection& inspection, int width);

/// For programs: a stable JSON document of all rawlogs.
std::string inspection_json(const std::vector<Inspection>& inspections);

}  // namespace petal::cli
