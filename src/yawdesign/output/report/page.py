"""The page: one HTML file with its style, pictures and tables, that needs no network and no server."""

import base64
import hashlib
import re
from collections.abc import Callable, Mapping, Sequence
from importlib.resources import files
from typing import TYPE_CHECKING

from yawdesign.output import markup
from yawdesign.output.report import closing_sections, condition_sections, design_sections, motion_sections, verdict
from yawdesign.output.report.fragments import Section
from yawdesign.output.report.glyphs import shared_letters

if TYPE_CHECKING:
    from yawdesign.study.design_review import DesignReview

UNTITLED = "Yaw damper of a bogie"
# In the order of the page; a section whose input is missing is left out.
SECTIONS: "tuple[Callable[[DesignReview], Section | None], ...]" = (
    verdict.verdict,
    verdict.change,
    verdict.inputs,
    design_sections.intervals,
    condition_sections.requirements,
    condition_sections.conditions,
    condition_sections.faults,
    design_sections.before_and_after,
    motion_sections.damping_over_speed,
    motion_sections.root_locus,
    condition_sections.chart,
    condition_sections.wear,
    condition_sections.mounts,
    design_sections.front,
    design_sections.catalogue,
    design_sections.sensitivity,
    motion_sections.hunting,
    motion_sections.run,
    motion_sections.damper,
    motion_sections.car_body,
    motion_sections.live,
    closing_sections.limits,
    closing_sections.checks,
)


def page(review: "DesignReview", origin: Mapping[str, str]) -> str:
    """Return a design review as an HTML page.

    Parameters
    ----------
    review : DesignReview
        What `yawdesign.study.design_review.design_review` returns.
    origin : mapping
        From what and with what it was made: names and values of the last section.
    """
    found = [section for each in SECTIONS if (section := each(review)) is not None]
    found.append(closing_sections.provenance(origin))
    title = review.problem.title or UNTITLED
    main = shared_letters("\n".join(section.html for section in found))
    return "\n".join(
        [
            "<!DOCTYPE html>",
            '<html lang="en" dir="ltr">',
            f"<head>{_head(title, main)}</head>",
            "<body>",
            '<a class="skip" href="#verdict">Skip to the verdict</a>',
            f"<header><p>Design review of a yaw damper</p><h1>{markup.text(title)}</h1></header>",
            _contents(found),
            f"<main>{main}</main>",
            f"<footer><p>{markup.text(', '.join(map(' '.join, [*origin.items()][:2])))}</p></footer>",
            "</body>",
            "</html>\n",
        ]
    )


def _head(title: str, main: str) -> str:
    style = files(__package__).joinpath("page.css").read_text(encoding="utf-8")
    return "\n".join(
        [
            '<meta charset="utf-8">',
            f'<meta http-equiv="Content-Security-Policy" content="{_policy(main)}">',
            '<meta name="viewport" content="width=device-width, initial-scale=1">',
            '<meta name="color-scheme" content="light dark">',
            '<meta name="referrer" content="no-referrer">',
            '<link rel="icon" href="data:,">',
            f"<title>{markup.plain_text(title)}</title>",
            f"<style>{markup.page_colours()}{style}</style>",
        ]
    )


def _policy(main: str) -> str:
    """Return what a browser may do with this page: show what is in it, run the scripts that stand in it, no more."""
    scripts = re.findall(r"<script>(.*?)</script>", main, re.DOTALL)
    hashes = (base64.b64encode(hashlib.sha256(each.encode()).digest()).decode() for each in scripts)
    allowed = " ".join(f"'sha256-{each}'" for each in hashes) or "'none'"
    rules = ("default-src 'none'", "img-src data:", "style-src 'unsafe-inline'", f"script-src {allowed}")
    return "; ".join([*rules, "base-uri 'none'", "form-action 'none'"])


def _contents(sections: Sequence[Section]) -> str:
    entries = "".join(f'<li{each.kind}><a href="#{each.name}">{each.title}</a></li>' for each in sections)
    return f'<nav aria-label="Contents"><h2>Contents</h2><ol>{entries}</ol></nav>'
