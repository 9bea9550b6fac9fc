"""What kind of answer a forward design or an optimum is, in a word, and what to do about it."""

from enum import StrEnum
from typing import Self

AND_CURVE = " and the curve's limit"


class Status(StrEnum):
    """Kinds of answers: each is its word, as results hold it, with a message and a remedy.

    Two kinds have the same word where the forward design and the optimum tell it of different things.

    Attributes
    ----------
    message : str
        What is the case, and what to do.
    remedy : str
        What to do; empty where there is nothing to do.

    Examples
    --------
    >>> Status.STABLE_FOR_NONE == "stable for none", Status.STABLE_FOR_NONE.remedy
    (True, 'optimise K_m and C_m, which also tells the least change of each number that is enough')
    """

    meaning: str
    remedy: str

    def __new__(cls, word: str, meaning: str, remedy: str = "") -> Self:
        """Return a member that is its word."""
        member = str.__new__(cls, word)
        member._value_ = f"{word}: {meaning}"  # two kinds may have one word
        member.meaning, member.remedy = meaning, remedy
        return member

    @classmethod
    def named(cls, word: str) -> Self:
        """Return the kind of a word: where two have it, that of the forward design."""
        return next(member for member in cls if str(member) == word)

    OK = "ok", "the design interval (C_sl, C_su) is stable throughout"
    STABLE_FOR_EVERY = (
        "stable for every C_s",
        "no yaw damping is needed for stability; the golden section starts at C_sl = 0",
    )
    PARTLY_UNSTABLE = (
        "partly unstable",
        "part of the range between the lowest stable damping and C_su is unstable",
        "keep C_s inside the stable interval it was chosen from",
    )
    INFEASIBLE = (
        "infeasible",
        "every stable damping is above what the curve allows",
        "optimise K_m and C_m, which also tells the least change of each number that is enough",
    )
    INFEASIBLE_IN_CURVE = (
        "infeasible in the curve",
        "the curve's limit is exceeded even without a yaw damper",
        "optimise tells the least change of each number that is enough for stability too",
    )
    STABLE_FOR_NONE = (
        "stable for none",
        "no yaw damping makes the bogie stable",
        "optimise K_m and C_m, which also tells the least change of each number that is enough",
    )
    UNDAMPED = (
        "motor yaw undamped",
        "a motion that no yaw damper reaches is undamped: the motors yaw on their own suspension",
        "give K_mphi and C_mphi values above zero",
    )
    NO_UPPER_LIMIT = (
        "no upper limit",
        "stable up to any damping, and no curve is given that limits it",
        "add `curve` to choose C_s",
    )
    UNVERIFIED = (
        "unverified",
        "two independent ways to the critical values or to the verdict differ",
        "do not use this result; two critical values coincide, the parameters are too extreme, or a root lies on the "
        "boundary for every C_s",
    )
    OPTIMAL = "optimal", "best design found within the bounds and the curve's limit"
    UNSTABLE = (
        "unstable",
        "no design within the bounds and the curve's limit is stable",
        "see what is enough to change",
    )
    NO_FEASIBLE_DESIGN = (
        "infeasible",
        "no design within the bounds keeps the curve's limit",
        "see what is enough to change",
    )
    REQUIREMENTS_MISSED = (
        "infeasible",
        "no design within the bounds and the curve's limit meets all requirements",
        "see what is enough to change",
    )
    UNVERIFIED_OPTIMUM = (
        "unverified",
        "eigenvalues and Routh's array differ",
        "do not use this result; the parameters are too extreme for double precision",
    )
    FRONT = "ok", "every point is the best design found with its rotational resistance"
    NO_FRONT = (
        "infeasible",
        "no stable design within the bounds meets the requirements, up to twice the curve's limit",
        "lower the requirements, widen the bounds or vary other parameters",
    )
    STOPPED = "incomplete", "not all points were looked for; each of these is finished"

    @property
    def message(self) -> str:
        """What is the case, and what to do."""
        return self.told()

    def told(self, reason: str = "", *, in_curve: bool = True) -> str:
        """Return the message with a reason in it; without a curve, nothing of its limit."""
        case = self.meaning if in_curve else self.meaning.replace(AND_CURVE, "")
        text = f"{case}: {reason}" if reason else case
        separator = "; " if ":" in text else ": "
        return text + separator + self.remedy if self.remedy else text
