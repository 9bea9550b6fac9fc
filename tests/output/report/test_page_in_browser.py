"""The page in a real browser: nothing overlaps or is cut off, nothing is asked of a network, the script may run."""

import json
from pathlib import Path

import pytest

pytestmark = pytest.mark.slow
WIDTHS = (1280, 820, 390)
A4 = 680  # of a sheet between its margins, in CSS pixels
TEXTS = (Path(__file__).parent / "text_places.js").read_text(encoding="utf-8")
# Parts of a section that share a place, and what reaches beyond the page.
FAULTS = """
(() => {
  const box = (x) => x.getBoundingClientRect(), told = [];
  for (const parent of document.querySelectorAll("body, main, section, figure")) {
    const shown = (x) => box(x).width > 1 && box(x).height > 1 && !x.matches(".skip, style, label, input");
    const parts = [...parent.children].filter(shown);
    for (let k = 1; k < parts.length; k++) {
      const a = box(parts[k - 1]), b = box(parts[k]);
      const beside = b.top >= a.bottom - 1 || b.left >= a.right - 1 || a.left >= b.right - 1;
      if (!beside) told.push(`${parts[k].outerHTML.slice(0, 80)} overlaps`);
    }
  }
  const scrolled = (x) => x.matches("figure > svg") && getComputedStyle(x.parentElement).overflowX === "auto";
  for (const x of document.querySelectorAll("h1, h2, h3, p, figure, svg[role], nav, .wide, figcaption, summary"))
    if (!x.closest("[hidden], details:not([open]), .skip") && !scrolled(x) &&
        (box(x).right > innerWidth + 1 || box(x).width < 1))
      told.push(`${x.outerHTML.slice(0, 80)} is cut off`);
  if (document.documentElement.scrollWidth > innerWidth) told.push("the page scrolls sideways");
  return told;
})()"""


@pytest.fixture(scope="module")
def page(html, browser, tmp_path_factory):
    file = tmp_path_factory.mktemp("page") / "page.html"
    file.write_text(html, encoding="utf-8")
    return browser.open(file)


@pytest.mark.parametrize("width", WIDTHS)
def test_nothing_overlaps_or_is_cut_off(page, width):
    page.resize(width, 1000)
    page.media("screen")
    page.drawn()
    assert page.evaluate(FAULTS) == []


def test_an_overlap_and_a_wide_part_would_be_seen(page):
    page.resize(820, 1000)
    page.evaluate("document.querySelector('section h2').style.marginBottom = '-40px'")
    page.evaluate("document.querySelector('figure').style.width = '3000px'")
    told = " ".join(page.evaluate(FAULTS))
    page.evaluate("for (const x of document.querySelectorAll('h2, figure')) x.removeAttribute('style')")
    assert "overlaps" in told
    assert "cut off" in told


@pytest.mark.parametrize(("kind", "width"), [*(("screen", width) for width in WIDTHS), ("print", A4)])
def test_every_text_can_be_read(page, kind, width):
    page.resize(width, 1000)
    page.media(kind)
    page.drawn()
    told = page.evaluate(TEXTS)
    page.media("screen")
    assert told == []


def test_letters_of_pictures_are_not_too_small_on_a_small_screen(page):
    """The least letters of Matplotlib's pictures have 8.3 of 504 points of their width, those of the film 12 of 640."""
    page.resize(390, 1000)
    page.media("screen")
    page.drawn()
    widths = "[...document.querySelectorAll('figure > svg')].map((x) => x.getBoundingClientRect().width)"
    assert min(8.3 / 504 * width for width in page.evaluate(widths)) > 8


@pytest.mark.parametrize(("kind", "width"), [*(("screen", width) for width in WIDTHS), ("print", A4)])
def test_pictures_have_no_empty_bands_beside_or_above(page, kind, width):
    page.resize(width, 1000)
    page.media(kind)
    page.drawn()
    bands = """[...document.querySelectorAll('figure > svg')].map((x) => {
      const [drawn, place] = [x.viewBox.baseVal, x.getBoundingClientRect()];
      return (place.width / place.height) / (drawn.width / drawn.height);
    })"""
    ratios = page.evaluate(bands)
    page.media("screen")
    assert ratios == pytest.approx([1.0] * len(ratios), rel=0.02)


def test_texts_that_cannot_be_read_would_be_seen(page):
    page.resize(820, 1000)
    page.evaluate("document.querySelector('figcaption').style.marginTop = '-30px'")
    page.evaluate("document.querySelector('figcaption + *, section p').style.position = 'absolute'")
    page.evaluate("document.querySelector('svg[role] g[id*=text_]').style.transform = 'translate(-200px)'")
    page.evaluate("document.querySelector('h3').textContent = ''")
    told = " ".join(page.evaluate(TEXTS))
    page.send("Page.reload")
    page.wait("document.readyState === 'complete' && !document.getElementById('live').hidden")
    assert " on '" in told
    assert "is cut off" in told
    assert "is empty" in told


def test_nothing_is_asked_of_a_network_and_nothing_is_forbidden(page):
    page.drawn()
    assert page.requests == []
    assert page.complaints == []
    assert page.evaluate("!document.getElementById('live').hidden")


def test_the_motion_can_be_paused(page):
    state = "getComputedStyle(document.querySelector('.moving')).animationPlayState"
    assert page.evaluate(state) == "running"
    page.focus("#film-pause")
    page.evaluate("document.activeElement.click()")
    assert page.evaluate(state) == "paused"


def test_a_dark_screen_is_dark_and_paper_is_not(page):
    ground = "getComputedStyle(document.body).backgroundColor"
    colours = {}
    for kind, scheme in (("screen", "light"), ("screen", "dark"), ("print", "dark")):
        page.media(kind, scheme=scheme)
        colours[kind, scheme] = [int(x) for x in json.loads(f"[{page.evaluate(ground)[4:-1]}]")]
    page.media("screen")
    assert max(colours["screen", "dark"]) < 60
    assert min(colours["screen", "light"]) == min(colours["print", "dark"]) == 255


def test_paper_has_no_sliders(page):
    page.media("print")
    shown = page.evaluate("[...document.querySelectorAll('input')].filter((x) => x.offsetParent !== null).length")
    page.media("screen")
    assert shown == 0
