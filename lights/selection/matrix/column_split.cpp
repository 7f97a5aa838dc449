#include "lights/selection/matrix/column_split.h"

#include <Eigen/Core>
#include <algorithm>

namespace mote::lights {

namespace {

using Column = Eigen::Map<const Eigen::VectorXf>;

struct Projected {
    float along;
    std::uint32_t member;
    float norm;
};

/// (sum of norms)^2 - ||sum||^2.
double cost(double norms, const Eigen::VectorXd& sum) {
    return std::max(0.0, norms * norms - sum.squaredNorm());
}

}  // namespace

std::size_t split_columns(const Columns& columns, std::span<std::uint32_t> members) {
    const auto rows = Eigen::Index(columns.rows);
    const auto column = [&](std::uint32_t j) { return Column(columns.column(j), rows); };
    Eigen::VectorXd total = Eigen::VectorXd::Zero(rows);
    double norms = 0.0;
    std::vector<Projected> line;
    for (const std::uint32_t j : members) {
        const auto x = column(j);
        line.push_back({0.0f, j, x.norm()});
        total += x.cast<double>(), norms += double(line.back().norm);
    }
    if (!(cost(norms, total) > 0.0) || members.size() < 2) return 0;
    const Eigen::VectorXf middle = total.normalized().cast<float>();
    // Farthest: where a column costs most beside one of the middle's direction.
    const auto far = std::max_element(line.begin(), line.end(), [&](const Projected& a, const Projected& b) {
        return a.norm - middle.dot(column(a.member)) < b.norm - middle.dot(column(b.member));
    });
    const Eigen::VectorXf direction = column(far->member) / far->norm - middle;
    for (Projected& p : line) p.along = direction.dot(column(p.member)) / p.norm;
    std::sort(line.begin(), line.end(), [](const Projected& a, const Projected& b) {
        return a.along != b.along ? a.along < b.along : a.member < b.member;
    });
    Eigen::VectorXd left = Eigen::VectorXd::Zero(rows), right = total;
    Eigen::VectorXd x(rows);
    double left_norms = 0.0, least = cost(norms, total);
    std::size_t best = 0;
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        x = column(line[i].member).cast<double>();
        left += x, right -= x, left_norms += double(line[i].norm);
        const double both = cost(left_norms, left) + cost(norms - left_norms, right);
        if (both < least) least = both, best = i + 1;
    }
    for (std::size_t i = 0; i < line.size(); ++i) members[i] = line[i].member;
    return best;
}

}  // namespace mote::lights
