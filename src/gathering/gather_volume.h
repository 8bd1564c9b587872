#pragma once
#include <vector>

#include "path/contribution.h"
#include "path/vertex.h"

namespace turbid {

/// A sphere around a collision of a walk from the sensor, or a piece of a cylinder around one of its flights, which
/// gathers light for a pixel.
struct GatherVolume {
  Vec3 origin;       ///< centre of the sphere; where the axis of the piece begins
  Vec3 direction;    ///< unit, of the walk, away from the sensor
  float radius = 0;  ///< scene units
  float length = 0;  ///< of the piece of a cylinder; 0: a sphere
  float start = 0;   ///< of the piece, from where the flight began
  /// Spheres: the walk's throughput in front of the flight, times transmittance over density of spheres per length, so
  /// that sigma_s f times light is still to come. Cylinders: the throughput in front of the flight.
  Spectrum weight{0.0f};
  const Medium* medium = nullptr;
  uint32_t pixel = 0;
  int depth = 0, order = 0;  ///< edges and collisions of the walk with the collision here
  bool last = false;         ///< takes light that was scattered before, too (GatherSettings::collisions)

  bool is_sphere() const { return length == 0; }
  Bounds3 bounds() const {
    Bounds3 box(origin, origin);
    box.extendBy(origin + direction * length);
    return {box.min - Vec3(radius), box.max + Vec3(radius)};
  }
};

/// A disk on a rough surface that a walk from the sensor has come to.
struct GatherDisk {
  Vertex vertex;
  float radius;
  uint32_t pixel;

  Bounds3 bounds() const { return {vertex.position - Vec3(radius), vertex.position + Vec3(radius)}; }
};

/// Light that a walk from the sensor has found by itself.
struct FoundLight {
  uint32_t pixel;
  Contribution contribution;
};

/// What walks from the sensor leave.
struct Gathering {
  std::vector<GatherVolume> volumes;
  std::vector<GatherDisk> disks;
  std::vector<FoundLight> light;

  void append(const Gathering& other) {
    volumes.insert(volumes.end(), other.volumes.begin(), other.volumes.end());
    disks.insert(disks.end(), other.disks.begin(), other.disks.end());
    light.insert(light.end(), other.light.begin(), other.light.end());
  }
  size_t bytes() const { return volumes.size() * sizeof(GatherVolume) + disks.size() * sizeof(GatherDisk); }
};

}  // namespace turbid
