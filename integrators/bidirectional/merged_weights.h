// MIS weights over connections and merges, in constant time for each vertex of a subpath.
//
// A path of n vertices x_0 (light) ... x_{n-1} (camera) is found by connections (s, t), as in
// integrators/bidirectional/subpath.h, and by merges at x_k, 0 < k < n - 1. With a_i and b_i the densities of
// x_i from the light and from the camera, and p_s the density of connection (s, n - s),
//   p_k / p_{k+1} = b_k / a_k      and     p_{merge at k} / p_{k+1} = b_k K_k      (derived)
// so that the sum over all techniques with fewer vertices from the light than connection k + 1, in its terms,
// is
//   A_k = h(b_k) sum h(K_k) + h(b_k / a_k) (c_k + A_{k-1}),   A_{-1} = 0                              (1)
// with c_k = h of what connection k has beyond the vertices' densities. From the camera the same holds with
// both ends exchanged; a merge at x_k belongs to one end's sum alone.
#pragma once

#include "integrators/bidirectional/heuristic.h"

namespace mote::integrators {

/// A vertex of one end's subpath, complete once the next two vertices of the path are known.
struct WeightVertex {
    double density = 1.0;     ///< from this end [1/m^2], without sigma_t
    double reverse = 0.0;     ///< from the other end
    double connection = 1.0;  ///< c of the connection along the edge before it; 0 beside delta parts
    double merges = 0.0;      ///< merge_terms(); 0 at both ends of the path
};

/// A_k of Eq. (1), from `before` = A_{k-1}.
inline double techniques_before(Heuristic heuristic, const WeightVertex& v, double before) {
    const double ratio = v.density > 0.0 ? v.reverse / v.density : 0.0;
    const double sum =
        mis_term(heuristic, v.reverse) * v.merges + mis_term(heuristic, ratio) * (v.connection + before);
    return std::min(sum, 1e200);
}

/// Weight of a connection whose own c is `own`; both sums end at the connected vertices.
inline double connection_weight(double own, double from_light, double from_eye) {
    return own > 0.0 ? own / (own + from_light + from_eye) : 0.0;
}

/// A vertex that both subpaths have found, for the weight of a merge there.
struct MergedVertex {
    double from_light = 1.0, from_eye = 1.0;              ///< a_k and b_k [1/m^2]
    double connection_light = 1.0, connection_eye = 1.0;  ///< c of the edges to x_{k-1} and to x_{k+1}
    double before_light = 0.0, before_eye = 0.0;          ///< A up to x_{k-1}, and the camera's up to x_{k+1}
    double merges = 0.0;                                  ///< merge_terms() at x_k
};

/// Weight of the merge by the technique of kernel measure K, over K [1/m^2]: what the product of the two
/// subpaths' weights and of the integrand is multiplied with. Finite where K is 0, as between parallel beams.
inline double merge_weight_over_kernel(Heuristic heuristic, const MergedVertex& v, double kernel) {
    if (heuristic == Heuristic::none) return kernel > 0.0 ? 1.0 / kernel : 0.0;
    const auto inverse = [&](double p) { return p > 0.0 ? mis_term(heuristic, 1.0 / p) : 0.0; };
    const double sum = v.merges + inverse(v.from_light) * (v.connection_light + v.before_light) +
                       inverse(v.from_eye) * (v.connection_eye + v.before_eye);
    if (!(sum > 0.0)) return 0.0;
    return (heuristic == Heuristic::power ? kernel : 1.0) / sum;
}

}  // namespace mote::integrators
