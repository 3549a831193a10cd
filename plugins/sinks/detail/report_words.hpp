// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <string>

namespace petal {

/// Words of the report for the keys of result.json; HTML without markup.
std::string verdict_word(const std::string& level);      ///< "usable": "Usable"
std::string verdict_style(const std::string& level);     ///< class of the badge
std::string verdict_sentence(const std::string& level);  ///< what it means
std::string order_sentence(const std::string& decided_by);

}  // namespace petal
