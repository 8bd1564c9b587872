#include "photon/photon_map.h"

namespace turbid {
namespace {

template <class T>
void move_to(std::vector<T>& all, std::vector<T>&& more) {
  all.insert(all.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
  more = {};
}

void build(PointTree& tree, const std::vector<PhotonPoint>& photons) {
  std::vector<Vec3> positions;
  positions.reserve(photons.size());
  for (const PhotonPoint& photon : photons) positions.push_back(photon.position);
  tree.build(positions);
}

/// A beam of the mean length is cut into so many pieces: boxes around long ones would be mostly empty.
constexpr float kPiecesPerMean = 1;
constexpr float kMostPieces = 64;  ///< of one beam

}  // namespace

void Photons::append(Photons&& other) {
  const auto shift = static_cast<uint32_t>(emissions.size());
  for (PhotonBeam& beam : other.beams) beam.emission += shift;
  move_to(collisions, std::move(other.collisions));
  move_to(surfaces, std::move(other.surfaces));
  move_to(beams, std::move(other.beams));
  move_to(emissions, std::move(other.emissions));
}

size_t Photons::bytes() const {
  constexpr size_t kPointIndex = 32, kBeamIndex = 128;
  return (collisions.size() + surfaces.size()) * (sizeof(PhotonPoint) + kPointIndex) +
         beams.size() * (sizeof(PhotonBeam) + kBeamIndex) + emissions.size() * sizeof(Emission);
}

void PhotonMap::index(const std::function<float(const HomogeneousMedium&)>& beam_radius) {
  build(collisions_, photons.collisions);
  build(surfaces_, photons.surfaces);
  double whole = 0;
  for (const PhotonBeam& beam : photons.beams) whole += static_cast<double>(beam.ray().t_max);
  const float mean = static_cast<float>(whole / static_cast<double>(std::max<size_t>(photons.beams.size(), 1)));
  pieces_.clear();
  for (uint32_t i = 0; i < photons.beams.size(); ++i) {
    const float length = photons.beams[i].ray().t_max;
    const float count = std::clamp(std::ceil(kPiecesPerMean * length / mean), 1.0f, kMostPieces);
    for (float k = 0; k < count; ++k) pieces_.push_back({i, length * (k / count), length * ((k + 1) / count)});
  }
  beams_.build(pieces_.size(), [&](size_t i) {
    const Piece& piece = pieces_[i];
    const PhotonBeam& beam = photons.beams[piece.beam];
    const Ray& ray = beam.ray();
    Bounds3 box(ray.at(piece.from), ray.at(piece.from));
    box.extendBy(ray.at(piece.to));
    const Vec3 margin(beam_radius(*beam.medium));
    return Bounds3(box.min - margin, box.max + margin);
  });
}

StrategySums PhotonMap::sums_at(const Scene& scene, const StrategyWeights& weights, const PhotonBeam& beam,
                                float distance) const {
  const EdgeEnd end{beam.ray().at(distance), beam.medium->sigma_t(), 1};
  const Spectrum straight = beam.straight * beam.medium->transmittance(distance);
  if (beam.depth == 0) return sums_behind_light(scene, weights, photons.emissions[beam.emission], end, straight);
  return beam.edge.sums_at(weights, end, straight);
}

}  // namespace turbid
