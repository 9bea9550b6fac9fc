"""Draws docs/figures/trade-off.png, the front of Table I under 15 conditions: python docs/figures/trade_off.py."""

from pathlib import Path

import yawdesign as yd
from yawdesign.output.pictures import own_texts

CONDITIONS = {"lambda": [0.05, 0.10, 0.15, 0.25, 0.40], "creep_factor": [1, 0.7, 0.5]}

if __name__ == "__main__":
    front = yd.trade_off(yd.table1().replace(conditions=CONDITIONS), points=12)
    with own_texts():
        yd.plot(front).figure.savefig(Path(__file__).with_name("trade-off.png"), dpi=100)
