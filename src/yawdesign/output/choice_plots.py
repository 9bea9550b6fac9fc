"""Picture of the dampers of a catalogue: the margin of each over its damping."""

from typing import TYPE_CHECKING, Any

from yawdesign.output.design_plots import DAMPING
from yawdesign.output.pictures import legend_below, literal, log_axis, new_axes, set_title
from yawdesign.output.style import HALO, LIMIT, UNSTABLE, VERDICTS, span

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.transforms import BboxBase

    from yawdesign.damper.candidates import Choice

SIGN = 8.0  # size of a mark, in dots
ASIDE = 0.15  # of the length of the axis, beside the dampers
NAMED = 30  # dampers whose names stand beside them where there is room, the first ones
RIGHT, LEFT = {"ha": "left"}, {"ha": "right"}
SIDES: tuple[dict[str, Any], ...] = (
    {"xytext": (5, 5), **RIGHT},
    {"xytext": (-5, 5), **LEFT},
    {"xytext": (5, -12), **RIGHT},
    {"xytext": (-5, -12), **LEFT},
)


def draw_choice(result: "Choice", ax: "Axes | None" = None) -> "Axes":
    """Draw the margin of each damper over the damping of its pair; each kind of refusal has its own sign.

    Parameters
    ----------
    result : Choice
        Of `yawdesign.choose`.
    ax : matplotlib.axes.Axes, optional
        Where to draw.
    """
    ax = new_axes(ax)
    scale = 100.0 if result.objective == "damping_ratio" else 1.0
    unit = "%" if result.objective == "damping_ratio" else "1/s"
    for status, (marker, colour) in VERDICTS.items():
        some = [each for each in result.candidates if each.status == status]
        points = [each.C_s * DAMPING for each in some], [scale * each.margin for each in some]
        if some:
            faces = colour if status == "ok" or marker == "x" else HALO
            look: dict[str, Any] = {"marker": marker, "s": 38, "c": faces, "zorder": 3}
            if marker != "x":
                look["edgecolors"] = colour
            ax.scatter(*points, label=f"{status} ({len(some)})", **look)
    ax.margins(0.08, 0.1)  # room for names
    ax.set_xlabel(r"damping of the pair of yaw dampers $C_\mathrm{s}$ [kN·s/m]")
    ax.set_ylabel(f"least {result.objective.replace('_', ' ')},\nworst condition [{unit}]")
    if all(each.C_s > 0 for each in result.candidates):
        ax.set_xlim(*_wider([each.C_s * DAMPING for each in result.candidates]))
        log_axis(ax)
    low, high = ax.get_ylim()
    ax.axhline(0.0, color=LIMIT, linewidth=0.8)
    if low < 0:
        span(ax, low, min(0.0, high), UNSTABLE, vertical=False)
        ax.set_ylim(low, high)
    best = result.best
    title = f"Best of {len(result.candidates)} dampers: {literal(best.name)}" if best else "No damper keeps all limits"
    set_title(ax, title, result.searched)
    legend_below(ax)
    ax.get_figure(root=True).draw_without_rendering()  # type: ignore[union-attr]  # lays out, names find their places
    _write_names(ax, result, scale)
    return ax


def _wider(values: list[float]) -> tuple[float, float]:
    """Return the ends of a logarithmic axis with room for names beside the values."""
    low, high = min(values), max(values)
    room = max(high / low, 1.5) ** ASIDE
    return low / room, high * room


def _write_names(ax: "Axes", result: "Choice", scale: float) -> None:
    """Write the name of each damper beside its sign, of the best first, where it covers no other name."""
    from matplotlib.transforms import Bbox

    places = ax.transData.transform([(each.C_s * DAMPING, scale * each.margin) for each in result.candidates])
    written: list[BboxBase] = [Bbox.from_bounds(x - SIGN / 2, y - SIGN / 2, SIGN, SIGN) for x, y in places]
    inside, (_, zero) = ax.get_window_extent(), ax.transData.transform((1.0, 0.0))
    written.append(Bbox.from_extents(inside.x0, zero - 1, inside.x1, zero + 1))
    for each in result.candidates[:NAMED]:
        place = each.C_s * DAMPING, scale * each.margin
        for side in SIDES:
            name = ax.annotate(literal(each.name), place, textcoords="offset points", size="small", **side)
            box = name.get_window_extent()
            if all(map(inside.contains, *zip(box.min, box.max, strict=True))) and not box.count_overlaps(written):
                written.append(box)
                break
            name.remove()
