"""What tracks are made of: harmonics and instants, and when each wheelset comes to which place."""

from dataclasses import dataclass

import numpy as np

from yawdesign.hunting.arrays import Complex, Float
from yawdesign.problem.table import Parameter

INPUTS = ("alignment", "cross_level")  # what varies along a track [m], [rad]
WAVELENGTH = Parameter(
    key="wavelength",
    symbol="L",
    unit="m",
    meaning="wavelength of the track",
    hard=(1e-3, 1e9),
    usual=(1.0, 200.0),
    source="20",
)
MOST_STEPS = 5_000_000  # of one run


@dataclass(frozen=True)
class Clock:
    """Instants of a run: 0, step, ..., steps * step [s]."""

    step: float
    steps: int

    @property
    def time(self) -> Float:
        """All instants [s]."""
        return np.asarray(self.step * np.arange(self.steps + 1), dtype=float)


@dataclass(frozen=True, eq=False)
class Lines:
    """Inputs as a sum of harmonics: u(t) = sum of Re(amplitudes[n] exp(j omega[n] t)).

    Parameters
    ----------
    omega : ndarray, shape (m,)
        Angular frequencies [rad/s].
    amplitudes : ndarray, shape (m, inputs)
        Of alignment [m] and cross-level [rad] at the first wheelset, then at the second one, and so on.
    """

    omega: Float
    amplitudes: Complex


@dataclass(frozen=True)
class Wheelsets:
    """When the wheelsets of a vehicle pass a place of the track.

    Parameters
    ----------
    v : float
        Speed [m/s].
    lags : tuple of float
        How much later than the first wheelset each of them comes [s]; 0 for the first.
    width : float
        Distance of the contact points of a wheelset [m].
    """

    v: float
    lags: tuple[float, ...]
    width: float

    def passing(self, omega: Float, first: Complex) -> Complex:
        """Return the amplitudes at all wheelsets of a track that has given ones at the first.

        Parameters
        ----------
        omega : ndarray, shape (m,)
            Angular frequencies [rad/s].
        first : ndarray, shape (m, 2)
            Alignment [m] and cross-level [rad] at the first wheelset.

        Returns
        -------
        ndarray, shape (m, inputs)
        """
        return np.hstack([first * np.exp(-1j * omega * lag)[:, None] for lag in self.lags])

    def harmonic(self, omega: Float, name: str) -> Complex:
        """Return the amplitudes at all wheelsets of a track of amplitude 1, shape (m, inputs).

        Parameters
        ----------
        omega : ndarray, shape (m,)
            Angular frequencies [rad/s].
        name : {"alignment", "cross_level"}
            What varies [m], [rad].
        """
        first = np.zeros((len(omega), len(INPUTS)), dtype=complex)
        first[:, INPUTS.index(name)] = 1
        return self.passing(omega, first)


def synthesise(lines: Lines, clock: Clock) -> Float:
    """Return the inputs of lines at multiples of 1 / (steps * step) Hz, at all instants, shape (steps + 1, inputs)."""
    spectrum = np.zeros((clock.steps // 2 + 1, lines.amplitudes.shape[1]), dtype=complex)
    places = np.rint(lines.omega / (2 * np.pi) * clock.steps * clock.step).astype(int)
    spectrum[places] = lines.amplitudes * clock.steps / 2
    u = np.fft.irfft(spectrum, clock.steps, axis=0)
    return np.vstack([u, u[:1]])
