/* FMI 3.0 model exchange around the equations of motion of a linear bogie.

   model.h holds the names, start values and ranges of this one bogie; motion.c holds its equations as CasADi wrote them:
   motion(known) -> unknown, and tangent(known, seed) -> derivative of unknown along seed. Both know nothing of FMI.

   A value reference is an index into one array of numbers:
       known   = parameters, inputs, continuous states
       unknown = derivatives of the states in their order, then outputs
   and the time, which no equation needs, has the reference after them.

   C99, no other header or library is needed. Where FMI's own fmi3Functions.h was included before, its types are used. */

#include <float.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "model.h"

#if defined __GNUC__
/* Generated code, and stubs for what this unit does not provide */
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#endif

#define CASADI_SYMBOL_EXPORT static
#include "motion.c"

#ifndef fmi3Functions_h
typedef void *fmi3Instance, *fmi3InstanceEnvironment, *fmi3FMUState;
typedef uint32_t fmi3ValueReference;
typedef float fmi3Float32;
typedef double fmi3Float64;
typedef int8_t fmi3Int8;
typedef uint8_t fmi3UInt8;
typedef int16_t fmi3Int16;
typedef uint16_t fmi3UInt16;
typedef int32_t fmi3Int32;
typedef uint32_t fmi3UInt32;
typedef int64_t fmi3Int64;
typedef uint64_t fmi3UInt64;
typedef bool fmi3Boolean, fmi3Clock;
typedef const char *fmi3String;
typedef uint8_t fmi3Byte;
typedef const fmi3Byte *fmi3Binary;
typedef enum { fmi3OK, fmi3Warning, fmi3Discard, fmi3Error, fmi3Fatal } fmi3Status;
typedef enum { fmi3Independent, fmi3Constant, fmi3Fixed, fmi3Tunable, fmi3Discrete, fmi3Dependent } fmi3DependencyKind;
typedef enum { fmi3IntervalNotYetKnown, fmi3IntervalUnchanged, fmi3IntervalChanged } fmi3IntervalQualifier;
typedef void (*fmi3LogMessageCallback)(fmi3InstanceEnvironment, fmi3Status, fmi3String, fmi3String);
typedef void (*fmi3ClockUpdateCallback)(fmi3InstanceEnvironment);
typedef void (*fmi3IntermediateUpdateCallback)(fmi3InstanceEnvironment, fmi3Float64, fmi3Boolean, fmi3Boolean,
                                               fmi3Boolean, fmi3Boolean, fmi3Boolean *, fmi3Float64 *);
typedef void (*fmi3LockPreemptionCallback)();
typedef void (*fmi3UnlockPreemptionCallback)();
#endif

#ifndef FMI3_Export
#if defined _WIN32 || defined __CYGWIN__
#define FMI3_Export __declspec(dllexport)
#elif defined __GNUC__
#define FMI3_Export __attribute__((visibility("default")))
#else
#define FMI3_Export
#endif
#endif

#define TIME VARIABLES
#define KNOWN (PARAMETERS + INPUTS + STATES)
#define FIRST_STATE (PARAMETERS + INPUTS)
typedef const fmi3ValueReference *References;

typedef struct {
    double value[VARIABLES + 1];
    bool current; /* whether the unknown values belong to the known ones */
    bool logging;
    fmi3LogMessageCallback log;
    fmi3InstanceEnvironment environment;
} Bogie;

static fmi3Status wrong(const Bogie *bogie, const char *format, ...) {
    char text[256];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    if (bogie->logging && bogie->log) bogie->log(bogie->environment, fmi3Error, "logStatusError", text);
    return fmi3Error;
}

static void start(Bogie *bogie) {
    memset(bogie->value, 0, sizeof bogie->value);
    memcpy(bogie->value, start_values, sizeof start_values);
    bogie->current = false;
}

static void evaluate(Bogie *bogie) {
    const double *arguments[MOTION_ARG] = {bogie->value};
    double *results[MOTION_RES] = {bogie->value + KNOWN};
    double work[MOTION_W];
    casadi_int integers[MOTION_IW];
    if (!bogie->current) motion(arguments, results, integers, work, 0);
    bogie->current = true;
}

static bool out_of_range(fmi3ValueReference reference, double value) {
    if (reference >= PARAMETERS) return !(value >= -DBL_MAX && value <= DBL_MAX);
    return !(value >= least[reference] && value <= greatest[reference]);
}

/* Life cycle */

FMI3_Export const char *fmi3GetVersion(void) { return "3.0"; }

