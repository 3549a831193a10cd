// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sources/files.hpp"

#include <opencv2/imgcodecs.hpp>
#include <utility>

#include "petal/calibration/cloud.hpp"
#include "petal/calibration/images.hpp"
#include "petal/calibration/truth.hpp"
#include "petal/calibration/truth_json.hpp"
#include "petal/rawlog/input_file.hpp"
#include "sources/detail/cloud_file.hpp"
#include "sources/detail/intrinsics.hpp"
#include "sources/detail/scene_name.hpp"

namespace petal {
namespace {

namespace fs = std::filesystem;

/// The pixels as they were taken: 8 bit, grey or colour, not turned as an EXIF tag asks.
mrpt::img::CImage read_image(const fs::path& file) {
    require_file(file, "image");
    cv::Mat pixels;
    try {
        pixels = cv::imread(file.string(), cv::IMREAD_ANYCOLOR | cv::IMREAD_IGNORE_ORIENTATION);
    } catch (const cv::Exception& e) {
        throw Error("image " + file.string() + " cannot be read: " + e.what());
    }
    if (pixels.empty())
        throw Error("image " + file.string() +
                    " cannot be decoded; it is damaged or no image that OpenCV reads (jpg, png, "
                    "bmp, tiff, ...)");
    return mrpt::img::CImage(pixels, mrpt::img::SHALLOW_COPY);
}

}  // namespace

void FilesSource::describe(Spec<Params>& spec) {
    spec.summary("Makes one scene of plain files: an image with its intrinsics, and a cloud.");
    spec.doc(R"(Each of the two may be left out (an empty path), not both; its packet is then
empty.

**Image**: whatever OpenCV reads, as 8 bit grey or colour. The pixels are those of the file: an
EXIF orientation is not applied, because the intrinsics belong to the sensor's own rows and
columns.

**Intrinsics**: YAML of OpenCV or ROS (`CameraMat`, `camera_matrix`, `K`, ...; `DistCoeff`,
`distortion_coefficients`, `D`, ...; `ImageSize` or `image_width` and `image_height`), or text
with the word `intrinsic` and nine numbers, then the word `distortion` and its coefficients. Plumb
bob takes 4, 5 or 8 coefficients, Kannala-Brandt (fisheye, equidistant) 4; more than 8 are
refused, because MRPT's camera holds no more, and so is a file without coefficients unless the
model is none. Where the file gives no image size, the image's is
taken, and the log says so; where it gives another size, the run ends.

**Cloud**: by its ending `.pcd` (ascii, binary, binary_compressed) or `.ply` (ascii, binary), else
text with `x y z` and perhaps intensity, separated by commas, semicolons, blanks or tabs, with `#`
comments and perhaps a header line. Metres, in the LiDAR's own frame. Points that are not finite
are kept and counted. An empty cloud is valid; a note says so. Details in `docs/data_formats.md`.

**Truth**: that of a `truth.json` (and `labels.u8`) in the folder of the image, or of the cloud
where there is no image; else empty.

The scene is named after that folder. Files carry no time: the stamps are 0.)");
    spec.writes<Cloud>("cloud", "the cloud file's points, in their order");
    spec.writes<Images>("images", "the image, or none");
    spec.writes<Truth>("truth", "what is known of a simulated scene; empty for real data");
    spec.param("image", &Params::image).doc("image file; empty: the scene has no image");
    spec.param("intrinsics", &Params::intrinsics).doc("intrinsics of the image");
    spec.param("cloud", &Params::cloud).doc("cloud file; empty: the scene has no points");
    spec.param("distortion_model", &Params::distortion_model)
        .choices({"auto", "none", "plumb_bob", "kannala_brandt"})
        .doc("what the coefficients mean; auto: as the file says, plumb bob where it does not");
    spec.param("camera", &Params::camera).doc("the camera's label");
    spec.param("lidar", &Params::lidar).doc("the LiDAR's label");
    spec.check([](const Params& p) {
        if (p.image.empty() && p.cloud.empty())
            return "image and cloud are both empty; a scene needs one of them";
        return "";
    });
    spec.check([](const Params& p) {
        if (p.image.empty() != p.intrinsics.empty())
            return "image and intrinsics belong together; give both or none";
        return "";
    });
    spec.check([](const Params& p) {
        return p.camera.empty() || p.lidar.empty() ? "camera and lidar are labels: not empty" : "";
    });
}

void FilesSource::write_cloud(Run& run, std::size_t& points) const {
    Cloud cloud;
    cloud.sensor_label = params_.lidar;
    if (!params_.cloud.empty()) {
        CloudFile file = read_cloud_file(params_.cloud);
        run.used_file(params_.cloud);
        points = file.points->size();
        run.log(LogLevel::info, params_.cloud.string() + ": " + std::to_string(points) + " points" +
                                    (file.has_intensity ? " with intensity" : ""));
        if (!file.remark.empty())
            run.log(LogLevel::warning, params_.cloud.string() + ": " + file.remark);
        if (file.not_finite > 0)
            run.log(LogLevel::warning, params_.cloud.string() + ": " +
                                           std::to_string(file.not_finite) +
                                           " points are not finite; they are kept");
        if (points == 0)
            run.note({"points in " + params_.cloud.string(), "the file holds none", "",
                      "check how the cloud was exported"});
        cloud.points = std::move(file.points);
        cloud.parts.push_back({});
    }
    run.write("cloud", std::move(cloud));
}

void FilesSource::write_images(Run& run) const {
    Images images;
    if (!params_.image.empty()) {
        CameraImage camera;
        camera.label = params_.camera;
        camera.image = read_image(params_.image);
        Intrinsics intrinsics = read_intrinsics(params_.intrinsics, params_.distortion_model);
        run.used_file(params_.image);
        run.used_file(params_.intrinsics);
        const auto width = static_cast<std::uint32_t>(camera.image.getWidth());
        const auto height = static_cast<std::uint32_t>(camera.image.getHeight());
        if (apply_image_size(intrinsics, params_.intrinsics, width, height,
                             "image " + params_.image.string()))
            run.log(LogLevel::warning, params_.intrinsics.string() +
                                           " gives no image size; that of the image is taken, " +
                                           std::to_string(width) + " x " + std::to_string(height));
        camera.camera = intrinsics.camera;
        camera.camera.cameraName = params_.camera;
        images.cameras.push_back(std::move(camera));
    }
    run.write("images", std::move(images));
}

void FilesSource::run(Run& run) {
    if (std::exchange(done_, true)) return run.end_of_data();
    const fs::path& first = params_.image.empty() ? params_.cloud : params_.image;
    run.set_frame(scene_name(first), 0.0);
    std::size_t points = 0;
    write_cloud(run, points);
    write_images(run);
    const fs::path folder = fs::absolute(first).parent_path();
    Truth truth = read_truth(folder, params_.cloud.empty() ? std::optional<std::size_t>()
                                                           : std::optional<std::size_t>(points));
    for (const char* name : {"truth.json", "labels.u8"})
        if (fs::exists(folder / "truth.json") && fs::exists(folder / name))
            run.used_file(folder / name);
    run.write("truth", std::move(truth));
    run.progress(1, 1, "scenes");
}

}  // namespace petal
