#include "medium/phase_function.h"

#include "medium/angle_distribution.h"

namespace turbid {

const AngleDistribution& PhaseFunction::angles() const {
  std::call_once(angles_made_, [this] { angles_ = std::make_shared<AngleDistribution>(*this); });
  return *angles_;
}

}  // namespace turbid
