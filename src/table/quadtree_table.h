#pragma once
#include "table/field_moments.h"
#include "table/sampled_lobe.h"
#include "table/scattered_light.h"

namespace turbid {

/// Multiple scattering of one material as S1 publishes it (mode `seed`): the albedos of its channels inside, mean free
/// path 1; a quadtree of sampled lobes for each kind of source, symmetric ones about a collision, asymmetric ones about
/// a unit segment. Light outside of the quadtree is lost.
struct QuadtreeTable {
  struct Kind {
    Quadtree tree;
    std::vector<float> lobes;    ///< [leaf] a SampledLobe each
    std::vector<float> factors;  ///< [leaf][channel] of PhotonLobes
    SampledLobe lobe(SourceKind kind, size_t leaf) const {
      const bool asymmetric = kind == SourceKind::kRay;
      return {lobes.data() + leaf * SampledLobe::size(asymmetric), asymmetric};
    }
  };

  std::vector<double> moments;  ///< f_l of the phase function, l = 0 ... 64
  Spectrum albedo;
  QuadtreeSettings settings;
  std::array<Kind, kSourceKinds> kinds;

  const Kind& kind(SourceKind of) const { return kinds[static_cast<size_t>(of)]; }
  /// Memory in bytes.
  size_t size() const;
};

/// Fits lobes to what photons left.
QuadtreeTable compress_lobes(const std::array<PhotonLobes, kSourceKinds>& lobes, const PhaseFunction& phase,
                             const Spectrum& albedo, const QuadtreeSettings& settings);
/// Simulates and compresses.
QuadtreeTable build_quadtree_table(const PhaseFunction& phase, const Spectrum& albedo, const QuadtreeSettings& settings,
                                   const Quadtree::Limits& limits = {});

/// One channel's light about one kind of source; of kRay: one unit segment. Between the middles of cells as large as
/// the one looked at, bilinear: four look-ups. Black outside of the quadtree. Immutable, shared between threads.
class QuadtreeField final : public LightField {
 public:
  QuadtreeField(std::shared_ptr<const QuadtreeTable> table, SourceKind kind, int channel);
  /// From lobes that were not compressed (S1 Fig. 26).
  QuadtreeField(std::shared_ptr<const PhotonLobes> lobes, int channel);

  float eval(const Vec3& x, const Vec3& axis, const Vec3& w) const override;
  float density(const Vec3& x, const Vec3& axis) const override;
  const Quadtree& tree() const { return *tree_; }
  /// Angle of the optimal axis of the leaf at a place to the line from the source.
  float optimal_axis(const Quadtree::Place& place) const;

 private:
  template <class Value>
  float interpolate(const Quadtree::Place& place, const Value& value) const;
  float lobe(size_t leaf, const Vec3& direction) const;

  std::shared_ptr<const void> owner_;
  const Quadtree* tree_;
  const QuadtreeTable::Kind* sampled_ = nullptr;
  const PhotonLobes* computed_ = nullptr;
  SourceKind kind_ = SourceKind::kCollision;
  int channel_;
  const float* factors_;          ///< [leaf][channel]
  std::vector<float> densities_;  ///< per leaf
};

/// By quadrature over the places that a quadtree holds: of a field of its own, or what another one has there.
FieldMoments measure_moments(const LightField& field, const Quadtree& tree);

/// How far a quadtree's field is from another one, where the quadtree is.
LobeDifference compare_within(const LightField& exact, const QuadtreeField& field, const PolarGrid& grid);

/// Light of a medium by a quadtree (S1 eq. 6, 10). A stretch is cut into unit segments, each looked up from its own
/// beginning; what remains at its end is taken as collisions along it.
ChannelLights quadtree_lights(std::shared_ptr<const QuadtreeTable> table);
/// The same by lobes that were not compressed.
ChannelLights quadtree_lights(const std::array<std::shared_ptr<const PhotonLobes>, kSourceKinds>& lobes);

}  // namespace turbid
