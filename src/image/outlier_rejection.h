#pragma once
#include "image/cascades.h"
#include "image/image.h"

namespace turbid {

/// The picture with its outliers ("fireflies") weighed down, by what its Cascades tell (Zirr et al. 2018). `image` is
/// the mean of the film, its first channels are R, G, B; they become the weighed picture, and the mean is kept in
/// layers unweighted.{R,G,B} that follow the image's own channels. A film without cascades keeps its mean.
///
/// The mean of N samples is the sum of the cascades' means. It becomes their weighed sum, where cascade j of a pixel
/// has the weight
///
///   r_j = ((n_j - 1) + N max(E_j, start/20)/B_j) / (2 kappa),   kept within [0, 1],
///
/// the mean of two reasons to believe in its samples, each a number of samples in units of kappa:
/// - Others were like them. n_j samples fell into cascades j - 1, j and j + 1 (a sample lies in two of them); the one
///   in question does not count. An event seen n times has a relative error of 1/sqrt(n), so a few times is enough to
///   call it known. The 3x3 block decides whether it is: where its pixels have fewer than one such sample on average,
///   n_j is that average, which speaks against the sample, however many the pixel itself has.
/// - They do not matter. E_j is the luminance of the cascades below, weighed already, and a sample of brightness B_j
///   moves the mean by B_j/N: below E_j nobody sees it. A lone sample among pixels that know its like so adds at most
///   E_j/(2 kappa). Where all is dark, start/20 stands for E_j.
///
/// As N grows, so do all n_j of cascades that are ever met, and the picture tends to the mean: a bias at finite N,
/// always towards black, is the price. Where more than half of the samples are alike, in a pixel and the block around
/// it, they are trusted whatever kappa is; a pixel whose samples all are keeps its mean to the bit.
///
/// The formula for r_j, and 3x3, 1/20, base 8 and start 1, are those of the tool that the authors published. Different
/// here:
/// - cascade 0 always has the weight 1; the tool takes light from pixels that are dark altogether;
/// - kappa is no more than (N - 1)/4, so that samples that agree are believed when they are few (N = 1: the mean);
/// - light beyond the last cascade is a cascade above it as bright as its mean sample; the tool drops it;
/// - the tool's allowance for kappa > 1 is left out.
Image reject_outliers(const Image& image, const Film& film, const OutlierSettings& settings);

/// The layers that reject_outliers adds.
inline constexpr const char* kUnweightedNames[] = {"unweighted.R", "unweighted.G", "unweighted.B"};

/// Share of the luminance that the outliers took with them, of an image that reject_outliers made.
double rejected_share(const Image& image);

}  // namespace turbid
