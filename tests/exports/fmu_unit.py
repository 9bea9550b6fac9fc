"""One instance of an FMU, for calls of single functions."""

import ctypes

import fmpy
import numpy as np
from fmpy.fmi3 import FMU3Model


class Unit:
    """One instance of an FMU, for calls of single functions."""

    def __init__(self, path, folder):
        description = fmpy.read_model_description(path)
        self.fmu = FMU3Model(
            guid=description.instantiationToken,
            unzipDirectory=fmpy.extract(path, folder),
            modelIdentifier=description.modelExchange.modelIdentifier,
            instanceName="bogie",
        )
        self.fmu.instantiate()
        self.references = {variable.name: variable.valueReference for variable in description.modelVariables}
        self.states = [v.variable.derivative.name for v in description.derivatives]

    def set(self, values):
        self.fmu.setFloat64([self.references[name] for name in values], list(values.values()))

    def get(self, *names):
        return self.fmu.getFloat64([self.references[name] for name in names])

    def derivatives(self, x, t=0.0):
        n = len(x)
        derivatives = (ctypes.c_double * n)()
        self.fmu.setTime(t)
        self.fmu.setContinuousStates((ctypes.c_double * n)(*x), n)
        self.fmu.getContinuousStateDerivatives(derivatives, n)
        return np.array(derivatives)
