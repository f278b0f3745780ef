#include <cstdio>

int main() {
  std::puts("breccia 0.1.0");
  return 0;
}
