#pragma once
#include <functional>

#include "gathering/volume_index.h"
#include "photon/photon.h"
#include "photon/point_tree.h"

namespace turbid {

/// What a number of light paths leave.
struct Photons {
  std::vector<PhotonPoint> collisions, surfaces;
  std::vector<PhotonBeam> beams;
  std::vector<Emission> emissions;  ///< of the paths with beams

  void clear() { *this = {}; }
  void append(Photons&& other);
  /// About, with what makes them searchable.
  size_t bytes() const;
};

/// Photons, made searchable.
class PhotonMap {
 public:
  Photons photons;
  /// Once all photons are there; `beam_radius`: how far from a beam in that medium it is to be found.
  void index(const std::function<float(const HomogeneousMedium&)>& beam_radius);

  const PointTree& collisions() const { return collisions_; }
  const PointTree& surfaces() const { return surfaces_; }

  /// Calls visit(beam, from, to) for pieces of beams that a ray may come near to, or a point may lie near to; each
  /// piece is the part of a beam between two distances along it, and no two pieces of a beam overlap.
  template <class Visit>
  void beams_along(const Ray& ray, const Visit& visit) const {
    beams_.along(ray, [&](uint32_t number) { call(number, visit); });
  }
  template <class Visit>
  void beams_around(const Vec3& p, const Visit& visit) const {
    beams_.around(p, [&](uint32_t number) { call(number, visit); });
  }

  /// The sums of a beam at a place on it, `distance` along.
  StrategySums sums_at(const Scene& scene, const StrategyWeights& weights, const PhotonBeam& beam,
                       float distance) const;

 private:
  /// Long beams are cut into pieces with boxes of their own.
  struct Piece {
    uint32_t beam;
    float from, to;
  };
  template <class Visit>
  void call(uint32_t number, const Visit& visit) const {
    const Piece& piece = pieces_[number];
    visit(piece.beam, piece.from, piece.to);
  }

  PointTree collisions_, surfaces_;
  VolumeIndex beams_;
  std::vector<Piece> pieces_;
};

}  // namespace turbid
