#include "table/quadtree_table.h"

#include <cmath>
#include <numbers>

#include "core/gauss_legendre.h"
#include "core/parallel.h"
#include "table/phase_moments.h"
#include "table/quadtree_content.h"
#include "table/sagittal_view.h"

namespace turbid {
namespace {

/// No unit segments begin farther along: e^-12 of the light is left.
constexpr float kFarthest = 6 * kUnitSegment;

class QuadtreeLight final : public ScatteredLight {
 public:
  QuadtreeLight(QuadtreeField collision, QuadtreeField segment)
      : collision_(std::move(collision)), segment_(std::move(segment)) {}

  float from_collision(const Vec3& x, const Vec3& axis, const Vec3& w) const override {
    return collision_.eval(x, axis, w);
  }
  float from_stretch(const Vec3& x, const Vec3& axis, float depth, const Vec3& w) const override {
    float sum = 0, begin = 0;
    for (; begin + kUnitSegment <= depth && begin < kFarthest; begin += kUnitSegment)
      sum += std::exp(-begin) * segment_.eval(x - axis * begin, axis, w);
    if (begin >= kFarthest || !(depth > begin)) return sum;
    return sum + std::exp(-begin) * collisions_of_stretch(depth - begin, x - axis * begin, axis,
                                                          [&](const Vec3& at) { return collision_.eval(at, axis, w); });
  }
  Lanes from_collision(const Vec3Lanes& x, const Vec3& axis, const Vec3& w) const override {
    return for_each_lane(x, [&](const Vec3& at) { return from_collision(at, axis, w); });
  }
  Lanes from_stretch(const Vec3Lanes& x, const Vec3& axis, float depth, const Vec3& w) const override {
    return for_each_lane(x, [&](const Vec3& at) { return from_stretch(at, axis, depth, w); });
  }

 private:
  template <class Value>
  static Lanes for_each_lane(const Vec3Lanes& x, const Value& value) {
    // Numbers first: with lanes at hand the calls of the mathematical library below would take four times as long.
    const std::array<LaneRow, 3> places{to_row(x.x), to_row(x.y), to_row(x.z)};
    LaneRow row;
    for (size_t lane = 0; lane < kLanes; ++lane)
      row[lane] = value(Vec3(places[0][lane], places[1][lane], places[2][lane]));
    return load_lanes(row);
  }

