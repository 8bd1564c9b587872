#pragma once

namespace turbid::bench {

/// Prints tables about single scattering through refractive boundaries: the cost of a camera ray against the number of
/// triangles, the noise of the methods for the time they take, and what the shortcuts change. About a minute, of one
/// thread.
void print_refraction_study();

}  // namespace turbid::bench
