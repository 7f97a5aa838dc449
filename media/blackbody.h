// The colour of a black body in linear Rec. 709, relative to the peak of its spectrum.
#pragma once

#include <vector>

#include "core/math/vec.h"

namespace mote::media {

/// Planck's law at `kelvin`, divided by its largest value, integrated against the CIE 1931 observer (the fit
/// of Wyman et al. 2013) so that a flat spectrum of one has luminance one; components outside the gamut are
/// raised to 0. Black below 100 K, as in pbrt-v4.
core::Rgb blackbody_rgb(double kelvin);

/// blackbody_rgb tabulated up to a temperature: linear between entries 1/1024 of it apart.
class BlackbodyTable {
  public:
    explicit BlackbodyTable(double max_kelvin);
    core::Rgb at(float kelvin) const;

  private:
    std::vector<core::Rgb> entries_;
    float to_entry_;
};

}  // namespace mote::media
