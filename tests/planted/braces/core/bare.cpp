#include "hbar/core/bare.h"

// if (this) is a comment, and so is: else stop(); for (;;) while (true) do nothing();
#define WHILE_POSITIVE(n) \
  if ((n) < 0) return 0;  \
  while (n) n /= 2
#if defined(BARE)
#endif

namespace hbar {

int bare(int n, const std::vector<int>& rows) {
  // planted: braces
  if (n < 0) return 0;
  // planted: braces
  for (int row : rows) n += row;
  // planted: braces
  while (n > 9) n /= 2;
  if (n == 1) {
    return 1;
    // planted: braces
  } else
    n = 2;
  if (n == 1) {
    return 1;
    // planted: braces
  } else if (n == 2)
    return 2;
  // planted: braces
  if (n == 3 &&
      (rows.size() > 1 ||
       rows.front() == f(")")))  // a condition of several lines, and a bracket in a string
    return 3;
  // planted: braces
  if constexpr (sizeof(int) == 4) n = 4;
  // planted: braces
  if (n == 4) [[unlikely]]
    return 4;
  // planted: braces
  do n /= 2;
  while (n > 5);
  // planted: braces
  while (next(n));
  // planted: braces
  for (int i = 0; i < n; ++i)
    // planted: braces
    if (i == 5) return 5;
  const auto inner = [&](int i) {
    // planted: braces
    if (i == 6) return 6;
    return 0;
  };
  return inner(n);
}

int braced(int n, const std::vector<int>& rows) {
  WHILE_POSITIVE(n);
  const char* text = "if (n) return 0; else return 1;";
  const char* raw = R"(for (;;)
    if (n) return 0;
    else return 1;)";
  const int elsewhere = n, form = 'i', if_any = 1, do_it = 0;
  if (n == 1 &&
      (rows.size() > 1 || rows.front() == f("(")))  // a bracket in a string
  {
    return 1;
  } else if (n == 2) {
    return 2;
  } else {
    n = elsewhere;
  }
  if constexpr (sizeof(int) == 4) {
    n = 4;
  }
  if (n == 5) [[unlikely]] {
    n = 6;
  }
  for (const int row : {1, 2}) {
    n += row;
  }
  do {
    while (n > 6) {
      n /= 2;
    }
  } while (n > 5);
  return n + form + if_any + do_it;
}

}  // namespace hbar
