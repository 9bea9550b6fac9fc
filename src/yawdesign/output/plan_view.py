"""A bogie seen from above: what its bodies look like, and where a mode puts them."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from yawdesign.problem import ProblemError, format_quantity
from yawdesign.problem.diagnostics import unknown_key

if TYPE_CHECKING:
    from yawdesign.response.modes.named_modes import Modes, NamedMode

Corner = tuple[float, float]
Outlines = Callable[[Mapping[str, float]], tuple[tuple[Corner, ...], ...]]
AMPLITUDE = 0.16  # drawn size of the largest displacement, relative to the half wheelbase
COLOURS = {"frame": "#4c72b0", "wheelset": "#555555", "motor": "#dd8452"}
REST = "#c8ccd2"


@dataclass(frozen=True)
class Body:
    """One body in plan view.

    Parameters
    ----------
    kind : {"frame", "wheelset", "motor"}
        What it is.
    x : float
        Its centre of mass along the track [m], forward.
    outlines : tuple of tuple of (x, y)
        Polygons [m] about the centre of mass; y is to the left.
    y, phi : complex
        Lateral displacement [m] and yaw [rad] as drawn; their real parts at phase zero.
    """

    kind: str
    x: float
    outlines: tuple[tuple[Corner, ...], ...]
    y: complex
    phi: complex


def box(x: float, y: float, half_length: float, half_width: float) -> tuple[Corner, ...]:
    """Return the corners of a rectangle about (x, y) [m]."""
    return tuple((x + i * half_length, y + j * half_width) for i, j in ((1, 1), (-1, 1), (-1, -1), (1, -1)))


def find_mode(result: "Modes", name: str | None) -> "NamedMode":
    """Return the mode with a name, the least damped one if none is given."""
    if name is None:
        return result.modes[0]
    named = {mode.name: mode for mode in result.modes}
    if name not in named:
        raise ProblemError(f"mode {name!r} {unknown_key(name, tuple(named))}; modes: {', '.join(named)}")
    return named[name]


def bodies(result: "Modes", mode: "NamedMode") -> tuple[Body, ...]:
    """Return the bodies of a vehicle, moved as in a mode, the last on top; one without an outline here is not drawn."""
    p, size = result.parameters, AMPLITUDE * result.parameters["a"]
    shape = {x: size * value for x, value in mode.shape.items()}
    return tuple(
        Body(kind, x, outlines(p), shape.get(f"y_{body}", 0j), shape.get(f"phi_{body}", 0j))
        for body, kind, x, outlines in _drawn(p)
        if {f"y_{body}", f"phi_{body}"} & set(shape)
    )


def _drawn(p: Mapping[str, float]) -> tuple[tuple[str, str, float, Outlines], ...]:
    """Return what is known here: a body's name in coordinates, its kind, its place [m] and its outlines."""
    a, a_0 = p["a"], p.get("a_0", 0.0)
    wheelsets = ("w1", "wheelset", a, _wheelset), ("w2", "wheelset", -a, _wheelset)
    motors = ("m1", "motor", a_0, _motor), ("m2", "motor", -a_0, _motor)
    return (*wheelsets, *motors, ("b", "frame", 0.0, _frame))


def _wheelset(p: Mapping[str, float]) -> tuple[tuple[Corner, ...], ...]:
    axle = box(0, 0, 0.07, max(p["b"], p["b_1"]) + 0.1)
    return (axle, *(box(0, side * p["b"], 0.8 * p["r"], 0.065) for side in (1, -1)))


def _motor(p: Mapping[str, float]) -> tuple[tuple[Corner, ...], ...]:
    length = max(0.08, min(0.28, 0.45 * abs(p["a"] - p["a_0"]) + 0.05, 0.45 * p["a_0"]))
    return (box(0, 0, length, 0.55 * p["b"]),)


def _frame(p: Mapping[str, float]) -> tuple[tuple[Corner, ...], ...]:
    beams = [box(0, side * p["b_1"], p["a"] + 0.3, 0.09) for side in (1, -1)]
    return (*beams, box(0, 0, 0.12, p["b_1"] - 0.09))


def half_size(result: "Modes") -> Corner:
    """Return half the length and half the width of what a picture must show [m]."""
    p = result.parameters
    return p["a"] + 1.1 * p["r"] + 0.25, max(p["b"], p["b_1"]) + 0.55


def caption(mode: "NamedMode") -> str:
    """Return what a mode is, in one line."""
    if mode.frequency == 0:
        return f"{mode.name}: no oscillation, decay rate {mode.decay_rate:.3g} 1/s"
    return f"{mode.name}: {mode.frequency:.3g} Hz, damping ratio {100 * mode.damping_ratio:.3g} %"


def subtitle(result: "Modes") -> str:
    """Return the operating point, in one line."""
    return f"{format_quantity(result.speed, 'km/h', 4)}, C_s = {format_quantity(result.C_s, 'kN·s/m', 4)}"
