#include <iostream>

int main() {
  std::cout << model.name();
}
