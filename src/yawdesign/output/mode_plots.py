"""Pictures of modes: a shape in plan view, the root locus, damping or frequency along a parameter."""

import cmath
import math
from typing import TYPE_CHECKING, Any

import numpy as np

from yawdesign.output.pictures import new_axes, with_condition
from yawdesign.output.plan_view import (
    COLOURS,
    REST,
    Body,
    bodies,
    caption,
    extent,
    find_mode,
    half_size,
    labels,
    scale_note,
    subtitle,
)
from yawdesign.problem import ProblemError, to_unit
from yawdesign.problem.table import as_choice
from yawdesign.study.axes import ROWS
from yawdesign.vehicle.motions import BOGIES

if TYPE_CHECKING:
    from collections.abc import Mapping

    from matplotlib.axes import Axes

    from yawdesign.response.modes.followed_modes import FollowedModes
    from yawdesign.response.modes.named_modes import Modes

STABLE, UNSTABLE = "#e8f3ea", "#fbeae8"
MOST = 10  # modes of a vehicle in one picture, each with a colour of its own
QUANTITIES = ("root_locus", "damping_ratio", "frequency")


def mode_shape(result: "Modes", ax: "Axes | None" = None, *, mode: str | None = None, phase: float = 0.0) -> "Axes":
    """Draw a mode in plan view over the vehicle at rest; what rolls is drawn from behind too.

    Parameters
    ----------
    result : Modes
        What `yawdesign.modes` returns.
    ax : matplotlib.axes.Axes, optional
        Where to draw.
    mode : str, optional
        Its name; the least damped one if not given.
    phase : float
        Of the cycle [rad]; a mode that does not oscillate has died out to 1.5 % after 2 pi.
    """
    from matplotlib.patches import Polygon

    ax = new_axes(ax)
    chosen, p = find_mode(result, mode), result.parameters
    _track(ax, p)
    factor = cmath.exp(1j * phase) if chosen.frequency else complex(math.exp(-phase / 1.5))
    for body in bodies(result, chosen):
        for outline in body.outlines:
            at_rest = _placed(body, outline, 0j)
            ax.add_patch(Polygon(at_rest, closed=True, fill=False, edgecolor=REST, linewidth=1.0, zorder=1))
            moved, colour = _placed(body, outline, factor), COLOURS[body.kind]
            look = {"facecolor": colour, "alpha": body.opacity, "edgecolor": "black"}
            ax.add_patch(Polygon(moved, closed=True, zorder=2, **look))
    for x, y, text in labels(p):
        ax.text(x, y, text, ha="center", va="center", fontsize="small")
    title = f"{caption(chosen)}\n{subtitle(result)}; {scale_note(p)}"
    ax.set_title(with_condition(title, result.condition), fontsize="medium")
    return ax


def _track(ax: "Axes", p: "Mapping[str, float]") -> None:
    left, right, bottom, top = extent(p)
    end = half_size(p)[0]
    ax.set(xlim=(left, right), ylim=(bottom, top), aspect="equal", xticks=[], yticks=[])
    for side in (1, -1):
        ax.plot([left, end], [side * p["b"]] * 2, color=REST, linewidth=3, zorder=0)
    ax.annotate("", (end - 0.1, bottom + 0.14), (end - 0.8, bottom + 0.14), arrowprops={"arrowstyle": "->"})
    ax.text(end - 0.85, bottom + 0.14, "direction of travel", ha="right", va="center", fontsize="small")


def _placed(body: Body, outline: Any, factor: complex) -> list[tuple[float, float]]:
    x, y = (rest + (shift * factor).real for rest, shift in zip(body.rest, body.shift, strict=True))
    c, s = math.cos(phi := (body.phi * factor).real), math.sin(phi)
    return [(x + c * px - s * py, y + s * px + c * py) for px, py in outline]


