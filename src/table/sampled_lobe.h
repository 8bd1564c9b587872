#pragma once
#include "table/photon_lobes.h"

namespace turbid {

/// The lobes that S1 sect. 3.3.2 stores: curves of 18 samples, one for each 10 degrees from the optimal axis, the line
/// in the sagittal plane about which the lobe's cross-section there is most nearly even.
///
/// First stands the angle of that axis to the line from the source, radians, positive away from the source's axis. A
/// point source's lobes are symmetric about it: a curve for each channel follows. For a segment these are one side of
/// the sagittal cross-section, towards positive angles; then come the ratios to it of the other side and of the coronal
/// cross-section, which is perpendicular to that through the axis, means of the channels. Between the sections lobes
/// change with the squared cosine of the azimuth.
class SampledLobe {
 public:
  static constexpr int kSamples = 18;
  static constexpr size_t kSymmetric = 1 + kSamples * kChannels, kAsymmetric = kSymmetric + 2 * kSamples;

  /// A view of kSymmetric or kAsymmetric numbers.
  SampledLobe(const float* numbers, bool asymmetric) : numbers_(numbers), asymmetric_(asymmetric) {}
  static size_t size(bool asymmetric) { return asymmetric ? kAsymmetric : kSymmetric; }

  float axis() const { return numbers_[0]; }
  /// Towards a direction in the frame of SagittalView.
  float eval(int channel, const Vec3& direction) const;
  /// int over the sphere.
  float integral(int channel) const;

  /// Fits one to lobes computed in all of LobeDirections, kCount numbers for each channel, and writes it to `numbers`.
  /// Its integrals are theirs.
  static void fit(const float* computed, bool asymmetric, float* numbers);

 private:
  const float* curve(int channel) const { return numbers_ + 1 + channel * kSamples; }

  const float* numbers_;
  bool asymmetric_;
};

}  // namespace turbid
