"""The functions for other codes, one builder each: from the generic code of the rooms before, fed with symbols."""

import math
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any, cast

import casadi as ca
import numpy as np

from yawdesign.bogie.assembly import StateSpace, physical
from yawdesign.bogie.characteristic import characteristic, paper_coefficients
from yawdesign.bogie.elements import Maxwell
from yawdesign.bogie.polynomials import Polynomial, product, scale_variable, shift, trim
from yawdesign.bogie.vehicles import bogie
from yawdesign.design.curving import LOADS, curving_limit, resisting_moment, rotational_resistance
from yawdesign.design.draft import Draft, Setting
from yawdesign.problem import Curve, ProblemError
from yawdesign.problem.running import CURVE
from yawdesign.stability import graphs
from yawdesign.stability.critical import CriticalValue
from yawdesign.stability.critical import critical_damping as all_critical_values
from yawdesign.stability.hurwitz import hurwitz_minors as generic_minors
from yawdesign.stability.modes import core_eigenvalues
from yawdesign.stability.routh import TIME_UNIT, routh_column, sector_column

COEFFICIENT = "scaled"
FASTER = (1.0, 1.25, 1.5, 2.0, 3.0)  # where a bogie is stable for every C_s, its critical damping is sought at v times this


def _all(draft: Draft) -> tuple[dict[str, Any], Any]:
    p = draft.parameters(draft.setting.bogie)
    return p, draft.parameters(["C_s"])["C_s"]


def _core(draft: Draft) -> tuple[Polynomial, Any]:
    """Return the coupled motion's polynomial in s / (100 rad/s), without powers that are known not to be there."""
    p, C_s = _all(draft)
    core = scale_variable(characteristic(p, **draft.setting.model).core(C_s), TIME_UNIT)
    return trim(core, lambda a: isinstance(a, (int, float)) and a == 0), C_s
