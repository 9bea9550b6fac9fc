"""The weighting W_d against the table of the standard."""

import numpy as np
import pytest

from yawdesign.response.run.ride_comfort import horizontal_weight

# ISO 2631-1:1997, Table 3, W_d in thousandths by the nominal centre of one-third octaves [Hz]. At 10 Hz the table has
# 212, between 253 and 161 no smooth value; the transfer function of the standard's Annex A gives 202.
TABLE = {
    **{0.1: 62.4, 0.125: 97.3, 0.16: 158, 0.2: 243, 0.25: 365, 0.315: 530, 0.4: 713, 0.5: 853, 0.63: 944, 0.8: 992},
    **{1: 1011, 1.25: 1008, 1.6: 968, 2: 890, 2.5: 776, 3.15: 642, 4: 512, 5: 409, 6.3: 323, 8: 253, 12.5: 161},
    **{16: 125, 20: 100, 25: 80, 31.5: 63.2, 40: 49.4, 50: 38.8, 63: 29.5, 80: 21.1},
}


@pytest.mark.parametrize(("frequency", "thousandths"), TABLE.items())
def test_table_of_the_standard(frequency, thousandths):
    found = abs(horizontal_weight(np.array([2 * np.pi * frequency])))[0]
    assert 1000 * found == pytest.approx(thousandths, rel=4e-3)


def test_reference_frequency():
    """ISO 8041 gives the weight at 100 rad/s, by which instruments are checked."""
    assert abs(horizontal_weight(np.array([100.0])))[0] == pytest.approx(0.1261, abs=5e-5)
