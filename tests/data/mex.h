/* What a MEX gateway needs of MATLAB's interface, for full matrices and texts: enough to run one without MATLAB. */
#ifndef MEX_H
#define MEX_H
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef size_t mwSize;
typedef size_t mwIndex;
typedef struct { mwSize m, n; double *x; const char *text; } mxArray;
enum { mxREAL };

static int mxGetString(const mxArray *a, char *to, mwSize n) { return !a->text || (strncpy(to, a->text, n), 0); }
static int mxIsDouble(const mxArray *a) { return !a->text; }
static int mxIsSparse(const mxArray *a) { (void)a; return 0; }
static mwSize mxGetNumberOfDimensions(const mxArray *a) { (void)a; return 2; }
static mwSize mxGetM(const mxArray *a) { return a->m; }
static mwSize mxGetN(const mxArray *a) { return a->n; }
static void *mxGetData(const mxArray *a) { return a->x; }
static mwIndex *mxGetJc(const mxArray *a) { (void)a; abort(); }
static mwIndex *mxGetIr(const mxArray *a) { (void)a; abort(); }
static mxArray *mxCreateSparse(mwSize m, mwSize n, mwSize k, int c) { (void)m; (void)n; (void)k; (void)c; abort(); }
static mxArray *mxCreateDoubleMatrix(mwSize m, mwSize n, int c) {
  mxArray *a = calloc(1, sizeof *a);
  (void)c;
  if (!a) abort();
  a->m = m; a->n = n; a->x = calloc(m * n + 1, sizeof(double));
  return a;
}
static void mexErrMsgTxt(const char *text) { puts(text); exit(1); }
static void mexErrMsgIdAndTxt(const char *id, const char *text, ...) {
  va_list rest;
  va_start(rest, text); fputs(id, stdout); vprintf(text, rest); va_end(rest);
  exit(1);
}
#endif
