"""Keys of vehicles that this package does not hold: what to write instead, or that it is outside the model."""

from __future__ import annotations

import re
from collections.abc import Collection

from .diagnostics import suggestion

MOST_LISTED = 12  # names that a message lists
_OUTSIDE = "outside this model"
_LINEAR = f"{_OUTSIDE}, which is linear: give the value for small motions"

# Patterns of keys, in small letters and digits only, and what is answered; the first that fits the whole key counts.
_ANSWERS = (
    (
        r"(n|no|number|numof|numberof)?(axles?|wheelsets?)(count|number|perbogie)?|(third|middle|centre|center)(axle|wheelset)"
        r"|(three|four)axles?|[mj]w3|(bo){2}|(co){2}|(wheel|axle)?arrangement",
        f"{_OUTSIDE}, in which every bogie has two wheelsets",
    ),
    (
        r".*motor.*body.*|(body|underfloor)(mounted)?motors?",
        f"{_OUTSIDE}, in which motors hang on the bogie frame: for motors on the car body write kind: trailer, and add "
        "their masses and inertias to M_c, J_c and I_c",
    ),
    (
        r"(nose|axle)(suspended|hung).*|.*motor.*(axle|nose).*|(axle|nose|unsprung)motors?"
        r"|motor(suspension|mount|mounting|drive)",
        f"{_OUTSIDE}, in which motors hang on the bogie frame: for motors on the axles write kind: trailer, and "
        "add their masses and inertias to M_w and J_w",
    ),
    (
        r"(n|no|number|numof|numberof)?motors?(count|number|perbogie)?",
        "a power bogie has two motors, with the keys M_m, J_m, K_m ...; a trailer bogie has none",
    ),
    (
        r".*(perside|dampers?.*(side|bogie|count))|n(o|umber|umberof)?(yaw)?dampers?|nyaw|yawdampers?|nds",
        "C_s and K_ds are those of both sides together: with two yaw dampers a side give twice the C_s and K_ds of one "
        "a side (in a catalogue: per_side: 2)",
    ),
    (
        r".*(blowoff|saturation|reliefvalve).*|[fv]blow|fmax|vmaxdamper|dampingafter",
        f"{_LINEAR}, below the blow-off",
    ),
    (
        r".*(friction|coulomb|adhesion).*|mu(max)?",
        f"{_OUTSIDE}, which is linear: friction has no part in it; a wet or dirty rail is a creep_factor",
    ),
    (
        r"nonlinear.*|(damper|force)?(law|table|characteristic|lookup|lookuptable)s?|limitcycles?|amplitudes?"
        r"|(damper|force)curves?|forces?|forcevelocity|velocityforce|cstable|.*(twostage|asymmetric|rebound|compression).*",
        _LINEAR,
    ),
    (
        r".*(progressive|hysteresis|rubber|frequencydependent).*|zener|kelvinvoigt",
        f"{_OUTSIDE}: springs, and the joints of dampers, are linear: give stiffness and damping at hunting",
    ),
    (
        r".*(flange|clearance|bumpstop|backlash).*|gaps?|limits",
        f"{_OUTSIDE}, which is linear: motions are so small that nothing touches",
    ),
    (
        r".*(antiroll|rollbar|torsionbar|swaybar).*|k(roll|theta|arb)",
        f"{_OUTSIDE}: add its roll stiffness k of one bogie to that of the secondary springs, K_2z + k/(2 b_2^2)",
    ),
    (
        r".*(interbogie|bogiecoupl|crossbrac|crossanchor|shearbrac|interwheelset|axlecoupl|yokedframe).*",
        f"{_OUTSIDE}: no spring or damper joins the bogies, or the wheelsets beside the primary suspension",
    ),
    (
        r".*(intercar|carcoupl|coupledcars?|gangway|adjacentcar|articulated|jacobs).*|coupler|coupling|train|vehicles"
        r"|(n|no|number|numberof)?cars|draw(bar|gear)",
        f"{_OUTSIDE}, in which one car runs alone on two bogies of its own",
    ),
    (
        r".*(traction|tractive|torque|braking|brakes?).*",
        f"{_OUTSIDE}, which runs at a constant speed: traction, brakes and traction rods have no part in it",
    ),
    (
        r"(?!.*ratio).*gear.*|cardan.*|hollowshaft",
        "add its mass and inertia to the body that carries it: M_w, M_b or M_m",
    ),
    (
        r".*(bolster|sidebearer|threepiece|cent(re|er)(plate|bowl)).*",
        f"{_OUTSIDE}, in which the secondary suspension stands between bogie frame and car body",
    ),
    (
        r"(elastic|flexible)?(tracks?|rails?|ballast|sleepers?|railpads?)(k|c|m|stiffness|damping|mass|inertia)?"
        r"|[kcm](track|rail|pad|sleeper)",
        f"{_OUTSIDE}, in which the track is rigid; its irregularities are an option of `yawdesign simulate`",
    ),
    (r".*(side|cross)wind.*|wind(speed|force)?", f"{_OUTSIDE}, in which nothing but the track moves the vehicle"),
    (r".*(derail|nadal|wear).*", f"{_OUTSIDE}, which computes neither derailment nor wear"),
    (r".*comfort.*|sperling.*", "`yawdesign simulate` computes it; it can be neither required nor optimised"),
    (
        r".*(profile|kalker(?!factor)|fastsim|contactpatch|contacttable|contactangle|inclination).*|spin(creep)?|wheels?"
        r"|f(12|23|33)|c(11|22|23)|(s1002|uic60|rsgeo).*|k?gravity(stiffness|coefficient)?",
        "wheel and rail are here the conicity lambda and the creep coefficients f_11 and f_22; "
        "creep: {kalker_factor: 0.6} under bogie makes these from the axle load",
    ),
    (
        r"(n|no|number|numberof)?bogies|bogie[12ab]|.*(leading|trailing|front|rear)(bogie|truck)?.*",
        f"{_OUTSIDE}, in which both bogies, and their ends, are equal; a fault of one stands under cases, such as "
        "{leading.C_s: 50 %}",
    ),
    (
        r".*(left|right)(side)?|(left|right)[a-z0-9]*|(wheel)?(radius|diameter)difference",
        f"{_OUTSIDE}, in which both sides are equal; a yaw damper lost on one side stands under cases, as "
        "{C_s: 50 %, K_ds: 50 %}",
    ),
    (
        r"independent|.*(independent(ly)?(rotat|wheel)|irw|freewheel|stubaxle).*",
        f"{_OUTSIDE}, in which the wheels of an axle turn together",
    ),
    (r".*steer.*|radial.*", f"{_OUTSIDE}: wheelsets are guided by the primary suspension alone"),
    (r".*(active|control(ler|law)?|actuator|skyhook).*|tilt.*", f"{_OUTSIDE}, in which every element is passive"),
    (r".*(flexib|bending|elastic).*|ei|fbend|eigenfrequenc(y|ies)", f"{_OUTSIDE}, in which all bodies are rigid"),
    (
        r"airsprings?|secondary(springs?|suspension|stiffness)",
        "give its stiffnesses as K_2x, K_2y and, where the car body rolls, K_2z and C_2z",
    ),
    (r"primary(springs?|suspension|stiffness)", "give its stiffnesses of each wheelset as K_1x and K_1y"),
    (r"c2y|(secondary)?lateraldampers?", "give the damping of the pair of secondary lateral dampers as C_t"),
    (r"c2x", "give the damping of the pair of yaw dampers as C_s"),
    (r"k2?(yaw|psi)|k2phi|yawstiffness", "divide the yaw stiffness of the secondary suspension by b_2^2: K_2x"),
    (r"k1(yaw|psi|phi)", "divide the yaw stiffness of the primary suspension of a wheelset by b_1^2: K_1x"),
    (r"(equivalent|effective)conicity|gammae|tangammae?", "give the equivalent conicity as lambda"),
    (r"wheelload|q0?", "give twice the wheel load, the axle load, as W"),
    (r"vehicle", "the vehicle stands under bogie and, where its car body moves, car_body"),
    (r"cant(deficiency)?|superelevation", "has no part in the rotational resistance in a curve: remove it"),
    (r"(bogie)?wheelbase", "give half of it as a"),
    (r"(wheel)?(radius|diameter)", "give the rolling radius of the wheels as r"),
    (r"(track)?gauge", "give half the lateral distance of the contact points as b, 0.7465 m on standard gauge"),
    (
        r"(bogie|pivot)(distance|spacing|centres|centers|base)",
        "give half of it as car_body.l_c, all of it as curve.L",
    ),
)
_PATTERNS = tuple((re.compile(pattern), answer) for pattern, answer in _ANSWERS)
_SEVERAL = "several that are met stand under conditions, bounds of a choice under design.variables"


