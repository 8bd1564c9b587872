#pragma once
#include <memory>
#include <vector>

#include "integrator/boundary_images.h"
#include "integrator/boundary_views.h"
#include "integrator/integrator_plugin.h"
#include "path/light_sources.h"
#include "path/path_settings.h"
#include "path/visit_roulette.h"
#include "path/walk.h"
#include "table/multiple_scattering.h"
#include "table/table_cache.h"

namespace turbid {

/// How integrators find light that has scattered many times in one visit to a medium (PathState::visit_order).
struct TableSettings {
  enum class Source {
    kNone,   ///< by the integrator's own method, all of it
    kTable,  ///< looked up in a table of the endless medium
    kModel   ///< the same by random walks in an endless medium: the reference of the table, noisy
  };
  /// How tables keep their light.
  enum class Mode {
    kExact,        ///< spherical harmonics, one table for all albedos of a phase function
    kSeed,         ///< as published by S1: sampled lobes in a quadtree, a table for each material
    kSeedComputed  ///< the same before lobes are compressed; not kept in files
  };
  Source source = Source::kNone;
  Mode mode = Mode::kExact;
  /// Collisions in one visit from which on the table has them: 3, 4 or 5. 2: those of two collisions, too, are found
  /// from the light that has entered, by a place on its way.
  int from_order = 3;
  /// The first order that is looked up.
  int table_order() const { return std::max(from_order, 3); }
  bool images = false;    ///< corrected for boundaries (Boundaries); else the medium has no end
  bool measured = false;  ///< weighed against what walks from lights bring out of each part of a medium (LightBalance)
  /// Media whose boundary lets light through in a choice of directions have tables, too. False for methods that stop at
  /// such a boundary, and do not come to where tables are looked up.
  bool behind_rough = true;
  TableRequest request;      ///< its folder serves both modes
  QuadtreeSettings photons;  ///< of kSeed; without from_order
};

/// The integrators' parameters `multiple_scattering`, `table_mode`, `from_order` and `boundary`, and what they say.
/// Refuses limits of depth and order that a sum over all orders cannot keep. Throws SceneError.
std::vector<Parameter> table_parameters();
TableSettings table_settings(const Properties& properties, const PathSettings& path);

/// A straight way of light through a medium on which it has not scattered in this visit: where a table begins.
struct EnteringLight {
  Stretch way;    ///< up to the next surface
  Spectrum flux;  ///< that sets out, W
  const Medium* medium;
  int depth, order;                      ///< edges and collisions behind
  std::optional<BoundaryPlane> entry{};  ///< where it has come in, for boundary = image
};

/// Light by class of order, the last one for all higher ones.
struct LightByOrder {
  Spectrum light[kOrderClasses] = {Spectrum(0.0f), Spectrum(0.0f), Spectrum(0.0f), Spectrum(0.0f)};
  void add(int order, const Spectrum& value) { light[std::min(order, kOrderClasses - 1)] += value; }
};

/// The tables of a scene's media, and what light that has entered brings by them (S1 sect. 4.3).
///
/// A path's visits to media are told apart by PathState::visit_order. One visit with `from_order` collisions or more is
/// the table's, from its first collision to its last: it is fed by all light that has entered unscattered, and looked
/// at from sensor walks that have entered unscattered. Of several such visits the one nearest to the sensor is the
/// table's, so walks from the sensor stop at collision `from_order` of a visit, and walks from lights go on: nothing
/// counts twice, and light that comes out and enters again is not lost.
///
/// Media without a table (varying, too little absorption, too much forward scattering) are left to the method.
/// Immutable, shared between threads.
class TableLight {
 public:
  /// Finds or builds the tables; warns of media that are left out.
  TableLight(const Scene& scene, const TableSettings& settings);

  int from_order() const { return settings_.from_order; }
  int table_order() const { return settings_.table_order(); }
  /// Those with a table.
  std::vector<const Medium*> media() const;
  /// The medium has a table.
  bool holds(const Medium* medium) const { return find(medium) != nullptr; }
  /// Leaves to the table what it has: for walks from the sensor.
  void limit(PathSettings& path) const {
    path.visit_limit = settings_.from_order;
    path.limited_media = media();
  }

  /// The boundaries that light is corrected by where a walk from the sensor is at x in the medium, having come along
  /// `direction`; none where it is not.
  BoundaryPlanes boundaries_around(const Vec3& x, const Vec3& direction, const Medium& medium) const {
    return boundaries_ ? boundaries_->around(x, direction, medium) : BoundaryPlanes();
  }

  /// Where a way through the medium begins: its boundary there; none where light is not corrected by boundaries.
  std::optional<BoundaryPlane> entry_of(const Stretch& way, const Medium& medium) const;

  /// What scatters at x towards w (unit) for the last time, three times and more, 1/sr per volume: W/(sr m^3). `rng`:
  /// for kModel alone.
  Spectrum source_radiance(const EnteringLight& light, const BoundaryPlanes& boundaries, const Vec3& x, const Vec3& w,
                           Rng& rng) const;