FMI3_Export fmi3Instance fmi3InstantiateModelExchange(fmi3String name, fmi3String token, fmi3String resources,
                                                      fmi3Boolean visible, fmi3Boolean logging,
                                                      fmi3InstanceEnvironment environment, fmi3LogMessageCallback log) {
    Bogie *bogie = calloc(1, sizeof *bogie);
    if (!bogie) return NULL;
    bogie->logging = logging;
    bogie->log = log;
    bogie->environment = environment;
    start(bogie);
    if (token && strcmp(token, INSTANTIATION_TOKEN) == 0) return bogie;
    wrong(bogie, "the instantiation token is not that of this library: modelDescription.xml and library do not match");
    free(bogie);
    return NULL;
}

FMI3_Export void fmi3FreeInstance(fmi3Instance instance) { free(instance); }

FMI3_Export fmi3Status fmi3SetDebugLogging(fmi3Instance instance, fmi3Boolean on, size_t n, const fmi3String names[]) {
    ((Bogie *)instance)->logging = on;
    return fmi3OK;
}

FMI3_Export fmi3Status fmi3Reset(fmi3Instance instance) {
    start(instance);
    return fmi3OK;
}

FMI3_Export fmi3Status fmi3SetTime(fmi3Instance instance, fmi3Float64 time) {
    ((Bogie *)instance)->value[TIME] = time;
    return fmi3OK;
}

FMI3_Export fmi3Status fmi3EnterInitializationMode(fmi3Instance instance, fmi3Boolean tolerance_defined,
                                                   fmi3Float64 tolerance, fmi3Float64 start_time,
                                                   fmi3Boolean stop_defined, fmi3Float64 stop_time) {
    return fmi3SetTime(instance, start_time);
}

#define NOTHING_TO_DO(name) \
    FMI3_Export fmi3Status name(fmi3Instance instance) { return instance ? fmi3OK : fmi3Error; }
NOTHING_TO_DO(fmi3ExitInitializationMode)
NOTHING_TO_DO(fmi3EnterEventMode)
NOTHING_TO_DO(fmi3EnterContinuousTimeMode)
NOTHING_TO_DO(fmi3EvaluateDiscreteStates)
NOTHING_TO_DO(fmi3Terminate)

FMI3_Export fmi3Status fmi3UpdateDiscreteStates(fmi3Instance instance, fmi3Boolean *again, fmi3Boolean *terminate,
                                                fmi3Boolean *nominals_changed, fmi3Boolean *states_changed,
                                                fmi3Boolean *next_event_defined, fmi3Float64 *next_event) {
    *again = *terminate = *nominals_changed = *states_changed = *next_event_defined = false;
    return fmi3OK;
}

FMI3_Export fmi3Status fmi3CompletedIntegratorStep(fmi3Instance instance, fmi3Boolean no_way_back,
                                                   fmi3Boolean *event_mode, fmi3Boolean *terminate) {
    *event_mode = *terminate = false;
    return fmi3OK;
}

/* Values */

FMI3_Export fmi3Status fmi3GetFloat64(fmi3Instance instance, References references, size_t n, fmi3Float64 values[],
                                      size_t n_values) {
    Bogie *bogie = instance;
    if (n != n_values) return wrong(bogie, "%zu variables, but room for %zu values", n, n_values);
    for (size_t i = 0; i < n; i++) {
        if (references[i] > TIME) return wrong(bogie, "there is no variable %u", (unsigned)references[i]);
        if (references[i] >= KNOWN) evaluate(bogie);
        values[i] = bogie->value[references[i]];
    }
    return fmi3OK;
}

FMI3_Export fmi3Status fmi3SetFloat64(fmi3Instance instance, References references, size_t n,
                                      const fmi3Float64 values[], size_t n_values) {
    Bogie *bogie = instance;
    if (n != n_values) return wrong(bogie, "%zu variables, but %zu values", n, n_values);
    for (size_t i = 0; i < n; i++) {
        fmi3ValueReference k = references[i];
        if (k >= KNOWN) return wrong(bogie, "variable %u cannot be set", (unsigned)k);
        if (out_of_range(k, values[i])) return wrong(bogie, "%s = %.9g is out of range", names[k], values[i]);
    }
    for (size_t i = 0; i < n; i++) bogie->value[references[i]] = values[i];
    bogie->current = false;
    return fmi3OK;
}

FMI3_Export fmi3Status fmi3GetContinuousStates(fmi3Instance instance, fmi3Float64 states[], size_t n) {
    Bogie *bogie = instance;
    if (n != STATES) return wrong(bogie, "there are %d states, not %zu", STATES, n);
    memcpy(states, bogie->value + FIRST_STATE, STATES * sizeof *states);
    return fmi3OK;
}