def answer_to(key: str) -> str | None:
    """Return what to do about a key of another vehicle, or None if it is no such key.

    Examples
    --------
    >>> answer_to("axles")
    'outside this model, in which every bogie has two wheelsets'
    """
    plain = re.sub(r"[^a-z0-9]", "", key[:80].casefold())
    return next((answer for pattern, answer in _PATTERNS if pattern.fullmatch(plain)), None)


def why_unknown(key: str, allowed: Collection[str], text: str = "is not known here") -> str:
    """Return what to tell of a key that is not known: of which vehicle it is, or what was meant, or where to look.

    Examples
    --------
    >>> why_unknown("K1x", ["K_1x", "K_1y"]), why_unknown("zzz", ["K_1x"])
    ('is not known here; did you mean K_1x?', 'is not known here; known here: K_1x')
    """
    if answer := answer_to(key):
        return answer
    few = f"; known here: {', '.join(allowed)}" if len(allowed) <= MOST_LISTED else "; `yawdesign schema` lists what is"
    return f"{text}{suggestion(key, allowed) or few}"


def why_no_number(value: object) -> str | None:
    """Return what to tell of several values, a law or a name in the place of one number; None of anything else."""
    if isinstance(value, str):
        return answer_to(value) if value[:1].isalpha() else None
    if isinstance(value, (list, tuple)):
        return _SEVERAL
    if isinstance(value, dict):
        ends = {"min", "max"} & set(value)
        return _SEVERAL if ends else next(filter(None, (answer_to(str(key)) for key in value)), None)
    return None
