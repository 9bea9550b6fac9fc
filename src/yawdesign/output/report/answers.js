// What the page answers: roots, margins and verdict at a point, and the stable intervals of C_s there, in SI units.

const EXACT = 1e-9; // largest backward error with which an eigenvalue counts as a root of the polynomial

/** The answers of a vehicle at given values, in SI units. */
function readVehicle(data) {
  const motions = data.motions.map(readMotion);
  let known = {};
  const partsAt = ({ lambda, creep_factor, v }) => {
    const key = [lambda, creep_factor, v].join();
    if (known.key !== key) known = { key, parts: motions.map((x) => x.coefficients(lambda, creep_factor, v)) };
    return known;
  };
  const damped = (C_s) => over([C_s, 0], [data.damping_unit, 0]);

  function rootsAt(point) {
    const { parts } = partsAt(point);
    const polynomials = parts.map((part) => atDamping(part, damped(point.C_s)));
    const each = polynomials.map((p, k) => rootsOf(p, eigenvalues(matrixAt(data.motions[k], point))));
    const all = each.flat().sort((a, b) => b[0] - a[0] || Math.abs(a[1]) - Math.abs(b[1]) || b[1] - a[1]);
    const moved = each.filter((_, k) => motions[k].counts).flat();
    const undamped = all.filter(([x, y]) => x > -1e-10 * Math.max(1, Math.hypot(x, y))).length;
    const unstable = polynomials.reduce((sum, p) => sum + countUnstable(p), 0);
    const exact = each.every((own, k) => own.every((s) => backwardError(polynomials[k], s, data.time_unit) < EXACT));
    const ratio = ([x, y]) => (x === 0 && y === 0 ? 0 : -x / Math.hypot(x, y));
    return {
      roots: all,
      decay_rate: -Math.max(...moved.map(([x]) => x)),
      damping_ratio: Math.min(...moved.map(ratio)),
      spectral_abscissa: all[0][0],
      stable: undamped === 0 && unstable === 0,
      checked: exact && undamped === unstable,
    };
  }

  /** Eigenvalues, of which as many are zero as the polynomial without its lowest coefficients says. */
  function rootsOf(p, s) {
    const zeros = p.findIndex((a) => a[0] !== 0);
    s.sort((a, b) => Math.hypot(...a) - Math.hypot(...b));
    return s.map((root, k) => (k < zeros ? [0, 0] : root));
  }

  /** The intervals of C_s in which all motions are stable; null where counts do not fit together. */
  function stableIntervals(point) {
    const now = partsAt(point);
    now.intervals ??= [intervals(now.parts)];
    return now.intervals[0];
  }

  function intervals([coupled, ...others]) {
    const values = criticalValues(coupled);
    const ends = [0, ...values, Infinity];
    const inside = ends.slice(1).map((b, k) => {
      const a = ends[k];
      if (!a) return b === Infinity ? 1 : b / 2;
      return b === Infinity ? 2 * a : Math.sqrt(a * b);
    });
    const counts = inside.map((C) => countUnstable(atDamping(coupled, [C, 0])));
    const fit = counts.every((count, k) => k === 0 || Math.abs(count - counts[k - 1]) === 2);
    if (!fit || counts.some(Number.isNaN)) return null;
    if (others.some((part) => countUnstable(atDamping(part, [0, 0])) !== 0)) return [];
    const unit = data.damping_unit;
    const end = (x) => (x === Infinity ? null : x * unit);
    return counts.flatMap((count, k) => (count === 0 ? [[ends[k] * unit, end(ends[k + 1])]] : []));
  }

  return { at: (point) => ({ ...rootsAt(point), stable_intervals: stableIntervals(point) }) };
}
