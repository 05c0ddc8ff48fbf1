#pragma once

#include <vector>

namespace hbar {

class Forward;
template <typename S>
struct ForwardTemplate;

/// Documented.
class Model {
 public:
  int member() const;
};

// planted: documented
class Bare {
 public:
  int member() const { return 1; }
};

// planted: documented
struct BareStruct {
  int a = 0;
};

/// Documented, on two lines.
[[nodiscard]] std::vector<int> documented(int a,
                                          int b);
[[nodiscard]] std::vector<int> documented(int a);

// planted: documented
[[nodiscard]] int bare(int a, int b = int{});

// An ordinary comment does not document.
// planted: documented
template <typename S>
[[nodiscard]] S bare_template(const S& s) {
  return s;
}

inline int Model::member() const { return 1; }

// planted: documented
enum class Kind { kOne, kTwo };

// planted: documented
inline constexpr int kNumber = 3;
inline constexpr int kOther = 4;  ///< documented behind

namespace detail {
int not_public();
}  // namespace detail

}  // namespace hbar
