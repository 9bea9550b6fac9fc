"""Values of inputs that are no parameters: a start of the critical damping, and factors of the polynomial."""

from dataclasses import dataclass

import numpy as np

from yawdesign.exports.ports import Setting
from yawdesign.hunting.old import core_eigenvalues, critical_damping
from yawdesign.hunting.routh import TIME_UNIT

NOWHERE = 1e5, 20.0  # [N s/m], [rad/s]: where a bogie has no critical value, any start is as good


def start_of_critical_damping(setting: Setting) -> tuple[float, float]:
    """Return (C_s, omega) near the least critical value of the problem's bogie."""
    p = {name: setting.examples[name] for name in setting.bogie}
    found = critical_damping(p, **setting.model).critical
    return (1.02 * found[0].C_s, 0.99 * found[0].omega) if found else NOWHERE


@dataclass(frozen=True)
class Factors:
    """Quadratic factors s^2 + p s + q and, if the degree is odd, a linear one s + r, in s / (100 rad/s)."""

    p: tuple[float, ...]
    q: tuple[float, ...]
    r: tuple[float, ...]


def quadratic_factors(setting: Setting) -> Factors:
    """Return the factors of the coupled motion's polynomial with the problem's values."""
    values = setting.examples
    s = core_eigenvalues({name: values[name] for name in setting.bogie}, values["C_s"], **setting.model) / TIME_UNIT
    upper, real = s[s.imag > 0], np.sort(s.real[s.imag == 0])[::-1]
    odd, real = (real[:1], real[1:]) if len(real) % 2 else (real[:0], real)
    p = [*(-2 * upper.real), *(-(real[::2] + real[1::2]))]
    q = [*(np.abs(upper) ** 2), *(real[::2] * real[1::2])]
    return Factors(tuple(map(float, p)), tuple(map(float, q)), tuple(float(-x) for x in odd))
