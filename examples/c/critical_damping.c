/* Critical yaw damping of a bogie, without this package: only the exported C files and libm.
 *
 *   yawdesign export problems/table1.yaml --to exported
 *   cc -std=c99 -O2 -Wall -Iexported -o critical_damping examples/c/critical_damping.c exported/yawdesign.c -lm
 *   ./critical_damping v=97.2222 lambda=0.2
 *
 * Prints C_sl, the frequency, and what each parameter does to C_sl. Exit codes: 0 solved, 2 wrong argument, 3 no solution.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "yawdesign.h"

#define PREFIXED(name) yawdesign_critical_damping_##name
#define INPUTS PREFIXED(in_count)
#define PARAMETERS PREFIXED(in_C_s_start) /* the start comes after the parameters */

typedef struct {
  double C_sl, omega, residual, gradient[INPUTS];
} answer;

/* Finds the critical damping near the start in x; returns 0 if there is one. */
static int critical_damping(const double x[], answer *y) {
  const double *arg[PREFIXED(SZ_ARG)] = {0};
  double *res[PREFIXED(SZ_RES)] = {0}, w[PREFIXED(SZ_W)];
  casadi_int iw[PREFIXED(SZ_IW)];
  int i;
  for (i = 0; i < INPUTS; ++i) arg[i] = &x[i];
  res[PREFIXED(out_C_sl)] = &y->C_sl;
  res[PREFIXED(out_omega)] = &y->omega;
  res[PREFIXED(out_residual)] = &y->residual;
  res[PREFIXED(out_gradient)] = y->gradient;
  /* Newton's method ends without an error where it finds nothing; the residual, maybe NaN, tells. */
  return yawdesign_critical_damping(arg, res, iw, w, 0) || !(y->residual < 1e-10);
}

/* Sets the input that an argument "name=value" names. */
static int set(const char *text, double x[]) {
  const char *sign = strchr(text, '=');
  char *end;
  int i;
  for (i = 0; sign && i < INPUTS; ++i) {
    const char *name = PREFIXED(name_in)(i);
    if (strlen(name) != (size_t)(sign - text) || strncmp(name, text, strlen(name))) continue;
    x[i] = strtod(sign + 1, &end);
    return end == sign + 1 || *end;
  }
  return 1;
}

int main(int argc, char **argv) {
  double x[] = PREFIXED(VALUES);
  answer y;
  int k;
  for (k = 1; k < argc; ++k) {
    if (set(argv[k], x)) {
      fprintf(stderr, "%s: expected a parameter and its value in SI, such as v=97.22\n", argv[k]);
      return 2;
    }
  }
  if (critical_damping(x, &y)) {
    fprintf(stderr, "no critical damping found from C_s_start=%g, omega_start=%g (residual %g)\n",
            x[PREFIXED(in_C_s_start)], x[PREFIXED(in_omega_start)], y.residual);
    return 3;
  }
  printf("C_sl %.15g N s/m\nomega %.15g rad/s\nresidual %.3g\n", y.C_sl, y.omega, y.residual);
  for (k = 0; k < PARAMETERS; ++k) printf("d C_sl / d %s %.15g\n", PREFIXED(name_in)(k), y.gradient[k]);
  return 0;
}
