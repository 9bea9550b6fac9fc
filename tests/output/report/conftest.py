"""A review of a small problem that has nearly all that a page may show, answered once for all tests of the page."""

import pytest

import yawdesign as yd
from yawdesign.output.report.report import rendered
from yawdesign.study.design_review import design_review

TITLE = '<script>alert(1)</script> "$x^{$ [bold] & <b>\u05d0</b>'
FAULT = "<i>lost</i> $5"


@pytest.fixture(scope="session")
def review():
    variables = {"C_s": yd.Variable(min="100 kN s/m", max="3 MN s/m")}
    problem = yd.table1().replace(
        title=TITLE,
        curve=None,
        design=yd.Design(variables=variables),
        conditions={"lambda": [0.1, 0.2]},
        cases={FAULT: {"C_s": "50 %", "K_ds": "50 %"}},
        requirements={"damping_ratio": "1 %"},
    )
    return design_review(problem)


@pytest.fixture(scope="session")
def html(review):
    return rendered(review, {"problem file": "<x>.yaml"}).decode()
