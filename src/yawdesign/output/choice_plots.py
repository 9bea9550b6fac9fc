"""Picture of the dampers of a catalogue: the margin of each over its damping."""

from typing import TYPE_CHECKING, Any

from yawdesign.output.design_plots import DAMPING
from yawdesign.output.pictures import legend_below, literal, new_axes, under_conditions

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.transforms import BboxBase

    from yawdesign.damper.candidates import Choice

NAMED = 30  # dampers whose names stand beside them where there is room, the first ones
RIGHT, LEFT = {"ha": "left"}, {"ha": "right"}
SIDES: tuple[dict[str, Any], ...] = (
    {"xytext": (5, 5), **RIGHT},
    {"xytext": (-5, 5), **LEFT},
    {"xytext": (5, -12), **RIGHT},
    {"xytext": (-5, -12), **LEFT},
)
# Signs differ in shape, and not in colour alone.
SIGNS = {
    "ok": ("o", "#1b6e3a"),
    "unverified": ("?", "#7f7f7f"),
    "misses a requirement": ("s", "#d98c00"),
    "unstable": ("x", "#b2182b"),
    "exceeds the curve's limit": ("^", "#5f5f5f"),
    "outside the bounds": ("v", "#a0a0a0"),
}


def draw_choice(result: "Choice", ax: "Axes | None" = None) -> "Axes":
    """Draw the margin of each damper over the damping of its pair; each kind of refusal has its own sign.

    Parameters
    ----------
    result : Choice
        Of `yawdesign.choose`.
    ax : matplotlib.axes.Axes, optional
        Where to draw.
    """
    from matplotlib.ticker import LogFormatter

    ax = new_axes(ax)
    scale = 100.0 if result.objective == "damping_ratio" else 1.0
    for status, (sign, colour) in SIGNS.items():
        some = [each for each in result.candidates if each.status == status]
        points = [each.C_s * DAMPING for each in some], [scale * each.margin for each in some]
        if some:
            filled = {} if sign == "x" else {"markerfacecolor": colour if status == "ok" else "white"}
            marker = "D" if sign == "?" else sign
            label = f"{status} ({len(some)})"
            ax.plot(*points, linestyle="none", marker=marker, color=colour, label=label, **filled)  # type: ignore[arg-type]
    ax.axhline(0.0, color="black", linewidth=0.8)
    ax.margins(0.08, 0.1)  # room for names
    positive = all(each.C_s > 0 for each in result.candidates)
    unit = "%" if result.objective == "damping_ratio" else "1/s"
    ax.set(
        xscale="log" if positive else "linear",
        xlabel=r"damping of the pair of yaw dampers $C_\mathrm{s}$ [kN·s/m]",
        ylabel=f"least {result.objective.replace('_', ' ')}, worst condition [{unit}]",
    )
    best = result.best
    title = f"Best of {len(result.candidates)} dampers: {literal(best.name)}" if best else "No damper keeps all limits"
    ax.set_title(under_conditions(title, result.searched), loc="left", fontsize="medium")
    if positive:
        ax.xaxis.set_major_formatter(LogFormatter())
        ax.xaxis.set_minor_formatter(LogFormatter())
    legend_below(ax)
    _write_names(ax, result, scale)
    return ax


def _write_names(ax: "Axes", result: "Choice", scale: float) -> None:
    """Write the name of each damper beside its sign, of the best first, where it covers no other name."""
    written: list[BboxBase] = []
    inside = ax.get_window_extent()
    for each in result.candidates[:NAMED]:
        place = each.C_s * DAMPING, scale * each.margin
        for side in SIDES:
            name = ax.annotate(literal(each.name), place, textcoords="offset points", size="small", **side)
            box = name.get_window_extent()
            if all(map(inside.contains, *zip(box.min, box.max, strict=True))) and not box.count_overlaps(written):
                written.append(box)
                break
            name.remove()
