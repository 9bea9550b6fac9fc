"""What notebooks show: tables as HTML, a film that moves, a bar; once in a notebook that is really run."""

import json
import re
from xml.etree import ElementTree

import pytest

import yawdesign as yd
from yawdesign.output.notebooks import html
from yawdesign.problem.notebook_view import NotebookView


def page_of(shown):
    """Return the HTML of something as elements: what is well-formed, every browser reads."""
    return ElementTree.fromstring(shown._repr_html_())


def cells(page):
    return ["".join(cell.itertext()) for row in page.iter("tr") for cell in row]


def test_every_result_is_shown(kind_of_result, results):
    page = page_of(results[kind_of_result])
    assert page.tag == "div"
    assert len(list(page.iter("tr"))) > 1
    assert all(table.find("tbody") is not None for table in page.iter("table"))


def test_a_problem_shows_units_meanings_and_what_is_not_as_in_table_1(results):
    page = page_of(yd.table1().replace(M_b="7.5 t", title="<b>my</b> bogie"))
    rows = [[("".join(cell.itertext())) for cell in row] for row in page.iter("tr")]
    assert ["M_b", "7 500 kg", "*", "mass of the bogie frame"] in rows
    assert ["J_b", "9 751 kg·m²", "", "yaw inertia of the bogie frame"] in rows
    assert sum(row[2] == "*" for row in rows if len(row) == 4) == 1
    assert "<b>my</b> bogie" in "".join(page.itertext())
    whole = cells(page_of(results["Problem"]))
    for told in ("lambda 0.05, lambda 0.4", "at least 1 %", "tare: W = 150 000 N", "10 000 kN·s/m"):
        assert told in whole
    assert "as in Table I" in "".join(page_of(yd.table1()).itertext())


def test_numbers_are_those_of_the_result(results):
    optimum = results["Optimum"]
    assert f"{optimum.margin:.6g} 1/s" in cells(page_of(optimum))


def test_without_the_package_s_edge_there_is_plain_text(monkeypatch, results):
    monkeypatch.setattr(NotebookView, "made_by", None)
    assert results["Stability"]._repr_html_() is None


def test_a_film_moves_by_itself():
    film = yd.animate(yd.modes(yd.table1().replace(C_s=1e6)), mode="frame yaw")
    page = film._repr_html_()
    assert film.to_jshtml() == page
    frame = ElementTree.fromstring(page)
    assert frame.tag == "iframe"
    assert frame.get("sandbox") == "allow-scripts"
    assert "frame yaw" in frame.get("srcdoc")
    assert "requestAnimationFrame" in frame.get("srcdoc")
    assert repr(film).startswith("Film")


CELLS = (
    "import yawdesign as yd\nproblem = yd.table1().replace(C_s=1e6)\nproblem",
    "yd.stability(problem)",
    "found = yd.sweep(problem, of='stable', lambda_='0.05:0.4:9')",
)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_in_a_notebook(tmp_path, monkeypatch):
    import nbclient
    import nbformat

    monkeypatch.setenv("IPYTHONDIR", str(tmp_path))
    book = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(source) for source in CELLS])
    nbclient.NotebookClient(book, timeout=120, kernel_name="python3").execute()
    first, second, third = (json.dumps(cell.outputs) for cell in book.cells)
    assert "<caption>" in first
    assert "mass of the bogie frame" in first
    assert "spectral abscissa" in second
    assert "display_data" in third
    assert "<progress" not in third  # it is gone when the work is done


def test_the_style_reaches_nothing_else():
    rules = re.findall(r"<style>(.*?)</style>", html(yd.table1()), re.DOTALL)[0]
    assert all(
        part.strip().startswith(".yawdesign")
        for rule in rules.split("}")[:-1]
        for part in rule.split("{")[0].split(",")
    )
