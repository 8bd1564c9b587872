#include "table/photon_lobes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "core/frame.h"
#include "core/parallel.h"
#include "core/rng.h"
#include "table/sagittal_view.h"
#include "table/scattering_table.h"

namespace turbid {
namespace {

const Vec3 kAxis(0, 0, 1);

/// One collision of a photon.
struct Collision {
  Vec3 position, direction;  ///< of the flight that ended there
  Spectrum flux;             ///< that leaves it, per photon
  int order;
};

/// Photons that collide at the origin, having travelled along +z.
class Photons {
 public:
  Photons(const PhaseFunction& phase, const Spectrum& albedo, const QuadtreeSettings& settings)
      : phase_(phase), albedo_(albedo), largest_(albedo.max()), settings_(settings) {}

  /// Calls visit(collision, rng) for all that count.
  template <class Visit>
  void follow(uint64_t photon, const Visit& visit) const {
    Rng rng(hash_counters(settings_.seed, photon));
    Collision at{Vec3(0), kAxis, albedo_, 1};
    while (true) {
      if (at.order >= settings_.from_order) {
        visit(at, rng);
        // The first collisions are sure.
        if (!(rng.next_float() < largest_)) return;
        at.flux /= largest_;
      }
      at.direction =
          normalize(direction_about(at.direction, phase_.sample(rng.next_float()), 2 * kPi * rng.next_float()));
      at.position += at.direction * -std::log(1 - rng.next_float());
      at.flux *= albedo_;
      ++at.order;
    }
  }

 private:
  const PhaseFunction& phase_;
  Spectrum albedo_;
  float largest_;
  QuadtreeSettings settings_;
};

/// Where the collision lies when its photon began somewhere on the source: by its own share of the flux there.
Vec3 seen_from(const Collision& collision, SourceKind kind, Rng& rng) {
  if (kind == SourceKind::kCollision) return collision.position;
  return collision.position - kAxis * std::log1p(rng.next_float() * std::expm1(-kUnitSegment));
}

Quadtree::Place place_of(const Vec3& x) { return {std::hypot(x.x, x.y), x.z}; }

Quadtree pilot(const Photons& photons, SourceKind kind, float reach, const Quadtree::Limits& limits) {
  constexpr size_t kCollisions = 300'000;
  constexpr uint64_t kMost = 200'000, kFirst = uint64_t{1} << 40;
  std::vector<Quadtree::Place> places;
  for (uint64_t p = 0; p < kMost && places.size() < kCollisions; ++p)
    photons.follow(kFirst + p, [&](const Collision& collision, Rng& rng) {
      places.push_back(place_of(seen_from(collision, kind, rng)));
    });
  return {reach, places, limits};
}

/// f by the sine of half the angle, in steps.
class PhaseSteps {
 public:
  explicit PhaseSteps(const PhaseFunction& phase) {
    for (size_t i = 0; i < kSteps; ++i)
      values_[i] = phase.eval_angle(2 * std::asin((static_cast<float>(i) + 0.5f) / kSteps));
  }
  void towards_all(const LobeDirections& directions, const Vec3& from, float* values) const {
    // In two loops, which the compiler makes fast: steps first, then look-ups.
    alignas(64) std::array<int32_t, LobeDirections::kCount> steps;
    const Vec3 d = from;
    for (size_t k = 0; k < LobeDirections::kCount; ++k) {
      const float mu = directions.x[k] * d.x + directions.y[k] * d.y + directions.z[k] * d.z;
      const float half_sine = std::sqrt(std::max(0.5f - 0.5f * mu, 0.0f));
      steps[k] = static_cast<int32_t>(std::min(half_sine * kSteps, kSteps - 1.0f));
    }
    const float* const table = values_.data();
    for (size_t k = 0; k < LobeDirections::kCount; ++k) values[k] = table[steps[k]];
  }