FMI3_Export fmi3Status fmi3SetContinuousStates(fmi3Instance instance, const fmi3Float64 states[], size_t n) {
    Bogie *bogie = instance;
    if (n != STATES) return wrong(bogie, "there are %d states, not %zu", STATES, n);
    memcpy(bogie->value + FIRST_STATE, states, STATES * sizeof *states);
    bogie->current = false;
    return fmi3OK;
}

FMI3_Export fmi3Status fmi3GetContinuousStateDerivatives(fmi3Instance instance, fmi3Float64 derivatives[], size_t n) {
    Bogie *bogie = instance;
    if (n != STATES) return wrong(bogie, "there are %d states, not %zu", STATES, n);
    evaluate(bogie);
    memcpy(derivatives, bogie->value + KNOWN, STATES * sizeof *derivatives);
    return fmi3OK;
}

FMI3_Export fmi3Status fmi3GetNominalsOfContinuousStates(fmi3Instance instance, fmi3Float64 nominals[], size_t n) {
    if (n != STATES) return wrong(instance, "there are %d states, not %zu", STATES, n);
    memcpy(nominals, nominal, sizeof nominal);
    return fmi3OK;
}

FMI3_Export fmi3Status fmi3GetNumberOfContinuousStates(fmi3Instance instance, size_t *n) {
    *n = STATES;
    return fmi3OK;
}

FMI3_Export fmi3Status fmi3GetNumberOfEventIndicators(fmi3Instance instance, size_t *n) {
    *n = 0;
    return fmi3OK;
}

FMI3_Export fmi3Status fmi3GetEventIndicators(fmi3Instance instance, fmi3Float64 indicators[], size_t n) {
    return n ? wrong(instance, "there are no event indicators, not %zu", n) : fmi3OK;
}

FMI3_Export fmi3Status fmi3GetDirectionalDerivative(fmi3Instance instance, References unknowns, size_t n_unknowns,
                                                    References knowns, size_t n_knowns, const fmi3Float64 seed[],
                                                    size_t n_seed, fmi3Float64 sensitivity[], size_t n_sensitivity) {
    Bogie *bogie = instance;
    double direction[VARIABLES] = {0}, work[TANGENT_W];
    const double *arguments[TANGENT_ARG] = {bogie->value, direction};
    double *results[TANGENT_RES] = {direction + KNOWN};
    casadi_int integers[TANGENT_IW];
    if (n_seed != n_knowns || n_sensitivity != n_unknowns) return wrong(bogie, "seed or sensitivity has a wrong length");
    for (size_t i = 0; i < n_knowns; i++) {
        if (knowns[i] >= KNOWN) return wrong(bogie, "variable %u is not known", (unsigned)knowns[i]);
        direction[knowns[i]] = seed[i];
    }
    tangent(arguments, results, integers, work, 0);
    for (size_t i = 0; i < n_unknowns; i++) {
        if (unknowns[i] >= VARIABLES) return wrong(bogie, "there is no variable %u", (unsigned)unknowns[i]);
        sensitivity[i] = direction[unknowns[i]];
    }
    return fmi3OK;
}

/* State of the whole unit: its array of values */

FMI3_Export fmi3Status fmi3GetFMUState(fmi3Instance instance, fmi3FMUState *state) {
    Bogie *bogie = instance;
    if (!*state && !(*state = malloc(sizeof bogie->value))) return wrong(bogie, "out of memory");
    evaluate(bogie);
    memcpy(*state, bogie->value, sizeof bogie->value);
    return fmi3OK;
}

FMI3_Export fmi3Status fmi3SetFMUState(fmi3Instance instance, fmi3FMUState state) {
    Bogie *bogie = instance;
    memcpy(bogie->value, state, sizeof bogie->value);
    bogie->current = true;
    return fmi3OK;
}

FMI3_Export fmi3Status fmi3FreeFMUState(fmi3Instance instance, fmi3FMUState *state) {
    if (state) free(*state), *state = NULL;
    return fmi3OK;
}

FMI3_Export fmi3Status fmi3SerializedFMUStateSize(fmi3Instance instance, fmi3FMUState state, size_t *size) {
    *size = sizeof ((Bogie *)instance)->value;
    return fmi3OK;
}

FMI3_Export fmi3Status fmi3SerializeFMUState(fmi3Instance instance, fmi3FMUState state, fmi3Byte bytes[], size_t size) {
    Bogie *bogie = instance;
    if (size != sizeof bogie->value) return wrong(bogie, "a state has %zu bytes, not %zu", sizeof bogie->value, size);
    memcpy(bytes, state, size);
    return fmi3OK;
}

FMI3_Export fmi3Status fmi3DeserializeFMUState(fmi3Instance instance, const fmi3Byte bytes[], size_t size,
                                               fmi3FMUState *state) {
    Bogie *bogie = instance;
    if (size != sizeof bogie->value) return wrong(bogie, "a state has %zu bytes, not %zu", sizeof bogie->value, size);
    if (!*state && !(*state = malloc(size))) return wrong(bogie, "out of memory");
    memcpy(*state, bytes, size);
    return fmi3OK;
}

