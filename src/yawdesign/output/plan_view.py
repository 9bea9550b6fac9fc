"""A vehicle seen from above, and from behind if it rolls: what its bodies look like, and where a mode puts them."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from yawdesign.output.minus import with_minus
from yawdesign.output.pictures import quantity
from yawdesign.output.style import CHOSEN, LIMIT, SERIES
from yawdesign.problem import format_quantity

if TYPE_CHECKING:
    from yawdesign.response.modes.named_modes import Modes, NamedMode

Corner = tuple[float, float]
Outlines = Callable[[Mapping[str, float]], tuple[tuple[Corner, ...], ...]]
AMPLITUDE = 0.16  # drawn size of the largest displacement, relative to the half wheelbase
# From light to dark in grey print, too: car body, motor, frame, wheelset, yaw damper.
COLOURS = {"car body": SERIES[2], "motor": SERIES[1], "frame": CHOSEN, "wheelset": SERIES[4], "yaw damper": LIMIT}
OPACITY = {"car body": 0.18, "motor": 0.6}
SOLID = 0.8
APART = 2.2  # half the drawn distance of the bogie centres at most, in half wheelbases: car bodies are long
DAMPER, BESIDE = 0.5, 0.22  # half the drawn length of a yaw damper, and how far from the frame's beams it is seen [m]
SPRINGS, FLOOR, ROOF = 0.35, 0.1, 2.6  # springs above the axle; floor and roof of the car body above them [m]


@dataclass(frozen=True)
class Body:
    """One body as drawn, in plan view or seen from behind.

    Parameters
    ----------
    kind : {"frame", "wheelset", "motor", "car body", "yaw damper"}
        What it is, or what the part of a damper belongs to that moves with it.
    x : float
        Where its centre of mass is at rest on the drawing, to the right [m]: along the track, forward, in plan view.
    outlines : tuple of tuple of (x, y)
        Polygons [m] about the centre of mass; in plan view y is to the left.
    y, phi : complex
        Lateral displacement [m] and yaw, or roll seen from behind, [rad] as drawn; their real parts at phase zero.
    height : float, optional
        Where the centre of mass is at rest on the drawing, upwards [m], of a body seen from behind.
    """

    kind: str
    x: float
    outlines: tuple[tuple[Corner, ...], ...]
    y: complex
    phi: complex
    height: float | None = None

    @property
    def rest(self) -> Corner:
        """Where its centre of mass is at rest on the drawing [m]."""
        return self.x, self.height or 0.0

    @property
    def shift(self) -> tuple[complex, complex]:
        """By how much it moves on the drawing, to the right and upwards [m]."""
        return (0j, self.y) if self.height is None else (-self.y, 0j)

    @property
    def opacity(self) -> float:
        """Of its colour."""
        return OPACITY.get(self.kind, SOLID)


def box(x: float, y: float, half_length: float, half_width: float) -> tuple[Corner, ...]:
    """Return the corners of a rectangle about (x, y) [m]."""
    return tuple((x + i * half_length, y + j * half_width) for i, j in ((1, 1), (-1, 1), (-1, -1), (1, -1)))


def find_mode(result: "Modes", name: str | None) -> "NamedMode":
    """Return the mode with a name, the one of least decay rate if none is given."""
    return result[0 if name is None else name]


def bodies(result: "Modes", mode: "NamedMode") -> tuple[Body, ...]:
    """Return the bodies of a vehicle, moved as in a mode, the last on top; one without an outline here is not drawn."""
    p, size = result.parameters, AMPLITUDE * result.parameters["a"]
    shape = {x: size * value for x, value in mode.shape.items()}
    plan = tuple(
        Body(kind, x, outlines(p), shape.get(f"y_{body}", 0j), shape.get(f"phi_{body}", 0j))
        for body, kind, x, outlines in _drawn(p)
        if {f"y_{body}", f"phi_{body}"} & set(shape)
    )
    return (*plan, *_car_body(p, shape), *_yaw_dampers(result, shape), *_from_behind(p, shape))


def _bogies(p: Mapping[str, float]) -> tuple[tuple[str, float], ...]:
    """Return each bogie's end in the names of coordinates, and its place in the drawing [m]."""
    return (("1", _centre(p)), ("2", -_centre(p))) if "l_c" in p else (("", 0.0),)