def mode_paths(
    result: "FollowedModes",
    ax: "Axes | None" = None,
    *,
    of: str = "root_locus",
    widest: float = 40.0,
    target: float | None = None,
) -> "Axes":
    """Draw followed modes: their root locus, or their damping ratio or frequency over the parameter.

    Parameters
    ----------
    result : FollowedModes
        What `yawdesign.follow_modes` returns.
    ax : matplotlib.axes.Axes, optional
        Where to draw.
    of : {"root_locus", "damping_ratio", "frequency"}
        What to draw.
    widest : float
        Modes that decay faster than this everywhere [1/s] are left out. Of a vehicle with two bogies the ten of
        least damping ratio are drawn, and of two that differ in how the bogies move together the less damped one.
    target : float, optional
        A damping ratio [-] to draw as a line, such as 0.05.
    """
    as_choice(of, QUANTITIES)
    ax = new_axes(ax)
    shown = [k for k in range(len(result.names)) if np.nanmax(result.eigenvalues[:, k].real) > -widest]
    if not shown:
        raise ProblemError(f"all modes decay faster than {widest:g} 1/s: give a larger `widest`")
    shown = _that_matter(result, shown)
    if of == "root_locus":
        return _root_locus(result, ax, shown, widest, target)
    return _over_parameter(result, ax, shown, of, target)


def _that_matter(result: "FollowedModes", shown: list[int]) -> list[int]:
    """Return which modes are drawn: of those that two bogies have alike the less damped ones, and not too many."""
    least = {k: float(np.nanmin(result.damping_ratio[:, k])) for k in shown}
    first: dict[str, int] = {}
    for k in sorted(shown, key=least.__getitem__):
        first.setdefault(_label(result, k), k)
    return shown if len(first) == len(shown) else sorted([*first.values()][:MOST])


def _label(result: "FollowedModes", k: int) -> str:
    """Return the name of a mode without what it says of the bogies."""
    name = result.names[k]
    return next((name.removesuffix(f", {words}") for words in BOGIES.values() if name.endswith(f", {words}")), name)


def axis_in_unit(result: "FollowedModes") -> tuple[np.ndarray[Any, Any], str]:
    """Return the values of the axis as people see them, and its label."""
    row = ROWS[result.axis]
    values = np.array([to_unit(float(value), row.unit) for value in result.values])
    shown = f" [{row.unit}]" if row.unit.strip("-") else ""
    return values, f"{row.meaning}, ${row.symbol}${shown}"


def _is_geometric(values: np.ndarray[Any, Any]) -> bool:
    ratio = values[1:] / values[:-1]
    return bool(np.all(values > 0) and np.allclose(ratio, ratio[0], rtol=1e-6) and abs(np.log(ratio.prod())) > 2)


def _root_locus(result: "FollowedModes", ax: "Axes", shown: list[int], widest: float, target: float | None) -> "Axes":
    from matplotlib.collections import LineCollection
    from matplotlib.colors import LogNorm, Normalize

    values, label = axis_in_unit(result)
    norm = (LogNorm if _is_geometric(values) else Normalize)(values.min(), values.max())
    re, hz = result.eigenvalues.real, result.frequency
    right = max(0.5 * widest, 1.15 * float(np.nanmax(re[:, shown])))  # room for names on the right
    ax.axvspan(-widest, 0, color=STABLE, zorder=0)
    ax.axvspan(0, right, color=UNSTABLE, zorder=0)
    ax.axvline(0, color="0.3", linewidth=1)
    for k in shown:
        points = np.column_stack([re[:, k], hz[:, k]])
        segments = np.stack([points[:-1], points[1:]], axis=1)
        lines = LineCollection(list(segments), cmap="viridis", norm=norm, linewidths=2.2)
        lines.set_array((values[:-1] + values[1:]) / 2)
        ax.add_collection(lines)
        ax.plot(*points[0], "o", color="black", markerfacecolor="white", markersize=5)
        ax.plot(*points[-1], "o", color="black", markersize=4)
    inside = [k for k in shown if np.any((re[:, k] > -widest) & (hz[:, k] > 0))]
    top = 1.12 * float(np.nanmax(hz[:, inside])) if inside else 1.0
    ax.set(xlim=(-widest, right), ylim=(-0.03 * top, top), xlabel="real part [1/s]", ylabel="frequency [Hz]")
    if target is not None:
        ax.plot(
            [0, -widest], [0, widest * math.sqrt(1 / target**2 - 1) / (2 * math.pi)], "--", color="0.4", linewidth=1
        )
    _label_ends(ax, result, inside, top)
    if ax.figure is not None:
        ax.figure.colorbar(lines, ax=ax, label=label)
    for x, text, align in ((-0.5, "stable", "right"), (0.5, "unstable", "left")):
        ax.text(x, 0.98 * top, text, ha=align, va="top", fontsize="small", color="0.4")
    title = with_condition("Root locus: ○ first value, ● last value", result.condition)
    ax.set_title(title, fontsize="medium")
    return ax