/* What FMI has and this unit does not: other types, clocks, co-simulation, scheduled execution */

#define ABSENT(name, ...) \
    FMI3_Export fmi3Status name(fmi3Instance i, __VA_ARGS__) { return wrong(i, #name " is not provided"); }
#define ABSENT_TYPE(type) \
    ABSENT(fmi3Get##type, References r, size_t n, fmi3##type v[], size_t m) \
    ABSENT(fmi3Set##type, References r, size_t n, const fmi3##type v[], size_t m)

ABSENT_TYPE(Float32)
ABSENT_TYPE(Int8)
ABSENT_TYPE(UInt8)
ABSENT_TYPE(Int16)
ABSENT_TYPE(UInt16)
ABSENT_TYPE(Int32)
ABSENT_TYPE(UInt32)
ABSENT_TYPE(Int64)
ABSENT_TYPE(UInt64)
ABSENT_TYPE(Boolean)
ABSENT_TYPE(String)
ABSENT(fmi3GetBinary, References r, size_t n, size_t sizes[], fmi3Binary v[], size_t m)
ABSENT(fmi3SetBinary, References r, size_t n, const size_t sizes[], const fmi3Binary v[], size_t m)
ABSENT(fmi3GetClock, References r, size_t n, fmi3Clock v[])
ABSENT(fmi3SetClock, References r, size_t n, const fmi3Clock v[])
ABSENT(fmi3GetNumberOfVariableDependencies, fmi3ValueReference r, size_t *n)
ABSENT(fmi3GetVariableDependencies, fmi3ValueReference r, size_t of[], fmi3ValueReference on[], size_t elements[],
       fmi3DependencyKind kinds[], size_t n)
ABSENT(fmi3GetAdjointDerivative, References u, size_t n_u, References k, size_t n_k, const fmi3Float64 s[], size_t n_s,
       fmi3Float64 d[], size_t n_d)
ABSENT(fmi3GetIntervalDecimal, References r, size_t n, fmi3Float64 v[], fmi3IntervalQualifier q[])
ABSENT(fmi3GetIntervalFraction, References r, size_t n, fmi3UInt64 c[], fmi3UInt64 d[], fmi3IntervalQualifier q[])
ABSENT(fmi3GetShiftDecimal, References r, size_t n, fmi3Float64 v[])
ABSENT(fmi3GetShiftFraction, References r, size_t n, fmi3UInt64 c[], fmi3UInt64 d[])
ABSENT(fmi3SetIntervalDecimal, References r, size_t n, const fmi3Float64 v[])
ABSENT(fmi3SetIntervalFraction, References r, size_t n, const fmi3UInt64 c[], const fmi3UInt64 d[])
ABSENT(fmi3SetShiftDecimal, References r, size_t n, const fmi3Float64 v[])
ABSENT(fmi3SetShiftFraction, References r, size_t n, const fmi3UInt64 c[], const fmi3UInt64 d[])
ABSENT(fmi3GetOutputDerivatives, References r, size_t n, const fmi3Int32 orders[], fmi3Float64 v[], size_t m)
ABSENT(fmi3DoStep, fmi3Float64 t, fmi3Float64 h, fmi3Boolean b, fmi3Boolean *e, fmi3Boolean *s, fmi3Boolean *r,
       fmi3Float64 *last)
ABSENT(fmi3ActivateModelPartition, fmi3ValueReference r, fmi3Float64 t)

#define ABSENT_MODE(name) \
    FMI3_Export fmi3Status name(fmi3Instance i) { return wrong(i, #name " is not provided"); }
ABSENT_MODE(fmi3EnterConfigurationMode)
ABSENT_MODE(fmi3ExitConfigurationMode)
ABSENT_MODE(fmi3EnterStepMode)

FMI3_Export fmi3Instance fmi3InstantiateCoSimulation(
    fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible, fmi3Boolean logging,
    fmi3Boolean event_mode, fmi3Boolean early_return, const fmi3ValueReference intermediate[], size_t n,
    fmi3InstanceEnvironment environment, fmi3LogMessageCallback log, fmi3IntermediateUpdateCallback update) {
    return NULL;
}

FMI3_Export fmi3Instance fmi3InstantiateScheduledExecution(
    fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible, fmi3Boolean logging,
    fmi3InstanceEnvironment environment, fmi3LogMessageCallback log, fmi3ClockUpdateCallback update,
    fmi3LockPreemptionCallback lock, fmi3UnlockPreemptionCallback unlock) {
    return NULL;
}