def _centre(p: Mapping[str, float]) -> float:
    """Return half the drawn distance of the bogie centres [m]."""
    return max(min(p["l_c"], APART * p["a"]), 1.3 * p["a"])


def _drawn(p: Mapping[str, float]) -> Iterator[tuple[str, str, float, Outlines]]:
    """Yield what is known here: a body's name in coordinates, its kind, its place [m] and its outlines."""
    a, a_0 = p["a"], p.get("a_0", 0.0)
    for bogie, x in _bogies(p):
        yield from ((f"w{bogie}{k}", "wheelset", x + place, _wheelset) for k, place in ((1, a), (2, -a)))
        yield from ((f"m{bogie}{k}", "motor", x + place, _motor) for k, place in ((1, a_0), (2, -a_0)))
        yield f"b{bogie}", "frame", x, _frame


def _car_body(p: Mapping[str, float], shape: Mapping[str, complex]) -> Iterator[Body]:
    """Yield the car body at the height of the secondary springs, where the bogies carry it."""
    if "l_c" in p:
        outline = box(0, 0, _centre(p) + p["a"] + 0.6, _half_width(p))
        yield Body("car body", 0.0, (outline,), *_floor(p, shape))


def _floor(p: Mapping[str, float], shape: Mapping[str, complex]) -> tuple[complex, complex]:
    """Return how the car body moves where the bogies carry it, and by how much it turns on the drawing.

    Over the bogies it moves as it does; as these are drawn nearer together, it turns by more.
    """
    if "l_c" not in p:
        return 0j, 0j
    return shape["y_c"] + p["h_s"] * shape["th_c"], shape["psi_c"] * p["l_c"] / _centre(p)


def _yaw_dampers(result: "Modes", shape: Mapping[str, complex]) -> Iterator[Body]:
    """Yield the yaw dampers in two parts: rods that move with the frames, cylinders that move with the car body."""
    p = result.parameters
    if not result.C_s:
        return
    side = max(p["b_3"], p["b_1"] + BESIDE)
    rods, cylinders = [], []
    for s in (1, -1):
        bracket = box(-DAMPER, s * (p["b_1"] + side) / 2, 0.05, (side - p["b_1"]) / 2 + 0.05)
        rods += [bracket, box(-0.4 * DAMPER, s * side, 0.6 * DAMPER, 0.02)]
        cylinders += [box(0.35 * DAMPER, s * side, 0.6 * DAMPER, 0.06), box(DAMPER, s * side, 0.05, 0.1)]
    y, psi = _floor(p, shape)
    for bogie, x in _bogies(p):
        yield Body("yaw damper", x, tuple(rods), shape.get(f"y_b{bogie}", 0j), shape.get(f"phi_b{bogie}", 0j))
        yield Body("yaw damper", x, tuple(cylinders), y + x * psi, psi)


def _from_behind(p: Mapping[str, float], shape: Mapping[str, complex]) -> Iterator[Body]:
    """Yield the leading bogie, or the only one, and the car body over it, seen from behind."""
    if not rolls(p):
        return
    (bogie, _), *_ = _bogies(p)
    x, ground = _end_view(p), -half_size(p)[1] + 0.5
    axle = ground + p["r"]
    # Its angles are drawn to the left, which is counted upwards in plan view.
    wheels = (box(0, 0, max(p["b"], p["b_1"]) + 0.1, 0.07), *(box(s * p["b"], 0, 0.065, p["r"]) for s in (1, -1)))
    yield Body("wheelset", x, wheels, shape[f"y_w{bogie}1"], 0j, axle)
    frame = (box(0, 0, p["b_1"] + 0.09, 0.09),)
    yield Body("frame", x, frame, shape[f"y_b{bogie}"], -shape.get(f"th_b{bogie}", 0j), axle + 0.15)
    if "l_c" in p:
        low, high = FLOOR - p["h_s"], ROOF - p["h_s"]
        body = (box(0, (low + high) / 2, _half_width(p), (high - low) / 2),)
        over = shape["y_c"] + p["l_c"] * shape["psi_c"]
        yield Body("car body", x, body, over, -shape["th_c"], axle + SPRINGS + p["h_s"])


