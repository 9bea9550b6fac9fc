"""Sweeps: the same numbers as of single problems, in the right places, with units and origin."""

import csv
import json
import pickle

import numpy as np
import pytest
import xarray

import yawdesign as yd

PRINTED = yd.table1(equations="as-printed")


@pytest.fixture(scope="module")
def chart():
    """A stability chart: v over C_s."""
    return yd.sweep(PRINTED, of="stable", C_s=np.geomspace(1e4, 1e6, 7), v="250 km/h:350 km/h:5")


@pytest.fixture(scope="module")
def critical():
    return yd.sweep(PRINTED, of="critical", f_m=[2.0, 3.27], v=[250 / 3.6, 300 / 3.6, 350 / 3.6])


def test_one_dimension_for_each_axis_in_the_order_given(chart):
    assert chart.values.shape == (7, 5)
    assert [axis.name for axis in chart.axes] == ["C_s", "v"]
    for i, C_s in enumerate(chart.axes[0].values):
        for j, v in enumerate(chart.axes[1].values):
            single = yd.stability(PRINTED.replace(C_s=float(C_s), speed=float(v)))
            assert chart.values[i, j] == single.stable
    assert chart.known.all()


def test_the_chart_has_its_critical_lines(chart):
    values = chart.boundary.values
    assert values[0] == ()
    assert values[2] == pytest.approx((90702.8897786979,), rel=1e-9)
    assert values[4] == pytest.approx((255130.515707959,), rel=1e-9)
    for j, lines in enumerate(values):
        low = lines[0] if lines else 0.0
        assert np.array_equal(chart.values[:, j], chart.axes[0].values > low)


def test_all_critical_values(critical):
    assert critical.values.shape == (2, 3)
    assert [len(x) for x in critical.values[:, 1]] == [1, 3]
    assert critical.columns["count"].tolist() == [[len(x) for x in row] for row in critical.values]
    roots = critical.columns["unstable_roots"][1, 1]
    assert roots[~np.isnan(roots)].tolist() == [2, 0, 2, 0]
    single = yd.design(PRINTED.replace(K_m=PRINTED.bogie.M_m * (2 * np.pi * 3.27) ** 2))
    assert critical.values[1, 1] == pytest.approx([x.C_s for x in single.critical], rel=1e-9)
    assert critical.columns["omega"][1, 1] == pytest.approx([x.omega for x in single.critical], rel=1e-9)


@pytest.mark.parametrize("of", ["decay_rate", "damping_ratio"])
def test_margins_are_those_of_single_problems(of):
    result = yd.sweep(PRINTED, of=of, lambda_=[0.1, 0.2])
    for conicity, value in zip((0.1, 0.2), result.values, strict=True):
        assert value == pytest.approx(getattr(yd.stability(PRINTED.replace(lambda_=conicity)), of), rel=1e-9)


def test_margin_is_the_objective():
    damped = PRINTED.replace(design=yd.Design(objective="damping_ratio"))
    result = yd.sweep(damped, of="margin", lambda_=[0.1, 0.2])
    assert (result.of, result.quantity, result.unit) == ("margin", "damping_ratio", "-")
    assert np.array_equal(result.values, yd.sweep(damped, of="damping_ratio", lambda_=[0.1, 0.2]).values)


def test_an_answer_holds_for_all_speeds_of_the_problem():
    several = PRINTED.replace(speed=yd.SpeedRange(min=250 / 3.6, max=350 / 3.6, steps=3))
    C_s = [5e4, 1.5e5, 3e5]
    one_by_one = yd.sweep(PRINTED, of="stable", C_s=C_s, v=[250 / 3.6, 300 / 3.6, 350 / 3.6])
    assert np.array_equal(yd.sweep(several, of="stable", C_s=C_s).values, one_by_one.values.all(axis=1))
    assert one_by_one.values.tolist() == [[True, False, False], [True, True, False], [True, True, True]]


@pytest.mark.parametrize("of", ["C_sl", "design"])
def test_the_forward_design_at_every_point(of):
    f_m = [2.0, 3.3, 3.4, 5.0]
    result = yd.sweep(PRINTED, of=of, f_m=f_m)
    for k, f in enumerate(f_m):
        single = yd.design(PRINTED.replace(K_m=PRINTED.bogie.M_m * (2 * np.pi * f) ** 2))
        assert result.columns["status"][k] == single.status
        assert result.columns["C_sl"][k] == pytest.approx(single.C_sl, rel=1e-8)
        if of == "design":
            found = [result.columns[name][k] for name in ("C_s", "C_su", "rotational_resistance")]
            assert found == pytest.approx([single.C_s, single.C_su, single.rotational_resistance], rel=1e-8)
            assert bool(result.columns["stable"][k]) == single.stable
    assert result.boundary.values[2] == pytest.approx([x.C_s for x in single_critical(3.4)], rel=1e-8)


def single_critical(f):
    return yd.design(PRINTED.replace(K_m=PRINTED.bogie.M_m * (2 * np.pi * f) ** 2)).critical


def test_critical_speed_is_where_the_critical_damping_is_the_given_one():
    result = yd.sweep(PRINTED, of="critical_speed", C_s=[90702.8897786979, 255130.515707959])
    assert min(abs(v * 3.6 - 300) for v in result.values[0]) < 1e-5
    assert min(abs(v * 3.6 - 350) for v in result.values[1]) < 1e-5