def _label_ends(ax: "Axes", result: "FollowedModes", inside: list[int], top: float) -> None:
    """Write the names beside the ends of the paths; where these are crowded, in a column on the right."""
    left, right = ax.get_xlim()
    ends = {}
    for k in inside:
        last = np.flatnonzero(result.eigenvalues[:, k].real > left)[-1]
        ends[k] = (float(result.eigenvalues[last, k].real), float(result.frequency[last, k]))
    height = 0.0
    for k in sorted(ends, key=lambda k: (ends[k][1], ends[k][0])):
        x, y = ends[k]
        near = [
            k != m and abs(x - far) < 0.3 * (right - left) and abs(y - up) < 0.08 * top for m, (far, up) in ends.items()
        ]
        if not any(near):
            ax.annotate(_label(result, k), (x, y), (8, 0), textcoords="offset points", fontsize="x-small", va="center")
            continue
        height = max(height, y - 0.05 * top)
        line = {"arrowstyle": "-", "color": "0.5", "linewidth": 0.6}
        ax.annotate(_label(result, k), (x, y), (0.06 * right, height), fontsize="x-small", va="center", arrowprops=line)
        height += 0.05 * top


def _over_parameter(result: "FollowedModes", ax: "Axes", shown: list[int], of: str, target: float | None) -> "Axes":
    values, label = axis_in_unit(result)
    waving = [k for k in shown if np.any(result.frequency[:, k] > 0)]
    for k in waving:
        y = result.frequency[:, k] if of == "frequency" else 100 * result.damping_ratio[:, k]
        ax.plot(values, np.where(result.frequency[:, k] > 0, y, np.nan), linewidth=1.8, label=_label(result, k))
    if of == "damping_ratio":
        _shade_unstable(ax, result, waving)
        if target is not None:
            ax.axhline(100 * target, color="0.3", linestyle="--", linewidth=1, label=f"target {100 * target:g} %")
    ax.set(xlabel=label, ylabel="frequency [Hz]" if of == "frequency" else "damping ratio [%]")
    ax.set_xlim(min(values), max(values))
    if _is_geometric(values):
        ax.set_xscale("log")
    ax.grid(alpha=0.3)
    ax.set_title(with_condition("", result.condition), fontsize="medium")
    ax.legend(fontsize="small", loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    return ax


def _shade_unstable(ax: "Axes", result: "FollowedModes", waving: list[int]) -> None:
    least = 100 * float(np.nanmin(result.damping_ratio[:, waving]))
    bottom = min(-2.0, 1.3 * least)
    ax.axhspan(bottom, 0, color=UNSTABLE, zorder=0)
    ax.axhline(0, color="0.3", linewidth=1)
    ax.set_ylim(bottom, min(60.0, 1.05 * 100 * float(np.nanmax(result.damping_ratio[:, waving]))))
    ax.text(0.99, 0.01, "unstable", transform=ax.transAxes, ha="right", va="bottom", fontsize="small", color="0.4")