def rolls(p: Mapping[str, float]) -> bool:
    """Return whether something rolls, so that the vehicle is drawn from behind too."""
    return "I_c" in p or "I_b" in p


def _end_view(p: Mapping[str, float]) -> float:
    """Return where the vehicle seen from behind stands [m]."""
    return half_size(p)[0] + _half_width(p) + 0.55


def _half_width(p: Mapping[str, float]) -> float:
    return max(p["b"], p["b_1"], p["b_3"] - BESIDE) + 0.4


def _wheelset(p: Mapping[str, float]) -> tuple[tuple[Corner, ...], ...]:
    axle = box(0, 0, 0.07, max(p["b"], p["b_1"]) + 0.1)
    return (axle, *(box(0, side * p["b"], 0.8 * p["r"], 0.065) for side in (1, -1)))


def _motor(p: Mapping[str, float]) -> tuple[tuple[Corner, ...], ...]:
    length = max(0.08, min(0.28, 0.45 * abs(p["a"] - p["a_0"]) + 0.05, 0.45 * p["a_0"]))
    return (box(0, 0, length, 0.55 * p["b"]),)


def _frame(p: Mapping[str, float]) -> tuple[tuple[Corner, ...], ...]:
    beams = [box(0, side * p["b_1"], p["a"] + 0.3, 0.09) for side in (1, -1)]
    return (*beams, box(0, 0, 0.12, p["b_1"] - 0.09))


def half_size(p: Mapping[str, float]) -> Corner:
    """Return half the length and half the height of what the plan view must show [m]."""
    width = max(p["b"], p["b_1"], p["b_3"] - BESIDE) + 0.68
    length = p["a"] + 1.1 * p["r"] + 0.25
    if "l_c" in p:
        return length + _centre(p), max(width + 0.2, (p["r"] + SPRINGS + ROOF) / 2 + 0.6)
    return length, width


def extent(p: Mapping[str, float]) -> tuple[float, float, float, float]:
    """Return what a picture must show: left, right, bottom, top [m]."""
    length, width = half_size(p)
    right = _end_view(p) + _half_width(p) + 0.5 if rolls(p) else length
    return -length, right, -width, width


def labels(p: Mapping[str, float]) -> Iterator[tuple[float, float, str]]:
    """Yield what is written into a picture of more than one view, and where [m]."""
    if rolls(p):
        width, ends = half_size(p)[1], _bogies(p)
        yield _end_view(p), -width + 0.14, "leading bogie from behind" if len(ends) > 1 else "from behind"


def caption(mode: "NamedMode") -> str:
    """Return what a mode is, in one line."""
    if mode.frequency == 0:
        return with_minus(f"{mode.name}: no oscillation, decay rate {mode.decay_rate:.3g} 1/s")
    return with_minus(f"{mode.name}: {mode.frequency:.3g} Hz, damping ratio {100 * mode.damping_ratio:.3g} %")


def subtitle(result: "Modes") -> str:
    """Return the operating point, in one line."""
    return f"{format_quantity(result.speed, 'km/h', 4)}, {quantity('C_s', result.C_s)}"


def scale_note(p: Mapping[str, float]) -> str:
    """Return what is not to scale."""
    shortened = "l_c" in p and _centre(p) < p["l_c"]
    return "amplitude and distance of the bogies not to scale" if shortened else "amplitude not to scale"
