// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "petal/html/page.hpp"
#include "petal/html/traced.hpp"
#include "sinks/detail/report_pictures.hpp"

namespace petal {

/// The parts of a calibration's report. Each is made from result.json alone (`result` holds it), so
/// that no number of the page can say something else; the pictures are the exception.
std::string report_header(const html::Traced& result);
html::Page::Section verdict_section(const html::Traced& result);
html::Page::Section pose_section(const html::Traced& result);
html::Page::Section trust_section(const html::Traced& result);
html::Page::Section residual_section(const html::Traced& result);
html::Page::Section scene_section(const html::Traced& result);
html::Page::Section metric_section(const html::Traced& result);
html::Page::Section photo_section(const html::Traced& result,
                                  const std::vector<ReportPicture>& pictures,
                                  double residual_scale);
/// `view`: what report_view() gave.
html::Page::Section view_section(const nlohmann::ordered_json& view);

}  // namespace petal
