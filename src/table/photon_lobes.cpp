#include "table/photon_lobes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "core/parallel.h"
#include "core/rng.h"
#include "table/arrival_lobes.h"
#include "table/quadtree_content.h"
#include "table/sagittal_view.h"
#include "table/scattering_table.h"
#include "table/seed_photons.h"

namespace turbid {
namespace {

const Vec3 kAxis(0, 0, 1);

using Collision = SeedPhotons::Collision;

/// Where the collision lies when its photon began somewhere on the source: by its own share of the flux there.
Vec3 seen_from(const Collision& collision, SourceKind kind, Rng& rng) {
  if (kind == SourceKind::kCollision) return collision.position;
  return collision.position - kAxis * std::log1p(rng.next_float() * std::expm1(-kUnitSegment));
}

Quadtree::Place place_of(const Vec3& x) { return {std::hypot(x.x, x.y), x.z}; }

Quadtree pilot(const SeedPhotons& photons, SourceKind kind, float reach, const Quadtree::Limits& limits) {
  constexpr size_t kCollisions = 300'000;
  constexpr uint64_t kMost = 200'000, kFirst = uint64_t{1} << 40, kTogether = 64;
  std::vector<Quadtree::Place> places;
  for (uint64_t p = 0; p < kMost && places.size() < kCollisions; p += kTogether)
    photons.follow(kFirst + p, kFirst + p + kTogether, [&](const Collision& collision, Rng& rng) {
      places.push_back(place_of(seen_from(collision, kind, rng)));
    });
  return {reach, places, limits};
}

/// What a collision leaves in a cell.
struct Deposit {
  uint32_t leaf, arrival;  ///< the step of ArrivalLobes
  Spectrum flux;
};
/// Cells are shared out among these.
constexpr size_t kBlocks = 16;
using Deposits = std::array<std::array<std::vector<Deposit>, kBlocks>, kSourceKinds>;

/// A collision of a high order is put in with this probability: as many of each octave.
float chance(int order) { return std::min(1.0f, 8 / (static_cast<float>(order) * SeedPhotons::left(order))); }

void collect(const SeedPhotons& photons, const std::array<PhotonLobes, kSourceKinds>& lobes, uint64_t first,
             uint64_t last, Deposits& deposits) {
  for (auto& of_kind : deposits)
    for (auto& block : of_kind) block.clear();
  photons.follow(first, last, [&](const Collision& collision, Rng& rng) {
    const float probability = chance(collision.order);
    if (probability < 1 && !(rng.next_float() < probability)) return;
    for (size_t k = 0; k < kSourceKinds; ++k) {
      const Vec3 x = seen_from(collision, static_cast<SourceKind>(k), rng);
      const Quadtree::Place place = place_of(x);
      const Quadtree& tree = lobes[k].tree;
      if (!tree.holds(place)) continue;
      const auto leaf = static_cast<uint32_t>(tree.find(place).number);
      const uint32_t arrival = ArrivalLobes::step(SagittalView(x, kAxis, collision.direction).direction);
      deposits[k][leaf % kBlocks].push_back({leaf, arrival, photons.flux(collision.order) / probability});
    }
  });
}

/// Adds a leaf's deposits to its lobes: several at once, so that the lobes are read and written but once for them.
void put_in(std::span<const Deposit> deposits, const ArrivalLobes& arrivals, float* lobes) {
  constexpr size_t kTogether = 4, kCount = LobeDirections::kCount;
  static_assert(kCount % kLanes == 0);
  for (size_t first = 0; first < deposits.size(); first += kTogether) {
    std::array<const float*, kTogether> from;
    std::array<Spectrum, kTogether> flux;
    for (size_t k = 0; k < kTogether; ++k) {
      const bool is_one = first + k < deposits.size();
      from[k] = arrivals.lobe(deposits[is_one ? first + k : first].arrival);
      flux[k] = is_one ? deposits[first + k].flux : Spectrum(0.0f);
    }
    for (size_t i = 0; i < kCount; i += kLanes) {
      std::array<Lanes, kTogether> f;
      for (size_t k = 0; k < kTogether; ++k) f[k] = load_lanes(from[k] + i);
      for (size_t c = 0; c < kChannels; ++c) {
        float* const to = lobes + c * kCount + i;
        Lanes sum = load_lanes(to);
        for (size_t k = 0; k < kTogether; ++k) sum += flux[k][static_cast<int>(c)] * f[k];
        sum.copy_to(to, std::experimental::element_aligned);
      }
    }
  }
}

/// Of one block, leaf by leaf, so that each stays at hand.
void put_in_block(const std::vector<Deposits>& batches, size_t kind, size_t block, const ArrivalLobes& arrivals,
                  PhotonLobes& lobes) {
  // Sorts by counting.
  std::vector<size_t> ends(lobes.tree.leaf_count() + 1);
  size_t count = 0;
  for (const Deposits& batch : batches)
    for (const Deposit& deposit : batch[kind][block]) {
      ++ends[deposit.leaf + 1];
      ++count;
    }
  for (size_t leaf = 1; leaf < ends.size(); ++leaf) ends[leaf] += ends[leaf - 1];
  std::vector<Deposit> sorted(count);
  for (const Deposits& batch : batches)
    for (const Deposit& deposit : batch[kind][block]) sorted[ends[deposit.leaf]++] = deposit;
  // Each leaf now begins where the one before it ends.
  for (size_t leaf = 0; leaf < lobes.tree.leaf_count(); ++leaf) {
    const size_t begin = leaf > 0 ? ends[leaf - 1] : 0;
    put_in(std::span(sorted).subspan(begin, ends[leaf] - begin), arrivals,
           lobes.values.data() + leaf * kChannels * LobeDirections::kCount);
  }
}

/// From what photons of this flux left in each cell to lobes at the cells' middles, and factors.
void keep_contents(PhotonLobes& lobes, double flux) {
  static const LobeDirections directions;
  const QuadtreeContent content(lobes.tree);
  const size_t leaves = lobes.tree.leaf_count();
  lobes.factors.resize(leaves * kChannels);
  parallel_for(kChannels, [&](size_t channel) {
    const auto lobe = [&](size_t leaf) {
      return std::span(lobes.values)
          .subspan((leaf * kChannels + channel) * LobeDirections::kCount, LobeDirections::kCount);
    };
    std::vector<double> contents(leaves);
    for (size_t leaf = 0; leaf < leaves; ++leaf)
      for (size_t k = 0; k < LobeDirections::kCount; ++k)
        contents[leaf] += flux * static_cast<double>(lobe(leaf)[k] * directions.solid_angle[k]);
    const QuadtreeContent::Field field = content.to_field(contents);
    for (size_t leaf = 0; leaf < leaves; ++leaf) {
      const auto scale = static_cast<float>(contents[leaf] > 0 ? flux * field.values[leaf] / contents[leaf] : 0);
      for (float& value : lobe(leaf)) value *= scale;
      lobes.factors[leaf * kChannels + channel] = static_cast<float>(field.factors[leaf]);
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
  const SeedPhotons photons(phase, albedo, settings);
  const float reach = reach_of(static_cast<double>(phase.mean_cosine()));
  std::array<PhotonLobes, kSourceKinds> lobes = {
      PhotonLobes{pilot(photons, SourceKind::kCollision, reach, limits), {}, {}},
      PhotonLobes{pilot(photons, SourceKind::kRay, reach, limits), {}, {}}};
  constexpr size_t kCell = kChannels * LobeDirections::kCount;
  for (PhotonLobes& kind : lobes) kind.values.resize(kind.tree.leaf_count() * kCell);
  const ArrivalLobes arrivals(phase);
  // Rounds: some threads follow photons, then some put what they found into the cells that are theirs, in order.
  constexpr uint64_t kBatches = 32, kPhotons = 512;
  std::vector<Deposits> batches(kBatches);
  for (uint64_t round = 0; round < settings.photons; round += kBatches * kPhotons) {
    parallel_for(kBatches, [&](size_t b) {
      const uint64_t first = round + b * kPhotons;
      collect(photons, lobes, first, std::clamp<uint64_t>(settings.photons, first, first + kPhotons), batches[b]);
    });
    parallel_for(kSourceKinds * kBlocks, [&](size_t task) {
      const size_t kind = task / kBlocks;
      put_in_block(batches, kind, task % kBlocks, arrivals, lobes[kind]);
    });
  }
  for (const SourceKind kind : {SourceKind::kCollision, SourceKind::kRay}) {
    const double flux = kind == SourceKind::kRay ? -std::expm1(-double{kUnitSegment}) : 1;
    keep_contents(lobes[static_cast<size_t>(kind)], flux / static_cast<double>(settings.photons));
  }
  return lobes;
}

}  // namespace turbid
