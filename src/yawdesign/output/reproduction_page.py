"""The page of a reproduction: one self-contained HTML file with every row and the figures drawn anew."""

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from yawdesign.output.markup import page_colours, picture, plain_text, tables, text
from yawdesign.output.reproduction_tables import HEADS, cells, sections, verdict

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from yawdesign.study.reproduced_row import ReproducedRow
    from yawdesign.study.reproduction import Reproduction

TITLE = "The paper reproduced"
PAPER = (
    "Y. Yu, J. Wang, Y. Song, L. Zhao: Stability Analysis of Power Bogie System and Forward Design of Its Yaw Damper "
    "Damping Parameter"
)
SHOWS = {
    "fig2": "Lateral and yaw acceleration of the bogie frame over the first ten seconds.",
    "fig3": "Critical yaw damping over frequency and damping ratio of the motor suspension, stable areas shaded.",
    "fig4": "Lateral and yaw displacement of the bogie frame over the first ten seconds at 250 km/h.",
    "fig5": "Lateral and yaw displacement of the bogie frame over the first ten seconds at 300 km/h.",
}
COLUMNS = (*HEADS, "why", "checked by")
NUMBERS = {"printed", "computed", "deviation [%]"}
STYLE = """
body { font: 15px/1.45 system-ui, "Segoe UI", "DejaVu Sans", sans-serif; color: var(--ink); background: var(--paper);
  max-width: 76rem; margin: 0 auto; padding: 1.5rem }
h1 { font-size: 1.6rem; margin: 0 0 .3rem } h2 { font-size: 1.15rem; margin: 2rem 0 .5rem }
p { margin: .3rem 0 } .quiet { color: var(--soft) } .bad { color: var(--bad); font-weight: 600 }
.wide { overflow-x: auto } figure { margin: 1rem 0; max-width: 46rem } svg { width: 100%; height: auto }
table { border-collapse: collapse; font-size: .82rem; width: 100% }
th, td { text-align: left; padding: .25rem .5rem; border-bottom: 1px solid var(--line); vertical-align: top }
thead th { border-bottom: 2px solid var(--ink) } tbody th { font-weight: 500; min-width: 15rem }
.number { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap }
td.words { min-width: 9rem } td.why { min-width: 11rem; color: var(--soft) }
@media print {
  @page { size: A4 landscape; margin: 12mm } body { padding: 0; font-size: 10px; max-width: none }
  table { font-size: 8px } thead { display: table-header-group } tr, figure { break-inside: avoid }
  h2 { break-after: avoid } .wide { overflow: visible }
}
"""


def page(result: "Reproduction", pictures: Mapping[str, tuple[str, "Axes"]]) -> str:
    """Return the page; its pictures are given by name with their titles."""
    return "\n".join(
        [
            '<!DOCTYPE html><html lang="en"><head><meta charset="utf-8">',
            '<meta name="viewport" content="width=device-width, initial-scale=1">',
            f"<title>{plain_text(TITLE)}</title><style>{page_colours()}{STYLE}</style></head><body><main>",
            f'<h1>{TITLE}</h1><p class="quiet">{plain_text(PAPER)}</p>',
            *(tables(line) for line in verdict(result)),
            *_sections(result, pictures),
            f'<p class="quiet">yawdesign {plain_text(result.version)}. Values are in SI units; the numbers of errata '
            "are those of docs/errata.md. A row that is not compared has a reason.</p></main></body></html>\n",
        ]
    )


def _sections(result: "Reproduction", pictures: Mapping[str, tuple[str, "Axes"]]) -> Iterator[str]:
    for where, rows in sections(result.rows):
        yield f"<h2>{plain_text(f'Eq. {where}' if where.startswith('(') else where)}</h2>"
        yield f'<div class="wide"><table>{_head()}<tbody>{"".join(map(_row, rows))}</tbody></table></div>'
        for name, (title, axes) in pictures.items():
            if where.startswith(f"Fig. {name.removeprefix('fig')}") and not where.endswith("a"):
                yield f"<figure>{picture(axes, name, title, SHOWS[name])}</figure>"


def _head() -> str:
    cells = (f'<th scope="col"{_look(head)}>{plain_text(head)}</th>' for head in COLUMNS)
    return f"<thead><tr>{''.join(cells)}</tr></thead>"


def _look(head: str) -> str:
    return ' class="number"' if head in NUMBERS else ""


def _row(row: "ReproducedRow") -> str:
    name, *values = cells(row)
    looks = [_words(head, x) for head, x in zip(HEADS[1:], values, strict=True)]
    if row.agrees is False or not row.checked:
        looks[HEADS.index("agrees") - 1] = ' class="bad"'
    told = [f"<td{look}>{text(x)}</td>" for look, x in zip(looks, values, strict=True)]
    told += [f'<td class="why">{text(x)}</td>' for x in (row.reason, row.check)]
    return f'<tr><th scope="row">{text(name)}</th>{"".join(told)}</tr>'


def _words(head: str, value: str) -> str:
    """Return the look of a cell: words among numbers take several lines."""
    if head not in NUMBERS:
        return ""
    return ' class="number"' if len(value) < 16 else ' class="words"'
