#include "ui/presenter/axis.h"

#include <algorithm>
#include <cmath>

namespace passung::presenter {

double roundScale(double value) {
    const double ten = std::pow(10.0, std::floor(std::log10(value)));
    for (const double step : {1.0, 2.0, 5.0})
        if (step * ten >= value) return step * ten;
    return 10.0 * ten;
}

std::vector<double> axisMarks(double low, double high, int about) {
    if (!(high > low)) {  // one value, or none: room around it
        const double room = low == 0.0 ? 1.0 : 0.1 * std::abs(low);
        low -= room;
        high += room;
    }
    const double step = roundScale((high - low) / about);
    const double slack = 1e-9 * step;
    std::vector<double> marks;
    for (double n = std::floor((low + slack) / step); marks.empty() || marks.back() < high - slack; ++n)
        marks.push_back(n * step);
    return marks;
}

}  // namespace passung::presenter
