#pragma once

#include <vector>

inline std::vector<double> zeros() { return {}; }
