"""Texts of the files that go with the exported C source."""

HEADER = """\
/* $about
 *
 * Every argument and result is an array of doubles, a matrix column by column, all in SI units. A function returns 0,
 * or not 0 if it could not be evaluated. res[i] may be NULL for a result that is not wanted. The work vectors iw and w
 * have the lengths ..._SZ_IW and ..._SZ_W, arg and res ..._SZ_ARG and ..._SZ_RES; mem is 0. No memory is allocated.
 */
#ifndef ${guard}
#define ${guard}

#ifndef casadi_real
#define casadi_real double
#endif
#ifndef casadi_int
#define casadi_int long long int
#endif

#ifdef __cplusplus
extern "C" {
#endif

$functions
#ifdef __cplusplus
}
#endif
#endif
"""

SELF_TEST = """\
/* Runs every exported function on the values of the problem and compares with what CasADi computed. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "$header"

typedef struct {
  const char *name;
  int (*call)(const double **, double **, casadi_int *, double *, int);
  int (*work)(casadi_int *, casadi_int *, casadi_int *, casadi_int *);
  casadi_int (*n_in)(void), (*n_out)(void);
  const casadi_int *(*sparsity_in)(casadi_int), *(*sparsity_out)(casadi_int);
  const char *(*name_out)(casadi_int);
  casadi_int sizes[4];
  const double *inputs, *outputs;
} test_case;

$cases

static const test_case CASES[] = {
$rows
};

static casadi_int length(const casadi_int *sparsity) { return sparsity[0] * sparsity[1]; }

/* As in the manifest: 1e-9 of the largest entry, and 1e-12 for what is zero but for rounding. */
static int same(const double *got, const double *expected, casadi_int n) {
  double largest = 0;
  casadi_int k;
  for (k = 0; k < n; ++k)
    if (isfinite(expected[k]) && fabs(expected[k]) > largest) largest = fabs(expected[k]);
  for (k = 0; k < n; ++k)
    if (isfinite(expected[k]) ? !(fabs(got[k] - expected[k]) <= 1e-9 * largest + 1e-12) : isfinite(got[k])) return 0;
  return 1;
}

static int run(const test_case *t) {
  casadi_int sizes[4], i, total = 0, wrong = 0;
  const double *x = t->inputs, *y = t->outputs, **arg;
  double **res, *w, *out;
  casadi_int *iw;
  t->work(&sizes[0], &sizes[1], &sizes[2], &sizes[3]);
  for (i = 0; i < 4; ++i)
    if (sizes[i] > t->sizes[i]) return printf("%s: work vectors in the header are too short\\n", t->name), 1;
  for (i = 0; i < t->n_out(); ++i) total += length(t->sparsity_out(i));
  arg = calloc((size_t)t->sizes[0], sizeof *arg);
  res = calloc((size_t)t->sizes[1], sizeof *res);
  iw = calloc((size_t)t->sizes[2], sizeof *iw);
  w = calloc((size_t)t->sizes[3], sizeof *w);
  out = calloc((size_t)(total + 1), sizeof *out);
  if (!arg || !res || !iw || !w || !out) return printf("out of memory\\n"), 1;
  for (i = 0; i < t->n_in(); ++i) { arg[i] = x; x += length(t->sparsity_in(i)); }
  for (i = 0, total = 0; i < t->n_out(); ++i) { res[i] = out + total; total += length(t->sparsity_out(i)); }
  if (t->call(arg, res, iw, w, 0)) { printf("%s: could not be evaluated\\n", t->name); wrong = 1; }
  for (i = 0; i < t->n_out(); ++i) {
    casadi_int n = length(t->sparsity_out(i));
    if (!wrong && !same(res[i], y, n)) { printf("%s: %s differs\\n", t->name, t->name_out(i)); wrong = 1; }
    y += n;
  }
  free((void *)arg); free(res); free(iw); free(w); free(out);
  printf("%-28s %s\\n", t->name, wrong ? "WRONG" : "ok");
  return wrong ? 1 : 0;
}

int main(void) {
  int wrong = 0;
  size_t i;
  for (i = 0; i < sizeof CASES / sizeof *CASES; ++i) wrong += run(&CASES[i]);
  return wrong ? EXIT_FAILURE : EXIT_SUCCESS;
}
"""

EXAMPLE = """\
/* Evaluates $name with the values of the problem; any input can be changed: ./example $first=... */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "$header"

static double values[] = ${s}_VALUES;

static casadi_int length(const casadi_int *sparsity) { return sparsity[0] * sparsity[1]; }

/* Sets the input of an argument "name=value". */
static int set(const char *text, const double **arg) {
  const char *sign = strchr(text, '=');
  casadi_int i;
  for (i = 0; sign && i < ${s}_in_count; ++i) {
    const char *name = ${s}_name_in(i);
    if (strlen(name) == (size_t)(sign - text) && !strncmp(name, text, strlen(name))) {
      values[arg[i] - values] = strtod(sign + 1, NULL);
      return 0;
    }
  }
  fprintf(stderr, "%s: no input of $name\\n", text);
  return 1;
}

int main(int argc, char **argv) {
  static casadi_int iw[${s}_SZ_IW];
  static double w[${s}_SZ_W];
  const double *arg[${s}_SZ_ARG], *place = values;
  double *res[${s}_SZ_RES];
  casadi_int i, k;
  for (i = 0; i < ${s}_in_count; ++i) { arg[i] = place; place += length(${s}_sparsity_in(i)); }
  for (k = 1; k < argc; ++k)
    if (set(argv[k], arg)) return 2;
  for (i = 0; i < ${s}_out_count; ++i) {
    res[i] = calloc((size_t)length(${s}_sparsity_out(i)) + 1, sizeof(double));
    if (!res[i]) return 3;
  }
  if (${s}(arg, res, iw, w, 0)) return fprintf(stderr, "could not be evaluated\\n"), 3;
  for (i = 0; i < ${s}_out_count; ++i) {
    printf("%s:", ${s}_name_out(i));
    for (k = 0; k < length(${s}_sparsity_out(i)); ++k) printf(" %.17g", res[i][k]);
    printf("\\n");
    free(res[i]);
  }
  return 0;
}
"""

MAKEFILE = """\
# make: the self-test and the example; make check: run the self-test; make library: for casadi.external and others;
# make octave: the functions for GNU Octave
CFLAGS = -std=c99 $optimised -Wall
LDLIBS = -lm

all: selftest example

selftest: selftest.c $prefix.c $prefix.h
\t$$(CC) $$(CFLAGS) -o $$@ selftest.c $prefix.c $$(LDLIBS)

example: example.c $prefix.c $prefix.h
\t$$(CC) $$(CFLAGS) -o $$@ example.c $prefix.c $$(LDLIBS)

check: selftest
\t./selftest

# Not $prefix.so: Python would take it for a module of that name.
library: lib$prefix.so

lib$prefix.so: $prefix.c
\t$$(CC) $$(CFLAGS) -shared -fPIC -o $$@ $prefix.c $$(LDLIBS)

octave: $prefix.mex

$prefix.mex: $prefix.c
\tmkoctfile --mex -DMATLAB_MEX_FILE $prefix.c

clean:
\trm -f selftest example lib$prefix.so $prefix.mex $prefix.o

.PHONY: all check library octave clean
"""
