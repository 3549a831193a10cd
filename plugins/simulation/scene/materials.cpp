// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulation/scene/materials.hpp"

#include <map>
#include <vector>

#include "simulation/world/noise_texture.hpp"
#include "simulation/world/tile_texture.hpp"
#include "simulation/world/window_texture.hpp"

namespace petal::simulation {
namespace {

Look look(float red, float green, float blue, float reflectivity) {
    return {{red, green, blue}, reflectivity};
}

Look grey(float lightness, float reflectivity) {
    return look(lightness, lightness, lightness, reflectivity);
}

SharedTexture plain(const Look& of) {
    return std::make_shared<PlainTexture>(of);
}

/// Materials differ in their seeds too, so that no two have the same spots.
SharedTexture mottled(const Look& low, const Look& high, double size, std::uint64_t seed) {
    return std::make_shared<NoiseTexture>(low, high, size, 4, seed);
}

SharedTexture tiled(const Look& tile, const Look& joint, const TileTexture::Layout& layout,
                    std::uint64_t seed) {
    return std::make_shared<TileTexture>(tile, joint, layout, seed);
}

SharedTexture windows(SharedTexture wall, const Look& glass, std::uint64_t seed) {
    return std::make_shared<WindowTexture>(std::move(wall), grey(0.75F, 0.6F), glass,
                                           WindowTexture::Layout{}, seed);
}

/// Reflectivities at 905 nm are round numbers of the usual order for such a material: plants and
/// red bricks send back much more than they look like, glass and car paint much less.
std::map<std::string, SharedTexture> make_materials() {
    std::map<std::string, SharedTexture> all;
    all["white"] = plain(grey(0.8F, 0.7F));
    all["black"] = plain(grey(0.03F, 0.1F));
    all["steel"] = plain(grey(0.3F, 0.4F));
    all["dark_steel"] = plain(grey(0.06F, 0.25F));
    all["glass"] = plain(look(0.02F, 0.025F, 0.03F, 0.03F));
    all["rubber"] = plain(grey(0.02F, 0.06F));
    all["cloth"] = plain(look(0.12F, 0.17F, 0.34F, 0.35F));
    all["skin"] = plain(look(0.55F, 0.35F, 0.25F, 0.5F));
    all["wood"] = plain(look(0.5F, 0.34F, 0.2F, 0.5F));
    all["banner"] = plain(look(0.1F, 0.16F, 0.4F, 0.4F));
    all["white_wall"] = mottled(grey(0.72F, 0.66F), grey(0.8F, 0.72F), 0.4, 1);
    all["grey_wall"] = mottled(grey(0.4F, 0.42F), grey(0.48F, 0.48F), 0.4, 2);
    all["dark_wall"] = mottled(grey(0.07F, 0.18F), grey(0.11F, 0.24F), 0.4, 3);
    all["concrete"] = mottled(grey(0.28F, 0.32F), grey(0.48F, 0.46F), 0.6, 4);
    all["asphalt"] = mottled(grey(0.1F, 0.12F), grey(0.2F, 0.2F), 0.08, 5);
    all["lawn"] =
        mottled(look(0.08F, 0.15F, 0.03F, 0.35F), look(0.22F, 0.38F, 0.1F, 0.6F), 0.15, 6);
    all["leaves"] =
        mottled(look(0.07F, 0.14F, 0.03F, 0.4F), look(0.22F, 0.38F, 0.09F, 0.65F), 0.1, 7);
    all["bark"] =
        mottled(look(0.06F, 0.045F, 0.03F, 0.25F), look(0.14F, 0.1F, 0.07F, 0.35F), 0.05, 8);
    all["grey_floor"] = mottled(grey(0.2F, 0.28F), grey(0.27F, 0.35F), 0.5, 9);
    all["brick"] =
        tiled(look(0.48F, 0.2F, 0.14F, 0.5F), grey(0.5F, 0.4F), {0.25, 0.08, 0.012, 0.5, 0.25}, 10);
    all["paving"] = tiled(look(0.62F, 0.44F, 0.36F, 0.4F), grey(0.25F, 0.25F),
                          {0.3, 0.3, 0.012, 0.0, 0.12}, 11);
    all["floor_tiles"] =
        tiled(grey(0.5F, 0.45F), grey(0.15F, 0.25F), {0.4, 0.4, 0.01, 0.0, 0.06}, 12);
    all["hole_tiles"] =
        tiled(grey(0.1F, 0.15F), grey(0.7F, 0.6F), {0.112, 0.112, 0.012, 0.0, 0.3}, 13);
    all["wood_floor"] = tiled(look(0.5F, 0.34F, 0.2F, 0.45F), look(0.15F, 0.1F, 0.06F, 0.2F),
                              {1.2, 0.14, 0.003, 0.37, 0.2}, 14);
    // By day glass mirrors the sky; from within a lit room it is dark outside.
    all["brick_windows"] = windows(all["brick"], look(0.22F, 0.26F, 0.32F, 0.03F), 15);
    all["white_windows"] = windows(all["white_wall"], look(0.03F, 0.04F, 0.05F, 0.03F), 16);
    return all;
}

const std::map<std::string, SharedTexture>& materials() {
    static const std::map<std::string, SharedTexture> all = make_materials();
    return all;
}

}  // namespace

std::vector<std::string> material_names() {
    std::vector<std::string> names;
    for (const auto& [name, texture] : materials()) names.push_back(name);
    return names;
}

SharedTexture material(const std::string& name) {
    return materials().at(name);
}

}  // namespace petal::simulation