def test_stable_everywhere_and_nowhere():
    slow = yd.sweep(PRINTED.replace(speed="200 km/h"), of="C_sl", lambda_=[0.1, 0.15])
    assert slow.values.tolist() == [0, 0]
    none = yd.sweep(PRINTED.replace(K_m=0.0), of="C_sl", lambda_=[0.1, 0.15])
    assert np.isnan(none.values).all()
    assert not none.good.any()
    assert none.to_dict()["values"] == [None, None]


def test_plain_data(critical, chart):
    data = json.loads(json.dumps(critical.to_dict(), allow_nan=False))
    assert data["of"] == "critical"
    assert [axis["name"] for axis in data["axes"]] == ["f_m", "v"]
    assert [axis["unit"] for axis in data["axes"]] == ["Hz", "m/s"]
    assert data["axes"][0]["values"] == [2.0, 3.27]
    assert data["values"][1][1] == pytest.approx(critical.values[1, 1])
    assert data["columns"]["omega"][1][1] == pytest.approx(critical.columns["omega"][1, 1])
    assert data["columns"]["checked"] == [[True] * 3] * 2
    assert data["provenance"]["problem"]["bogie"]["M_b"] == 7186
    assert data["provenance"]["points"] == 6
    assert set(data["provenance"]["versions"]) == {"yawdesign", "python", "numpy", "casadi"}
    assert data["units"]["omega"] == "rad/s"
    assert chart.to_dict()["values"] == chart.values.tolist()
    assert chart.to_dict()["boundary"]["values"][2] == pytest.approx([90702.8897786979], rel=1e-9)


def test_csv(critical, tmp_path):
    critical.to_csv(tmp_path / "x.csv")
    lines = (tmp_path / "x.csv").read_text().splitlines()
    assert json.loads(lines[1].removeprefix("# "))["points"] == 6
    rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
    assert len(rows) == 6
    assert list(rows[0])[:3] == ["f_m [Hz]", "v [m/s]", "critical_1 [N s/m]"]
    row = rows[4]
    assert [float(row[key]) for key in ("f_m [Hz]", "v [m/s]")] == pytest.approx([3.27, 300 / 3.6])
    assert [float(row[f"critical_{k} [N s/m]"]) for k in (1, 2, 3)] == pytest.approx(critical.values[1, 1], rel=1e-14)
    assert (row["count"], row["checked"]) == ("3", "1")


def test_npz(chart, tmp_path):
    chart.to_npz(tmp_path / "x.npz")
    with np.load(tmp_path / "x.npz") as file:
        assert np.array_equal(file["values"], chart.values)
        assert np.array_equal(file["axis_v"], chart.axes[1].values)
        assert file["axes"].tolist() == ["C_s", "v"]
        assert json.loads(str(file["units"])) == {"C_s": "N·s/m", "v": "m/s", "stable": "-"}
        assert json.loads(str(file["provenance"]))["points"] == 35


@pytest.mark.parametrize("name", ["chart", "critical"])
def test_xarray_through_netcdf(name, request, tmp_path):
    data = request.getfixturevalue(name).to_xarray()
    data.to_netcdf(tmp_path / "x.nc", engine="h5netcdf")
    with xarray.open_dataset(tmp_path / "x.nc", engine="h5netcdf") as back:
        xarray.testing.assert_identical(back.load(), data)
    assert data["v"].attrs["units"] == "m/s"


def test_xarray_is_labelled(critical):
    data = critical.to_xarray()
    found = data["critical"].sel(f_m=3.27).sel(v=300 / 3.6, method="nearest")
    assert found.dims == ("branch",)
    assert found.values[:3] == pytest.approx(critical.values[1, 1])
    assert data["critical"].attrs["units"] == "N·s/m"
    assert json.loads(data.attrs["provenance"])["points"] == 6


def test_three_axes_and_a_plane_of_them():
    whole = yd.sweep(PRINTED, of="stable", C_s=[5e4, 5e5], v=[70.0, 90.0], lambda_=[0.1, 0.15, 0.2])
    assert whole.values.shape == (2, 2, 3)
    plane = whole.at(lambda_=0.16)
    assert np.array_equal(plane.values, whole.values[:, :, 1])
    assert plane.provenance["at"] == {"lambda": 0.15}
    with pytest.raises(yd.ProblemError, match="did you mean lambda_"):
        whole.at(lambda_x=0.1)


def test_order_of_axes_does_not_matter(chart):
    other = yd.sweep(PRINTED, of="stable", v="250 km/h:350 km/h:5", C_s=np.geomspace(1e4, 1e6, 7))
    assert np.array_equal(other.values, chart.values.T)


def test_results_are_readable_and_can_be_sent(chart, critical):
    assert "35" in repr(chart)
    assert "C_s (7) x v (5)" in repr(chart)
    back = pickle.loads(pickle.dumps(critical))
    assert back.to_dict() == critical.to_dict()


def test_an_unverified_point_keeps_no_number(monkeypatch):
    from yawdesign.study.answers import Answers

    def doubtful(question, p, **_):
        values = np.array([1.0, 2.0, 3.0])
        return Answers({"decay_rate": values}, np.ones(3, bool), np.array([False, True, False]))

    monkeypatch.setattr("yawdesign.study.executors.evaluate", doubtful)
    result = yd.sweep(PRINTED, of="decay_rate", lambda_=[0.1, 0.2, 0.3])
    assert result.to_dict()["values"] == [1.0, None, 3.0]
    assert result.good.tolist() == [True, False, True]
    assert result.provenance["unverified"] == 1