  /// The lights of the scene, half of whose rays are aimed at media with tables.
  const LightSources& sources() const { return *sources_; }
  /// Its light is weighed against what walks from lights bring out.
  bool measured() const { return settings_.measured; }

  /// What scatters at a collision of the sensor's walk towards it by the table, times what the walk makes of it.
  Spectrum looked_up(const EnteringLight& light, const BoundaryPlanes& boundaries, const CollisionEvent& event,
                     const PathState& state, Rng& rng) const;
  /// Adds `scale` times all that the light brings to the first collision of a visit of the sensor's walk, times what
  /// the walk makes of it, the table's light times `balance`; nothing in another medium, and where even the shortest
  /// path of a sum is longer than `path` allows.
  void at_collision(const EnteringLight& light, const BoundaryPlanes& boundaries, const CollisionEvent& event,
                    const PathState& state, const PathSettings& path, const Spectrum& balance, float scale, Rng& rng,
                    LightByOrder& sum) const;
  /// source_radiance times the balance along a way of a sensor's walk that has entered unscattered, of finite length;
  /// `state` at its beginning.
  Spectrum along(const EnteringLight& light, const BoundaryPlanes& boundaries, const Ray& way, const PathState& state,
                 const PathSettings& path, const LightBalance& balance, Rng& rng) const;

 private:
  struct Entry {
    const HomogeneousMedium* medium;
    std::unique_ptr<const MultipleScattering> scattering;  ///< null for kModel
  };
  const Entry* find(const Medium* medium) const;
  /// Of the table that the settings ask for.
  std::unique_ptr<const MultipleScattering> find_scattering(const HomogeneousMedium& medium) const;
  /// Paths with so many collisions in the visit, over the sensor's collision of that depth and order, count.
  static bool counts(const EnteringLight& light, int collisions, int depth, int order, const PathSettings& path) {
    return depth <= path.max_depth - light.depth - collisions &&
           path.order_counts(light.order + order - 1 + collisions);
  }
  /// Times the walk's throughput, whose albedo is in the table too: what remains is transmittance over density.
  static Spectrum seen_by(const PathState& state, const CollisionEvent& event, const Spectrum& source);
  /// What scatters at x towards w and once before, somewhere on the light's way: as source_radiance, by one random
  /// place.
  Spectrum twice_scattered(const EnteringLight& light, const Vec3& x, const Vec3& w, float u) const;

  TableSettings settings_;
  std::vector<Entry> entries_;
  std::optional<Boundaries> boundaries_;
  std::optional<LightSources> sources_;
};

/// For walks from lights.
inline PathSettings without_visit_limit(PathSettings path) {
  path.visit_limit = PathSettings::kUnlimited;
  return path;
}

/// Keeps the light of walks from lights that has entered media with tables.
class EnteringLightKeeper : public WalkRecorder {
 public:
  /// `scale`: a factor of the flux.
  EnteringLightKeeper(const Scene& scene, const TableLight& table, SampleCounters& counters, float scale = 1)
      : scene_(scene),
        table_(table),
        counters_(counters),
        scale_(scale),
        roulette_(table.media(), table.measured() ? kMeasuredShare : VisitRoulette::kShare) {}

  /// For a new walk; what has entered before is kept.
  void begin(const Rng& rng) { roulette_.begin(rng); }
  const std::vector<EnteringLight>& entered() const { return entered_; }
  /// What left media after as many collisions as tables hold.
  struct Left {
    const Medium* medium;
    Vec3 at;
    SurfaceSide side;
    LeavingPower light;
  };
  /// Where tables are measured; else empty.
  const std::vector<Left>& left() const { return left_; }

  void on_segment(const Ray& way, const Medium& medium, const PathState& state, const Traveller::Leg& leg);
  void left_medium(const Object& object, const SurfacePoint& point, const Vec3& given, const PathState& state);
  void left_collision(const CollisionEvent& event, float, const Vec3& chosen, const PathState& state,
                      const Traveller&) {
    last_ = event.position;
    last_direction_ = chosen;
    last_medium_ = &event.medium;
    roulette_.left_collision(event.medium, state);
  }
  bool goes_on() const { return roulette_.goes_on(); }

 private:
  /// Of walks that go on where what they bring out is wanted.
  static constexpr float kMeasuredShare = 0.3f;

  const Scene& scene_;
  const TableLight& table_;
  SampleCounters& counters_;
  float scale_;
  VisitRoulette roulette_;
  std::vector<EnteringLight> entered_;
  std::vector<Left> left_;
  Vec3 last_{0, 0, 0}, last_direction_{0, 0, 1};  ///< of the last collision, how it was left, and the medium of that
  const Medium* last_medium_ = nullptr;
};

}  // namespace turbid
