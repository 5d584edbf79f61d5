#include <cstdio>

#include "microlane/microlane.h"

int main() {
  const float x[] = {0, 0.6f, -0.6f}, y[] = {0, 0, 0}, z[] = {1, 0.8f, -0.8f};
  const microlane::Directions wi{x, y, z}, wo{x, y, z};
  float f_cos[3];
  microlane::rough_dielectric::Eval(3, wi, wo, {0.1f, 0.3f, 1.5f}, f_cos);
  std::printf("batch on %s: %g %g %g\n", microlane::ChosenTarget().c_str(), f_cos[0], f_cos[1], f_cos[2]);
  return f_cos[0] > 0 && f_cos[1] > 0 && f_cos[1] == f_cos[2] ? 0 : 1;
}
