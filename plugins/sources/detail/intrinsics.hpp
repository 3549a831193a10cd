// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <mrpt/img/TCamera.h>

#include <cstdint>
#include <filesystem>
#include <string>

namespace petal {

/// What an intrinsics file says. Where it gives no image size, camera.ncols and nrows are 0.
struct Intrinsics {
    mrpt::img::TCamera camera;

    bool has_size() const { return camera.ncols > 0 && camera.nrows > 0; }
};

/// Reads the intrinsics of one camera:
/// - YAML (.yaml, .yml) of OpenCV or ROS: the matrix as CameraMat, camera_matrix, Camera_Matrix, K
/// or
///   cameraMatrix; distortion as DistCoeff, distortion_coefficients, Distortion_Coefficients, D or
///   distCoeffs; size as ImageSize [width, height], image_width and image_height, or width and
///   height; the model as DistModel, distortion_model or camera_model;
/// - else text: the word `intrinsic` and nine numbers, the word `distortion` and its coefficients.
///
/// `model`: auto, none, plumb_bob, kannala_brandt. With auto the file's own word counts (plumb_bob,
/// radtan, rational_polynomial, ...; equidistant, fisheye, kannala_brandt); without a word it is
/// plumb bob. Plumb bob takes 4, 5 or 8 coefficients in OpenCV's order, Kannala-Brandt 4.
/// A file without coefficients is an error unless the model, given or the file's, is none.
/// \throws Error naming the file and what is wrong.
Intrinsics read_intrinsics(const std::filesystem::path& file, const std::string& model = "auto");

/// Puts the image's size where the intrinsics have none, which returns true.
/// \throws Error, naming both sizes, where they differ.
bool apply_image_size(Intrinsics& intrinsics, const std::filesystem::path& file,
                      std::uint32_t width, std::uint32_t height, const std::string& image);

}  // namespace petal
