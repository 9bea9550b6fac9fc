"""Spectra of track irregularity: one-sided densities over the wavenumber W = 2 pi / wavelength [rad/m]."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np

from yawdesign.hunting.arrays import Float
from yawdesign.problem import ProblemError
from yawdesign.problem.arguments import checked
from yawdesign.problem.diagnostics import Mistakes, unknown_key
from yawdesign.response.track.text_columns import number

Density = Callable[[Float], Float]


@checked
@dataclass(frozen=True, eq=False)
class Spectrum:
    """Irregularity of a track as densities over the wavenumber.

    Parameters
    ----------
    name : str
        What it is called in results.
    densities : mapping of str to callable
        Of "alignment" [m^2/(rad/m)] and, where it is known, "cross_level" [rad^2/(rad/m)], each a function of an array
        of wavenumbers [rad/m]. A density per cycle instead is S_f(f) = 2 pi S_W(2 pi f).
    notes : tuple of str
        What a reader of the results must know.
    """

    name: str
    densities: Mapping[str, Density]
    notes: tuple[str, ...] = ()

    def density(self, which: str, W: Float) -> Float:
        """Return the density at wavenumbers [rad/m]; zero where the spectrum says nothing about it.

        Parameters
        ----------
        which : {"alignment", "cross_level"}
            Which irregularity.
        W : ndarray
            Wavenumbers [rad/m].

        Raises
        ------
        ProblemError
            If the density is negative or not finite somewhere.
        """
        if which not in self.densities:
            return np.zeros_like(W)
        S = np.asarray(self.densities[which](W), dtype=float)
        wrong = np.flatnonzero(~((S >= 0) & np.isfinite(S)))
        if len(wrong):
            where = f"{S[wrong[0]]:g} at {W[wrong[0]]:.4g} rad/m"
            raise ProblemError(f"the {which} density of the spectrum {self.name} must be 0 or more everywhere: {where}")
        return S


def german(
    A_a: float,
    A_v: float,
    W_c: float = 0.8246,
    W_r: float = 0.0206,
    W_s: float = 0.4380,
    b: float = 0.75,
    name: str = "german",
) -> Spectrum:
    """Return a spectrum of the German / ERRI form.

    Alignment ``A_a W_c^2 / ((W^2+W_r^2)(W^2+W_c^2))``, cross-level angle
    ``A_v b^-2 W_c^2 W^2 / ((W^2+W_r^2)(W^2+W_c^2)(W^2+W_s^2))``.

    Parameters
    ----------
    A_a, A_v : float
        Roughness of alignment and of vertical profile [m^2 rad/m].
    W_c, W_r, W_s : float
        Wavenumbers where the slope changes [rad/m].
    b : float
        Half distance of the rails that belongs to the cross-level angle [m].
    name : str
        What it is called in results.

    Examples
    --------
    >>> import numpy as np
    >>> german(2.119e-7, 4.032e-7).density("alignment", np.array([0.1])).round(9)
    array([2.0033e-05])
    """
    _positive({"A_a": A_a, "A_v": A_v}, {"W_c": W_c, "W_r": W_r, "W_s": W_s, "b": b})

    def common(W: Float) -> Float:
        return W_c**2 / ((W**2 + W_r**2) * (W**2 + W_c**2))

    densities = {
        "alignment": lambda W: A_a * common(W),
        "cross_level": lambda W: A_v / b**2 * common(W) * W**2 / (W**2 + W_s**2),
    }
    return Spectrum(name, MappingProxyType(densities))


def fra(A: float, k: float = 0.25, W_c: float = 0.8245, name: str = "fra", notes: tuple[str, ...] = ()) -> Spectrum:
    """Return a spectrum of the AAR / FRA form, ``k A W_c^2 / (W^2 (W^2 + W_c^2))`` for the alignment.

    Parameters
    ----------
    A : float
        Roughness [m^2 rad/m]; tables print cm^2 rad/m, 1e4 times as much.
    k : float
        Factor [-].
    W_c : float
        Wavenumber where the slope changes [rad/m].
    name : str
        What it is called in results.
    notes : tuple of str
        What a reader of the results must know.
    """
    _positive({"A": A}, {"k": k, "W_c": W_c})
    alignment = MappingProxyType({"alignment": lambda W: k * A * W_c**2 / (W**2 * (W**2 + W_c**2))})
    return Spectrum(name, alignment, (NO_CROSS_LEVEL, *notes))


def _positive(not_negative: Mapping[str, float], positive: Mapping[str, float]) -> None:
    mistakes = Mistakes()
    for names, allowed in ((not_negative, "0 or more"), (positive, "more than 0")):
        for name, value in names.items():
            with mistakes.under(name):
                if not (value > 0 or (names is not_negative and value == 0)) or not np.isfinite(value):
                    raise ProblemError(f"{value:g} must be {allowed}")
    mistakes.report()


@dataclass(frozen=True, eq=False)
class Tabulated:
    """A density given at wavenumbers, straight lines between them on doubly logarithmic paper, zero outside.

    Parameters
    ----------
    W, S : ndarray
        Wavenumbers [rad/m], rising, and densities.
    """

    W: Float
    S: Float

    def __call__(self, W: Float) -> Float:
        """Return the density at wavenumbers [rad/m]."""
        if np.any(self.S <= 0):
            return np.asarray(np.interp(W, self.W, self.S, left=0.0, right=0.0))
        inside = (self.W[0] <= W) & (self.W[-1] >= W)
        return np.asarray(np.where(inside, np.exp(np.interp(np.log(W), np.log(self.W), np.log(self.S))), 0.0))


NO_CROSS_LEVEL = "the AAR / FRA spectrum is taken for the alignment alone: the cross-level angle is zero"
UNSURE = "the alignment coefficients of FRA classes 1 to 4 are from memory and were not compared with the standard"
# Alignment roughness of track classes 1 to 6 in cm^2 rad/m.
FRA_ALIGNMENT = (3.3634, 1.2107, 0.4128, 0.3027, 0.0762, 0.0339)
CM2 = 1e-4

SPECTRA: Mapping[str, Spectrum] = MappingProxyType(
    {
        "german-low": german(2.119e-7, 4.032e-7, name="german-low"),
        "german-high": german(6.125e-7, 1.08e-6, name="german-high"),
        **{
            f"fra-{n}": fra(CM2 * A, name=f"fra-{n}", notes=(UNSURE,) if n < 5 else ())
            for n, A in enumerate(FRA_ALIGNMENT, 1)
        },
    }
)
FORMS: Mapping[str, tuple[Callable[..., Spectrum], tuple[str, ...]]] = MappingProxyType(
    {"german": (german, ("A_a", "A_v", "W_c", "W_r", "W_s", "b")), "fra": (fra, ("A", "k", "W_c"))}
)


def form_of(text: str) -> Spectrum:
    """Return the spectrum that a text such as ``german:A_a=2e-7,A_v=4e-7`` describes; coefficients in SI units."""
    form, _, given = text.partition(":")
    make, keys = FORMS[form]
    values: dict[str, Any] = {}
    mistakes = Mistakes()
    pairs = [[piece.strip() for piece in part.split("=", 1)] for part in given.split(",") if part]
    names = [name for name, *_ in pairs]
    for k, (key, *value) in enumerate(pairs):
        with mistakes.under(key):
            if key not in keys:
                raise ProblemError(unknown_key(key, keys))
            if key in names[:k]:
                raise ProblemError("stands twice")
            values[key] = number("".join(value))
    for key in ("A_a", "A_v") if form == "german" else ("A",):
        with mistakes.under(key):
            if key not in names:
                raise ProblemError(f"is missing: write such as {form}:{key}=2e-7")
    mistakes.report()
    return make(**values, name=text)