 private:
  static constexpr size_t kSteps = 2048;
  std::array<float, kSteps> values_;
};

/// What a collision leaves in a cell.
struct Deposit {
  int leaf;
  Vec3 direction;  ///< of the light that arrives, in the frame of SagittalView, on either side of its plane
  Spectrum flux;
};
/// Cells are shared out among these.
constexpr size_t kBlocks = 16;
using Deposits = std::array<std::array<std::vector<Deposit>, kBlocks>, kSourceKinds>;

/// A collision of a high order is put in with this probability.
float chance(int order) { return std::min(1.0f, 8.0f / static_cast<float>(order)); }

void collect(const Photons& photons, const std::array<PhotonLobes, kSourceKinds>& lobes, uint64_t first, uint64_t last,
             Deposits& deposits) {
  for (auto& of_kind : deposits)
    for (auto& block : of_kind) block.clear();
  for (uint64_t photon = first; photon < last; ++photon)
    photons.follow(photon, [&](const Collision& collision, Rng& rng) {
      const float probability = chance(collision.order);
      if (probability < 1 && !(rng.next_float() < probability)) return;
      for (size_t k = 0; k < kSourceKinds; ++k) {
        const Vec3 x = seen_from(collision, static_cast<SourceKind>(k), rng);
        const Quadtree& tree = lobes[k].tree;
        if (!tree.holds(place_of(x))) continue;
        SagittalView view(x, kAxis, collision.direction);
        // The light is even about the sagittal plane.
        if (rng.next_float() < 0.5f) view.direction.y = -view.direction.y;
        const int leaf = tree.find(place_of(x)).number;
        deposits[k][static_cast<size_t>(leaf) % kBlocks].push_back(
            {leaf, view.direction, collision.flux / probability});
      }
    });
}

}  // namespace

float reach_of(double mean_cosine) { return mean_cosine > 0.75 ? 64 : 32; }

LobeDirections::LobeDirections() {
  constexpr double kPiD = std::numbers::pi;
  for (int i = 0; i < kPolar; ++i)
    for (int j = 0; j < kAzimuths; ++j) {
      const auto k = static_cast<size_t>(i * kAzimuths + j);
      const double theta = kPiD * (i + 0.5) / kPolar, phi = kPiD * (j + 0.5) / kAzimuths;
      x[k] = static_cast<float>(std::sin(theta) * std::cos(phi));
      y[k] = static_cast<float>(std::sin(theta) * std::sin(phi));
      z[k] = static_cast<float>(std::cos(theta));
      solid_angle[k] =
          static_cast<float>(2 * kPiD / kAzimuths * (std::cos(kPiD * i / kPolar) - std::cos(kPiD * (i + 1) / kPolar)));
    }
}

float LobeDirections::interpolate(const float* values, const Vec3& d) {
  const float theta = std::acos(std::clamp(d.z, -1.0f, 1.0f)), phi = std::atan2(std::abs(d.y), d.x);
  const float u = theta * (kPolar / kPi) - 0.5f, v = phi * (kAzimuths / kPi) - 0.5f;
  const int i = static_cast<int>(std::floor(u)), j = static_cast<int>(std::floor(v));
  // Beyond the pole lies the other side; beyond the sagittal plane its image.
  const auto at = [&](int row, int column) {
    column = std::clamp(column, 0, kAzimuths - 1);
    if (row < 0 || row >= kPolar) {
      row = row < 0 ? 0 : kPolar - 1;
      column = kAzimuths - 1 - column;
    }
    return values[row * kAzimuths + column];
  };
  const float by_u = u - static_cast<float>(i), by_v = v - static_cast<float>(j);
  return (1 - by_u) * ((1 - by_v) * at(i, j) + by_v * at(i, j + 1)) +
         by_u * ((1 - by_v) * at(i + 1, j) + by_v * at(i + 1, j + 1));
}

std::array<PhotonLobes, kSourceKinds> simulate_photons(const PhaseFunction& phase, const Spectrum& albedo,
                                                       const QuadtreeSettings& settings,
                                                       const Quadtree::Limits& limits) {
  if (!(albedo.max() <= static_cast<float>(kLargestAlbedo)))
    throw std::invalid_argument(
        fmt::format("tables of multiple scattering hold albedos from 0 to {}, not {}: scattering without end has no "
                    "sum. Use the method without a table, or let the medium absorb a little",
                    kLargestAlbedo, albedo.max()));
  const Photons photons(phase, albedo, settings);
  const float reach = reach_of(static_cast<double>(phase.mean_cosine()));
  std::array<PhotonLobes, kSourceKinds> lobes = {PhotonLobes{pilot(photons, SourceKind::kCollision, reach, limits), {}},
                                                 PhotonLobes{pilot(photons, SourceKind::kRay, reach, limits), {}}};
  constexpr size_t kCell = kChannels * LobeDirections::kCount;
  for (PhotonLobes& kind : lobes) kind.values.resize(kind.tree.leaf_count() * kCell);
  const PhaseSteps steps(phase);
  const LobeDirections directions;
  // Rounds: some threads follow photons, then some put what they found into the cells that are theirs, in order.
  constexpr uint64_t kBatches = 32, kPhotons = 512;
  std::vector<Deposits> batches(kBatches);
  for (uint64_t round = 0; round < settings.photons; round += kBatches * kPhotons) {
    parallel_for(kBatches, [&](size_t b) {
      const uint64_t first = round + b * kPhotons;
      collect(photons, lobes, first, std::clamp<uint64_t>(settings.photons, first, first + kPhotons), batches[b]);
    });
    parallel_for(kSourceKinds * kBlocks, [&](size_t task) {
      const size_t kind = task / kBlocks, block = task % kBlocks;
      alignas(64) std::array<float, LobeDirections::kCount> values;
      // Cell by cell, so that each stays at hand.
      std::vector<const Deposit*> sorted;
      for (const Deposits& batch : batches)
        for (const Deposit& deposit : batch[kind][block]) sorted.push_back(&deposit);
      std::stable_sort(sorted.begin(), sorted.end(),
                       [](const Deposit* a, const Deposit* b) { return a->leaf < b->leaf; });
      for (const Deposit* deposit : sorted) {
        steps.towards_all(directions, deposit->direction, values.data());
        float* cell = lobes[kind].values.data() + static_cast<size_t>(deposit->leaf) * kCell;
        for (int c = 0; c < kChannels; ++c, cell += LobeDirections::kCount) {
          const float flux = deposit->flux[c];
          for (size_t k = 0; k < LobeDirections::kCount; ++k) cell[k] += flux * values[k];
        }
      }
    });
  }
  for (size_t k = 0; k < kSourceKinds; ++k) {
    const double flux = k == static_cast<size_t>(SourceKind::kRay) ? -std::expm1(-double{kUnitSegment}) : 1;
    for (const Quadtree::Leaf& leaf : lobes[k].tree.leaves()) {
      const auto scale = static_cast<float>(flux / (static_cast<double>(settings.photons) * Quadtree::volume(leaf)));
      float* cell = lobes[k].values.data() + static_cast<size_t>(leaf.number) * kCell;
      for (size_t i = 0; i < kCell; ++i) cell[i] *= scale;
    }
  }
  return lobes;
}

}  // namespace turbid
