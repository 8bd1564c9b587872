#include "medium/materials.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace turbid {
namespace {

constexpr std::string_view kWang = "Wang 2020 (S1), Table 1";
constexpr std::string_view kJensen = "Jensen 2001, Fig. 5";
constexpr std::string_view kNarasimhan = "Narasimhan 2006";

/// S1 prints albedo, mean free path and g. Its lengths carry no unit; read in millimetres its skin and marble are
/// Jensen's Skin1 and Marble, so millimetres they are. (Its milk is then Narasimhan's regular milk diluted as it was
/// measured, with 1/mm for 0.01/mm.)
constexpr Material from_wang(std::string_view name, const Spectrum& albedo, const Spectrum& mean_free_path, float g,
                             bool reduced, std::optional<float> eta) {
  const Spectrum sigma_s = albedo / mean_free_path;
  const Spectrum sigma_a = (Spectrum(1.0f) - albedo) / mean_free_path;
  return {name, sigma_s, sigma_a, Spectrum(g), reduced, eta, kWang};
}

/// Jensen's coefficients are reduced; the index of all but marble is 1.3.
constexpr Material from_jensen(std::string_view name, const Spectrum& reduced_sigma_s, const Spectrum& sigma_a,
                               float eta = 1.3f) {
  return {name, reduced_sigma_s, sigma_a, Spectrum(), true, eta, kJensen};
}

/// Narasimhan's coefficients at the natural concentration (measured ones times 23 l over the volume that was diluted in
/// as much water), not reduced, with g per channel. pbrt ships sigma_s (1 - g) of these, Mitsuba 0.6 sigma_s and g; the
/// two agree to the digits they print. Where nothing scatters g is 0.
constexpr Material from_narasimhan(std::string_view name, const Spectrum& sigma_s, const Spectrum& sigma_a,
                                   const Spectrum& g) {
  return {name, sigma_s, sigma_a, g, false, std::nullopt, kNarasimhan};
}

// clang-format off
const std::array kMaterials{
    from_wang("S1 Bumpy Sphere", {0.955f, 0.677f, 0.457f}, {4.55f, 3.23f, 2.17f}, 0.9f, false, 1.5f),
    from_wang("S1 Wax", {0.980f, 0.962f, 0.750f}, {0.65f, 0.63f, 0.59f}, 0.8f, false, 1.446f),
    from_wang("S1 Milk", {0.999f, 0.999f, 0.999f}, {0.84f, 0.75f, 0.68f}, 0.7f, false, std::nullopt),
    from_wang("S1 Skin", {0.958f, 0.838f, 0.678f}, {1.29f, 0.95f, 0.67f}, 0, true, std::nullopt),
    from_wang("S1 Marble", {0.999f, 0.998f, 0.997f}, {0.46f, 0.38f, 0.33f}, 0, true, std::nullopt),

    from_jensen("Apple", {2.29f, 2.39f, 1.97f}, {0.0030f, 0.0034f, 0.046f}),
    from_jensen("Chicken1", {0.15f, 0.21f, 0.38f}, {0.015f, 0.077f, 0.19f}),
    from_jensen("Chicken2", {0.19f, 0.25f, 0.32f}, {0.018f, 0.088f, 0.20f}),
    from_jensen("Cream", {7.38f, 5.47f, 3.15f}, {0.0002f, 0.0028f, 0.0163f}),
    from_jensen("Ketchup", {0.18f, 0.07f, 0.03f}, {0.061f, 0.97f, 1.45f}),
    from_jensen("Marble", {2.19f, 2.62f, 3.00f}, {0.0021f, 0.0041f, 0.0071f}, 1.5f),
    from_jensen("Potato", {0.68f, 0.70f, 0.55f}, {0.0024f, 0.0090f, 0.12f}),
    from_jensen("Skimmilk", {0.70f, 1.22f, 1.90f}, {0.0014f, 0.0025f, 0.0142f}),
    from_jensen("Skin1", {0.74f, 0.88f, 1.01f}, {0.032f, 0.17f, 0.48f}),
    from_jensen("Skin2", {1.09f, 1.59f, 1.79f}, {0.013f, 0.070f, 0.145f}),
    from_jensen("Spectralon", {11.6f, 20.4f, 14.9f}, {0, 0, 0}),
    from_jensen("Wholemilk", {2.55f, 3.21f, 3.77f}, {0.0011f, 0.0024f, 0.014f}),

    from_narasimhan("Lowfat Milk", {13.116f, 15.445f, 17.957f}, {0.002875f, 0.00575f, 0.0115f}, {0.932f, 0.902f, 0.859f}),
    from_narasimhan("Reduced Milk", {13.734f, 15.6f, 17.801f}, {0.0025556f, 0.0051111f, 0.012778f}, {0.819f, 0.797f, 0.746f}),
    from_narasimhan("Regular Milk", {18.205f, 20.383f, 22.37f}, {0.0015333f, 0.0046f, 0.019933f}, {0.75f, 0.714f, 0.681f}),
    from_narasimhan("Espresso", {7.7826f, 8.1305f, 8.5392f}, {4.7984f, 6.5751f, 8.8493f}, {0.907f, 0.896f, 0.88f}),
    from_narasimhan("Mint Mocha Coffee", {3.5113f, 4.1439f, 5.5966f}, {3.772f, 5.8228f, 7.82f}, {0.91f, 0.907f, 0.914f}),
    from_narasimhan("Lowfat Soy Milk", {2.0384f, 2.3288f, 3.9028f}, {0.0014375f, 0.0071875f, 0.035937f}, {0.85f, 0.853f, 0.842f}),
    from_narasimhan("Regular Soy Milk", {4.6632f, 5.2018f, 8.7458f}, {0.0019167f, 0.0095833f, 0.065167f}, {0.873f, 0.858f, 0.832f}),
    from_narasimhan("Lowfat Chocolate Milk", {9.8371f, 11.495f, 13.163f}, {0.0115f, 0.0368f, 0.1564f}, {0.934f, 0.927f, 0.916f}),
    from_narasimhan("Regular Chocolate Milk", {10.569f, 13.141f, 15.22f}, {0.010063f, 0.043125f, 0.14375f}, {0.862f, 0.838f, 0.806f}),
    from_narasimhan("Coke", {0.0025444f, 0.00299f, 0}, {0.10014f, 0.16503f, 0.2468f}, {0.965f, 0.972f, 0}),
    from_narasimhan("Pepsi", {0.00083374f, 0.0020269f, 0}, {0.091641f, 0.14158f, 0.20729f}, {0.926f, 0.979f, 0}),
    from_narasimhan("Sprite", {0.0001058f, 0.00013647f, 0.00013647f}, {0.001886f, 0.0018308f, 0.0020025f}, {0.943f, 0.953f, 0.952f}),
    from_narasimhan("Gatorade", {0.036678f, 0.044881f, 0.057423f}, {0.024794f, 0.019289f, 0.008878f}, {0.933f, 0.933f, 0.935f}),
    from_narasimhan("Chardonnay", {0.00020909f, 0.00032757f, 0.00048092f}, {0.010782f, 0.011855f, 0.023997f}, {0.914f, 0.958f, 0.975f}),
    from_narasimhan("White Zinfandel", {0.00021606f, 0.00033454f, 0.00046f}, {0.012072f, 0.016184f, 0.019843f}, {0.919f, 0.943f, 0.972f}),
    from_narasimhan("Merlot", {0.00081265f, 0, 0}, {0.11632f, 0.25191f, 0.29434f}, {0.974f, 0, 0}),
    from_narasimhan("Budweiser Beer", {0.00029345f, 0.00054725f, 0.00058689f}, {0.011492f, 0.024911f, 0.057786f}, {0.917f, 0.956f, 0.982f}),
    from_narasimhan("Coors Light Beer", {0.000621f, 0.001265f, 0}, {0.006164f, 0.013984f, 0.034983f}, {0.918f, 0.966f, 0}),
    from_narasimhan("Clorox", {0.027313f, 0.033024f, 0.036954f}, {0.0033542f, 0.014892f, 0.026297f}, {0.912f, 0.905f, 0.892f}),
    from_narasimhan("Apple Juice", {0.0025683f, 0.0031051f, 0.0041273f}, {0.012957f, 0.023741f, 0.052184f}, {0.947f, 0.949f, 0.945f}),
    from_narasimhan("Cranberry Juice", {0.0019626f, 0.0023767f, 0.0030053f}, {0.039437f, 0.094223f, 0.12426f}, {0.947f, 0.951f, 0.974f}),
    from_narasimhan("Grape Juice", {0.00138f, 0, 0}, {0.10404f, 0.23958f, 0.29325f}, {0.961f, 0, 0}),
    from_narasimhan("Ruby Grapefruit Juice", {0.15496f, 0.1539f, 0.15994f}, {0.085867f, 0.18314f, 0.25262f}, {0.929f, 0.929f, 0.931f}),
    from_narasimhan("White Grapefruit Juice", {0.505f, 0.52743f, 0.75283f}, {0.0138f, 0.018831f, 0.056781f}, {0.548f, 0.545f, 0.565f}),
    from_narasimhan("Shampoo", {0.0079733f, 0.00874f, 0.01127f}, {0.014107f, 0.045693f, 0.061717f}, {0.91f, 0.905f, 0.92f}),
    from_narasimhan("Strawberry Shampoo", {0.0021467f, 0.0024534f, 0.00253f}, {0.01449f, 0.05796f, 0.075823f}, {0.927f, 0.935f, 0.994f}),
    from_narasimhan("Head & Shoulders Shampoo", {0.26747f, 0.27696f, 0.29574f}, {0.084621f, 0.15688f, 0.20365f}, {0.911f, 0.896f, 0.884f}),
    from_narasimhan("Lemon Tea Powder", {0.74489f, 0.83822f, 1.0016f}, {2.4288f, 4.5757f, 7.2127f}, {0.946f, 0.946f, 0.949f}),
    from_narasimhan("Orange Juice Powder", {0.001928f, 0.002132f, 0.002259f}, {0.001449f, 0.003441f, 0.007863f}, {0.919f, 0.918f, 0.922f}),
    from_narasimhan("Pink Lemonade Powder", {0.001235f, 0.001334f, 0.001305f}, {0.001165f, 0.002366f, 0.003195f}, {0.902f, 0.902f, 0.904f}),
    from_narasimhan("Cappuccino Powder", {12.209f, 16.466f, 29.273f}, {35.844f, 49.547f, 61.084f}, {0.849f, 0.843f, 0.926f}),
    from_narasimhan("Salt Powder", {0.13805f, 0.15677f, 0.17865f}, {0.28415f, 0.3257f, 0.34148f}, {0.802f, 0.793f, 0.821f}),
    from_narasimhan("Sugar Powder", {0.0028192f, 0.0031498f, 0.0039275f}, {0.012638f, 0.031051f, 0.050124f}, {0.921f, 0.919f, 0.931f}),
    from_narasimhan("Suisse Mocha Powder", {30.085f, 33.445f, 38.719f}, {17.502f, 27.004f, 35.433f}, {0.907f, 0.894f, 0.888f}),
    from_narasimhan("Pacific Ocean Surface Water", {0.0018f, 0.001834f, 0.002281f}, {0.031845f, 0.031324f, 0.030147f}, {0.902f, 0.825f, 0.914f}),
};
// clang-format on

bool same_name(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
  return std::ranges::equal(a, b, {}, lower, lower);
}

}  // namespace

std::span<const Material> materials() { return kMaterials; }

const Material* find_material(std::string_view name) {
  const auto found = std::ranges::find_if(kMaterials, [&](const Material& m) { return same_name(m.name, name); });
  return found == kMaterials.end() ? nullptr : &*found;
}

}  // namespace turbid
