"""What responses and bodies are called in pictures and tables, and in which units people read them."""

from yawdesign.vehicle.elements import parted
from yawdesign.vehicle.signals import BOGIES, DIRECTIONS, ENDS

# SI unit -> (factor, unit shown).
SHOWN = {
    "m": (1e3, "mm"),
    "rad": (1e3, "mrad"),
    "m/s": (1e3, "mm/s"),
    "rad/s": (1e3, "mrad/s"),
    "m/s^2": (1.0, "m/s²"),
    "rad/s^2": (1.0, "rad/s²"),
    "N": (1e-3, "kN"),
}
BODIES = {"b": "frame", "w": "wheelset", "m": "motor", "c": "car body"}


def meaning(name: str) -> str:
    """Return what a response is called, such as "lateral acceleration of the frame"."""
    direction, body, *rate = name.split("_")
    part, ends = parted(body)
    if direction in DIRECTIONS and part in BODIES:
        what = f"{DIRECTIONS[direction]} {rate[0] if rate else 'displacement'} of the"
        bogie, end = _ends(ends, of_bogie=part in "bc")
        where = f"{'above' if part == 'c' else 'of'} the {bogie} bogie" if bogie else ""
        return " ".join(filter(None, (what, end, BODIES[part], where)))
    stem, ends = parted(name)
    bogie, end = _ends(ends, of_bogie=stem.startswith("yaw_damper"))
    where = ", ".join(filter(None, (end, bogie and f"{bogie} bogie")))
    return stem.strip("_").replace("_", " ") + (f" ({where})" if where else "")


def body_name(body: str) -> str:
    """Return what a body is called whose coordinates end with some letters.

    Examples
    --------
    >>> body_name("w12"), body_name("b")
    ('rear wheelset, leading', 'frame')
    """
    part, ends = parted(body)
    bogie, end = _ends(ends, of_bogie=part in "bc")
    name = f"{end} {BODIES.get(part, part)}".strip()
    return f"{name}, {bogie}" if bogie else name


def _ends(ends: str, *, of_bogie: bool) -> tuple[str, str]:
    """Return which bogie and which end of it the digits behind a name mean; one digit is the bogie or the end."""
    bogie, end = (ends[:1], ends[1:]) if of_bogie or len(ends) > 1 else ("", ends)
    return BOGIES.get(bogie, ""), ENDS.get(end, "")
