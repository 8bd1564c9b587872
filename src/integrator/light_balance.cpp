#include "integrator/light_balance.h"

#include <algorithm>
#include <cmath>

namespace turbid {
namespace {

/// What is known of a node counts like so many independent samples when the larger part around it is asked, too.
constexpr double kPrior = 16;

/// Of samples, and how many they are.
struct Sums {
  double value = 0, count = 0;
  void add(double weight, double one) { value += weight * one, count += weight; }
  void add(double weight, const Sums& other) { value += weight * other.value, count += weight * other.count; }
};
/// What leaves, and what is predicted.
struct Pair {
  Sums leaving, predicted;
  void add(double weight, const Pair& other) {
    leaving.add(weight, other.leaving);
    predicted.add(weight, other.predicted);
  }
  bool tells() const { return leaving.value > 0 && predicted.value > 0; }
  double ratio() const { return leaving.value / predicted.value; }
};
size_t node_index(const std::array<int, 3>& cells, int x, int y, int z) {
  return static_cast<size_t>((z * (cells[1] + 1) + y) * (cells[0] + 1) + x);
}
size_t node_count(const std::array<int, 3>& cells) { return node_index(cells, cells[0], cells[1], cells[2]) + 1; }

std::array<int, 3> halved(std::array<int, 3> cells) {
  for (int& count : cells) count = (count + 1) / 2;
  return cells;
}

/// The trilinear weights of a grid's nodes among those of the grid of half as many cells: share(node, coarser node,
/// weight).
template <class Share>
void for_coarser_nodes(const std::array<int, 3>& cells, const Share& share) {
  const std::array<int, 3> coarser = halved(cells);
  for (int z = 0; z <= cells[2]; ++z)
    for (int y = 0; y <= cells[1]; ++y)
      for (int x = 0; x <= cells[0]; ++x)
        for (int corner = 0; corner < 8; ++corner) {
          const std::array<int, 3> at{x, y, z}, side{corner & 1, corner >> 1 & 1, corner >> 2 & 1};
          double weight = 1;
          for (size_t a = 0; a < 3; ++a) weight *= at[a] % 2 ? 0.5 : side[a] ? 0 : 1;
          if (weight > 0)
            share(node_index(cells, x, y, z), node_index(coarser, x / 2 + side[0], y / 2 + side[1], z / 2 + side[2]),
                  weight);
        }
}

/// How many equal samples tell as much, over how many there are. One number for all: were it that of a node, nodes with
/// a strong sample would trust it less than others trust their weak ones, and light would be lost.
double evenness(std::span<const LeavingPower> all, int channel) {
  double sum = 0, squares = 0;
  for (const LeavingPower& light : all) {
    const auto power = static_cast<double>(light.power[channel]);
    sum += power, squares += power * power;
  }
  return squares > 0 ? sum * sum / squares / static_cast<double>(all.size()) : 1;
}

}  // namespace

struct LightBalance::Level {
  using Node = std::array<std::array<Pair, kChannels>, kDirections>;
  Cells cells;
  std::vector<Node> nodes;
  explicit Level(const Cells& c) : cells(c), nodes(node_count(c)) {}
};

std::array<float, LightBalance::kDirections> LightBalance::direction_weights(const Vec3& w) {
  std::array<float, kDirections> weights;
  for (int a = 0; a < 3; ++a) {
    weights[static_cast<size_t>(2 * a)] = sqr(std::max(w[a], 0.0f));
    weights[static_cast<size_t>(2 * a + 1)] = sqr(std::max(-w[a], 0.0f));
  }
  return weights;
}

std::array<LightBalance::Corner, 8> LightBalance::corners(const Vec3& x) const {
  std::array<int, 3> cell{};
  Vec3 part;
  for (int a = 0; a < 3; ++a) {
    int& own = cell[static_cast<size_t>(a)];
    const auto count = static_cast<float>(cells_[static_cast<size_t>(a)]);
    const float place = std::clamp((x[a] - origin_[a]) / spacing_, 0.0f, count);
    own = static_cast<int>(std::min(place, count - 1));
    part[a] = place - static_cast<float>(own);
  }
  std::array<Corner, 8> result;
  for (int i = 0; i < 8; ++i) {
    const int dx = i & 1, dy = i >> 1 & 1, dz = i >> 2 & 1;
    result[static_cast<size_t>(i)] = {
        node_index(cells_, cell[0] + dx, cell[1] + dy, cell[2] + dz),
        (dx ? part.x : 1 - part.x) * (dy ? part.y : 1 - part.y) * (dz ? part.z : 1 - part.z)};
  }
  return result;
}

LightBalance::LightBalance(std::span<const LeavingPower> leaving, std::span<const LeavingPower> predicted,
                           size_t cells) {
  Bounds3 box;
  for (const LeavingPower& l : leaving) box.extendBy(l.scattered);
  if (leaving.empty() || !(max_component(box.size()) > 0)) return;
  constexpr float kThinnest = 1e-3f;  // of the longest side
  const Vec3 size = box.size() + Vec3(max_component(box.size()) * kThinnest);
  origin_ = box.min;
  spacing_ = std::cbrt(size.x * size.y * size.z / static_cast<float>(std::max<size_t>(cells, 1)));
  for (int a = 0; a < 3; ++a)
    cells_[static_cast<size_t>(a)] = std::max(1, static_cast<int>(std::ceil(size[a] / spacing_)));

  Ratios ones;
  ones.fill(Spectrum(1.0f));
  ratios_.assign(node_count(cells_), ones);
  // Nodes blur what they are told: each round mends what those before have left.
  constexpr int kRounds = 3;
  for (int round = 0; round < kRounds; ++round) refine(leaving, predicted);
}

void LightBalance::refine(std::span<const LeavingPower> leaving, std::span<const LeavingPower> predicted) {
  std::vector<Level> levels{Level(cells_)};
  const auto put = [&](const LeavingPower& light, const Spectrum& power, Sums Pair::*sums) {
    const auto by_direction = direction_weights(light.direction);
    for (const Corner& corner : corners(light.scattered))
      for (size_t d = 0; d < kDirections; ++d)
        for (int c = 0; c < kChannels; ++c)
          (levels.front().nodes[corner.node][d][static_cast<size_t>(c)].*sums)
              .add(static_cast<double>(corner.weight * by_direction[d]), static_cast<double>(power[c]));
  };
  for (const LeavingPower& light : leaving) put(light, light.power, &Pair::leaving);
  for (const LeavingPower& light : predicted)
    put(light, light.power * at(light.scattered, light.direction), &Pair::predicted);

  while (levels.back().cells != Cells{1, 1, 1}) {
    Level coarser(halved(levels.back().cells));
    for_coarser_nodes(levels.back().cells, [&](size_t from, size_t to, double weight) {
      for (size_t d = 0; d < kDirections; ++d)
        for (size_t c = 0; c < kChannels; ++c) coarser.nodes[to][d][c].add(weight, levels.back().nodes[from][d][c]);
    });
    levels.push_back(std::move(coarser));
  }

  Spectrum whole(1.0f);
  std::array<double, kChannels> even_leaving, even_predicted;
  for (size_t c = 0; c < kChannels; ++c) {
    even_leaving[c] = evenness(leaving, static_cast<int>(c));
    even_predicted[c] = evenness(predicted, static_cast<int>(c));
    Pair all;
    for (const Level::Node& node : levels.back().nodes)
      for (const auto& direction : node) all.add(1, direction[c]);
    if (all.tells()) whole[static_cast<int>(c)] = static_cast<float>(all.ratio());
  }
  Ratios same, none;
  same.fill(whole);
  none.fill(Spectrum(0.0f));
  std::vector<Ratios> factors(levels.back().nodes.size(), same);
  for (size_t l = levels.size(); l-- > 0;) {
    const Level& level = levels[l];
    if (l + 1 < levels.size()) {
      std::vector<Ratios> finer(level.nodes.size(), none);
      for_coarser_nodes(level.cells, [&](size_t from, size_t to, double weight) {
        for (size_t d = 0; d < kDirections; ++d) finer[from][d] += factors[to][d] * static_cast<float>(weight);
      });
      factors = std::move(finer);
    }
    for (size_t n = 0; n < factors.size(); ++n)
      for (size_t d = 0; d < kDirections; ++d)
        for (size_t c = 0; c < kChannels; ++c) {
          const Pair& pair = level.nodes[n][d][c];
          if (!pair.tells()) continue;
          float& factor = factors[n][d][static_cast<int>(c)];
          const double count =
              1 / (1 / (even_leaving[c] * pair.leaving.count) + 1 / (even_predicted[c] * pair.predicted.count));
          factor = static_cast<float>((count * pair.ratio() + kPrior * static_cast<double>(factor)) / (count + kPrior));
        }
  }
  for (size_t n = 0; n < ratios_.size(); ++n)
    for (size_t d = 0; d < kDirections; ++d) ratios_[n][d] *= factors[n][d];
}

Spectrum LightBalance::at(const Vec3& x, const Vec3& w) const {
  if (ratios_.empty()) return Spectrum(1.0f);
  const auto by_direction = direction_weights(w);
  Spectrum sum(0.0f);
  for (const Corner& corner : corners(x))
    for (size_t d = 0; d < kDirections; ++d)
      if (by_direction[d] > 0) sum += ratios_[corner.node][d] * (corner.weight * by_direction[d]);
  return sum;
}

}  // namespace turbid