  QuadtreeField collision_, segment_;
};

Quadtree::Place place_of(const SagittalView& view) {
  return {view.distance * safe_sqrt(1 - view.cosine * view.cosine), view.distance * view.cosine};
}

}  // namespace

size_t QuadtreeTable::size() const {
  size_t bytes = moments.size() * sizeof(double);
  for (const Kind& kind : kinds)
    bytes += kind.tree.nodes().size() * sizeof(int32_t) + (kind.lobes.size() + kind.factors.size()) * sizeof(float);
  return bytes;
}

QuadtreeTable compress_lobes(const std::array<PhotonLobes, kSourceKinds>& lobes, const PhaseFunction& phase,
                             const Spectrum& albedo, const QuadtreeSettings& settings) {
  const auto fit_all = [&](SourceKind kind) {
    const PhotonLobes& of_kind = lobes[static_cast<size_t>(kind)];
    const bool asymmetric = kind == SourceKind::kRay;
    const size_t size = SampledLobe::size(asymmetric);
    QuadtreeTable::Kind result{of_kind.tree, std::vector<float>(of_kind.tree.leaf_count() * size), of_kind.factors};
    parallel_for(of_kind.tree.leaf_count(), [&](size_t leaf) {
      SampledLobe::fit(of_kind.lobe(leaf, 0), asymmetric, result.lobes.data() + leaf * size);
    });
    return result;
  };
  QuadtreeTable table{
      legendre_moments(phase, 64), albedo, settings, {fit_all(SourceKind::kCollision), fit_all(SourceKind::kRay)}};
  return table;
}

QuadtreeTable build_quadtree_table(const PhaseFunction& phase, const Spectrum& albedo, const QuadtreeSettings& settings,
                                   const Quadtree::Limits& limits) {
  return compress_lobes(simulate_photons(phase, albedo, settings, limits), phase, albedo, settings);
}

QuadtreeField::QuadtreeField(std::shared_ptr<const QuadtreeTable> table, SourceKind kind, int channel)
    : owner_(table),
      tree_(&table->kind(kind).tree),
      sampled_(&table->kind(kind)),
      kind_(kind),
      channel_(channel),
      factors_(sampled_->factors.data()) {
  for (size_t leaf = 0; leaf < tree_->leaf_count(); ++leaf)
    densities_.push_back(sampled_->lobe(kind, leaf).integral(channel));
}

QuadtreeField::QuadtreeField(std::shared_ptr<const PhotonLobes> lobes, int channel)
    : owner_(lobes), tree_(&lobes->tree), computed_(lobes.get()), channel_(channel), factors_(lobes->factors.data()) {
  static const LobeDirections directions;
  for (size_t leaf = 0; leaf < tree_->leaf_count(); ++leaf) {
    float sum = 0;
    const float* values = computed_->lobe(leaf, static_cast<size_t>(channel));
    for (size_t k = 0; k < LobeDirections::kCount; ++k) sum += values[k] * directions.solid_angle[k];
    densities_.push_back(sum);
  }
}

float QuadtreeField::lobe(size_t leaf, const Vec3& direction) const {
  return sampled_ ? sampled_->lobe(kind_, leaf).eval(channel_, direction)
                  : LobeDirections::interpolate(computed_->lobe(leaf, static_cast<size_t>(channel_)), direction);
}

template <class Value>
float QuadtreeField::interpolate(const Quadtree::Place& place, const Value& value) const {
  if (!tree_->holds(place)) return 0;
  const QuadtreeCorners corners(*tree_, place);
  float sum = 0;
  for (size_t k = 0; k < 4; ++k) sum += corners.weights[k] * value(corners.leaves[k], corners.beyond[k]);
  return sum * factors_[corners.leaves[0] * kChannels + static_cast<size_t>(channel_)];
}

float QuadtreeField::eval(const Vec3& x, const Vec3& axis, const Vec3& w) const {
  const SagittalView view(x, axis, w);
  const Vec3 mirrored(-view.direction.x, view.direction.y, view.direction.z);
  return interpolate(place_of(view),
                     [&](size_t leaf, bool beyond) { return lobe(leaf, beyond ? mirrored : view.direction); });
}

float QuadtreeField::density(const Vec3& x, const Vec3& axis) const {
  return interpolate(place_of(SagittalView(x, axis, axis)), [&](size_t leaf, bool) { return densities_[leaf]; });
}

float QuadtreeField::optimal_axis(const Quadtree::Place& place) const {
  return sampled_ && tree_->holds(place) ? sampled_->lobe(kind_, static_cast<size_t>(tree_->find(place).number)).axis()
                                         : 0;
}

FieldMoments measure_moments(const LightField& field, const Quadtree& tree) {
  const GaussLegendre rule(4);
  FieldMoments sum;
  for (const Quadtree::Leaf& leaf : tree.leaves())
    for (size_t i = 0; i < 2 * rule.size(); ++i)
      for (size_t j = 0; j < 2 * rule.size(); ++j) {
        // The interpolant bends in the middle of a cell.
        const auto node = [&](size_t k) {
          return (rule.node(k % rule.size()) + static_cast<double>(k / rule.size())) / 2;
        };
        const double size = static_cast<double>(leaf.size), rho = static_cast<double>(leaf.rho) + node(i) * size,
                     z = static_cast<double>(leaf.z) + node(j) * size;
        const double mass = 2 * std::numbers::pi * rho * size * size * rule.weight(i % rule.size()) *
                            rule.weight(j % rule.size()) / 4 *
                            static_cast<double>(field.density(Vec3(Imath::V3d(rho, 0, z)), {0, 0, 1}));
        sum.energy += mass;
        sum.along += mass * z;
        sum.square += mass * (rho * rho + z * z);
      }
  return {sum.energy, sum.along / sum.energy, sum.square / sum.energy};
}

LobeDifference compare_within(const LightField& exact, const QuadtreeField& field, const PolarGrid& grid) {
  return compare_lobes(exact, field, grid, [&](const Vec3& x) {
    return field.tree().holds({std::hypot(x.x, x.y), x.z});
  });
}

ChannelLights quadtree_lights(std::shared_ptr<const QuadtreeTable> table) {
  ChannelLights lights;
  for (int c = 0; c < kChannels; ++c)
    if (table->albedo[c] > 0)
      lights[static_cast<size_t>(c)] = std::make_shared<QuadtreeLight>(QuadtreeField(table, SourceKind::kCollision, c),
                                                                       QuadtreeField(table, SourceKind::kRay, c));
  return lights;
}

ChannelLights quadtree_lights(const std::array<std::shared_ptr<const PhotonLobes>, kSourceKinds>& lobes) {
  ChannelLights lights;
  for (int c = 0; c < kChannels; ++c)
    lights[static_cast<size_t>(c)] =
        std::make_shared<QuadtreeLight>(QuadtreeField(lobes[0], c), QuadtreeField(lobes[1], c));
  return lights;
}

}  // namespace turbid
