#include "tests/support/pearson.h"

#include <algorithm>
#include <cmath>

namespace mote::tests {

void pearson(std::vector<Cell> cells, Chi2Result& result) {
    std::erase_if(cells, [](const Cell& c) { return c.expected <= 0.0; });
    std::sort(cells.begin(), cells.end(),
              [](const Cell& a, const Cell& b) { return a.expected < b.expected; });
    Cell pool;
    int terms = 0;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        pool.expected += cells[i].expected, pool.observed += cells[i].observed;
        if (pool.expected < 5.0 && i + 1 < cells.size()) continue;
        if (pool.expected > 0.0)
            result.statistic +=
                (pool.observed - pool.expected) * (pool.observed - pool.expected) / pool.expected;
        ++terms, pool = Cell();
    }
    result.degrees = terms - 1;
    result.p_value = chi2_survival(result.statistic, result.degrees);
}

std::size_t impossible_cells(const std::vector<Cell>& cells, double negligible) {
    return std::size_t(std::count_if(cells.begin(), cells.end(), [&](const Cell& c) {
        return !(c.expected > negligible) && c.observed > 0.0;
    }));
}

double chi2_survival(double statistic, int degrees) {
    // Regularised incomplete gamma function Q(a, x) (Abramowitz & Stegun 1964, 6.5.29 and 6.5.31).
    const double a = 0.5 * degrees, x = 0.5 * statistic;
    if (!(x > 0.0) || degrees < 1) return 1.0;
    const double front = std::exp(a * std::log(x) - x - std::lgamma(a));
    if (x < a + 1.0) {
        double term = 1.0 / a, sum = term;
        for (int n = 1; n < 100000 && term > sum * 1e-16; ++n) term *= x / (a + n), sum += term;
        return 1.0 - front * sum;
    }
    double b = x + 1.0 - a, c = 1e300, d = 1.0 / b, fraction = d;  // Lentz's continued fraction
    for (int i = 1; i < 100000; ++i) {
        const double an = -i * (i - a);
        b += 2.0;
        d = 1.0 / (an * d + b), c = b + an / c;
        fraction *= d * c;
        if (std::fabs(d * c - 1.0) < 1e-15) break;
    }
    return front * fraction;
}

double sidak_level(double significance, std::size_t tests) {
    return -std::expm1(std::log1p(-significance) / double(tests));
}

}  // namespace mote::tests
