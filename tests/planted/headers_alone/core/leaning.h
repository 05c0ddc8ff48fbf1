#pragma once

// <vector> is not included.
// planted: alone
inline std::vector<double> ones() { return {}; }
