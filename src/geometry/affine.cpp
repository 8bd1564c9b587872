#include "geometry/affine.h"

#include <Imath/ImathMatrixAlgo.h>

namespace turbid {

double least_stretch(const Transform& m) {
  if (m.at(3, 0) != 0 || m.at(3, 1) != 0 || m.at(3, 2) != 0 || m.at(3, 3) != 1) return 0;
  Imath::M33d linear, u, v;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) linear[row][column] = m.at(row, column);
  Imath::V3d s;
  Imath::jacobiSVD(linear, u, s, v);
  return std::min({s.x, s.y, s.z});
}

}  // namespace turbid
