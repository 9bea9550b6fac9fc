"""Pictures of a forward design and of an optimum."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from yawdesign.damper.status import Status
from yawdesign.output.condition_texts import condition_text
from yawdesign.output.pictures import LINE, legend_below, literal, new_axes, under_conditions
from yawdesign.output.style import BECOMES, STABLE, UNSTABLE
from yawdesign.output.tables import critical_shown, margin
from yawdesign.problem import PARAMETERS, ProblemError, format_quantity, to_unit

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from yawdesign.damper.forward import Critical, ForwardDesign
    from yawdesign.damper.optimum import Optimum

DAMPING = to_unit(1.0, "kN·s/m")
BESIDE_NAMES = 55  # signs of a title above a picture that has names of conditions on its left


def draw_design(result: "ForwardDesign", ax: "Axes | None" = None) -> "Axes":
    """Draw the stable intervals of the yaw damping, its critical values, the curve's limit and the choice.

    Parameters
    ----------
    result : ForwardDesign
        Of `yawdesign.design`.
    ax : matplotlib.axes.Axes, optional
        Where to draw.
    """
    ax = new_axes(ax)
    low, high = _ends(result)
    many = len({condition_text(x.condition) for x in result.critical}) > 1
    ax.axvspan(low, high, color=UNSTABLE, linewidth=0, label="unstable under some condition" if many else "unstable")
    for k, (start, stop) in enumerate(result.stable_intervals):
        text = "_" if k else "stable under every condition" if many else "stable"
        ax.axvspan(max(start * DAMPING, low), min(stop * DAMPING, high), color=STABLE, linewidth=0, label=text)
    _critical(result, ax)
    if result.C_su is not None and result.C_su > 0:
        text = rf"$C_\mathrm{{su}}$ = {_damping(result.C_su)}, curve's limit"
        ax.axvline(result.C_su * DAMPING, color="black", linestyle="dashed", label=text)
    if result.C_s is not None:
        text = rf"$C_\mathrm{{s}}$ = {_damping(result.C_s)}, golden section"
        ax.axvline(result.C_s * DAMPING, color="#1f4e9e", linewidth=2.5, label=text)
    ax.set(xscale="log", xlim=(low, high), xlabel=r"damping of the pair of yaw dampers $C_\mathrm{s}$ [kN·s/m]")
    title = under_conditions(f"Forward design: {result.status}", result.searched, BESIDE_NAMES if many else LINE)
    ax.set_title(title, loc="left", fontsize="medium")
    legend_below(ax)
    return ax


def _damping(value: float) -> str:
    return format_quantity(value, "kN·s/m", 4)


def _ends(result: "ForwardDesign") -> tuple[float, float]:
    marks = [x.C_s for x in result.critical] + [x for x in (result.C_su, result.C_s) if x is not None and x > 0]
    marks = [x * DAMPING for x in marks] or [1000.0]
    return min(marks) / 4, max(marks) * 4


def _critical(result: "ForwardDesign", ax: "Axes") -> None:
    """Draw the critical values beside their conditions, or as lines with their frequency where there is one."""
    several = len({condition_text(x.condition) for x in result.critical}) > 1
    if several and len({condition_text({**x.condition, "speed": 0.0}) for x in result.critical}) == 1:
        _draw_points(ax, result.critical, [to_unit(x.speed, "km/h") for x in result.critical])
        ax.set_ylabel("running speed $v$ [km/h]")
        return
    if several:
        shown = critical_shown(result)
        rows = list(dict.fromkeys(condition_text(x.condition) for x in shown))
        _draw_points(ax, shown, [rows.index(condition_text(x.condition)) for x in shown])
        ax.set_yticks(range(len(rows)), [literal(row) for row in rows], fontsize="small")
        ax.set_ylim(-0.6, len(rows) - 0.4)
        return
    ax.set_yticks([])
    for x in result.critical:
        ax.axvline(x.C_s * DAMPING, color=BECOMES[x.becomes], linewidth=1.5)
        text = f" {_damping(x.C_s)}\n at {x.omega / (2 * np.pi):.3g} Hz"
        ax.annotate(text, (x.C_s * DAMPING, 0.02), xycoords=ax.get_xaxis_transform(), fontsize="small")


def _draw_points(ax: "Axes", critical: "Sequence[Critical]", rows: Sequence[float]) -> None:
    for kind in dict.fromkeys(x.becomes for x in critical):
        points = [(x.C_s * DAMPING, row) for x, row in zip(critical, rows, strict=True) if x.becomes == kind]
        label = f"critical value, above it {'still unstable' if kind == 'neither' else kind}"
        ax.plot(*zip(*points, strict=True), "o", color=BECOMES[kind], label=label)


def draw_optimum(result: "Optimum", ax: "Axes | None" = None) -> "Axes":
    """Draw where each design variable lies between its bounds, before and at the optimum.

    Parameters
    ----------
    result : Optimum
        Of `yawdesign.optimise`.
    ax : matplotlib.axes.Axes, optional
        Where to draw.
    """
    if result.margin is None:
        raise ProblemError(f"there is nothing to draw: {result.status}: {result.message}")
    ax = new_axes(ax)
    names = list(result.bounds)
    for row, name in enumerate(names):
        _variable(ax, row, name, result)
    ax.set_yticks(range(len(names)), [f"${PARAMETERS[name].symbol}$" for name in names])
    ax.set(xlim=(-3, 103), ylim=(len(names) - 0.4, -0.6), xlabel="place between the bounds, on a logarithmic scale [%]")
    before, after = margin(result.margin_before, result.objective), margin(result.margin, result.objective)
    title = f"Least {result.objective.replace('_', ' ')}: {before} → {after}"
    ax.set_title(under_conditions(title, result.searched), loc="left", fontsize="medium")
    legend_below(ax)
    return ax


def _variable(ax: "Axes", row: int, name: str, result: "Optimum") -> None:
    bound, before, unit = result.bounds[name], result.before[name], PARAMETERS[name].unit
    place = 100 * bound.position
    label: dict[str, Any] = (
        {"label": "optimum" if result.status == Status.OPTIMAL else "best found"} if row == 0 else {}
    )
    ax.plot([0, 100], [row, row], color="#bbbbbb", linewidth=6, solid_capstyle="butt", zorder=0)
    ax.plot([place], [row], "o", color="#1f4e9e", markersize=9, **label)
    for x, value, align in ((0, bound.min, "left"), (100, bound.max, "right")):
        ax.annotate(
            format_quantity(value, unit, 4), (x, row), (0, -14), textcoords="offset points", ha=align, size="small"
        )
    text = format_quantity(bound.value, unit, 4)
    align = "left" if place < 10 else "right" if place > 90 else "center"  # it stays inside the picture
    ax.annotate(text, (place, row), (0, 9), textcoords="offset points", ha=align, color="#1f4e9e")
    if before is not None and before > 0 and bound.min > 0:
        was = 100 * np.log(before / bound.min) / np.log(bound.max / bound.min)
        label = {"label": "before"} if row == 0 else {}
        ax.plot([was], [row], "o", color="black", markerfacecolor="white", markersize=9, zorder=1, **label)
