#pragma once
#include "refraction/pencil.h"

namespace turbid {

/// Where refraction at P joins V with a light.
struct RefractedPath {
  V3d v, p;
  V3d normal;  ///< shading normal at P, unit, on the light's side
  V2d at;      ///< of P on its facet
  double eta;  ///< index at V / index at the light
  LightPoint light;
};

/// D = dA_L / dw_V: by how much area across the light's ray the place where rays from V arrive at the light changes per
/// solid angle at V, by differentials of rays through P with the interpolated normal (S4 sect. 3.1.2, Igehy 1999). For
/// lights at infinity: the solid angle dw_L / dw_V. What arrives at V from intensity I, before Fresnel's factor and
/// attenuation, is eta^2 I / D.
double distance_factor(const Facet& facet, const RefractedPath& path);

/// The closed form for a constant normal: (d_V + eta d_L) (c_L / c_V d_V + eta c_V / c_L d_L), with c = |cos| at P
/// (S4 eq. 11, whose last eta is missing there).
double flat_distance_factor(double distance_v, double distance_l, double cos_v, double cos_l, double eta);

}  // namespace turbid
