// Roots, margins and stable intervals from characteristic polynomials whose coefficients are sums of constants times
// powers of conicity, creep factor and 1/v. Numbers that need it have 30 digits: two doubles, [high, low].

const SPLITTER = 134217729; // 2^27 + 1
const NOISE = 2e-32; // of a value of a polynomial, relative to the sum of the magnitudes of its terms

function exactSum(a, b) {
  const s = a + b;
  const v = s - a;
  return [s, a - (s - v) + (b - v)];
}

function exactProduct(a, b) {
  const p = a * b;
  let t = SPLITTER * a;
  const ah = t - (t - a);
  t = SPLITTER * b;
  const bh = t - (t - b);
  const al = a - ah;
  const bl = b - bh;
  return [p, ah * bh - p + ah * bl + al * bh + al * bl];
}

function plus(x, y) {
  const [s, e] = exactSum(x[0], y[0]);
  const [t, f] = exactSum(x[1], y[1]);
  const c = e + t;
  const high = s + c;
  const low = f + (c - (high - s));
  const sum = high + low;
  return [sum, low - (sum - high)];
}

function times(x, y) {
  const [p, e] = exactProduct(x[0], y[0]);
  const low = e + (x[0] * y[1] + x[1] * y[0]);
  const product = p + low;
  return [product, low - (product - p)];
}

const minus = (x, y) => plus(x, [-y[0], -y[1]]);

function over(x, y) {
  const first = x[0] / y[0];
  const second = minus(x, times(y, [first, 0]))[0] / y[0];
  return exactSum(first, second);
}

function power(x, k) {
  let out = [1, 0];
  for (let i = 0; i < Math.abs(k); i++) out = times(out, x);
  return k < 0 ? over([1, 0], out) : out;
}

const bytes = (text) => Uint8Array.from(atob(text), (sign) => sign.charCodeAt(0));

/** A motion's polynomials in s, lowest power first, by powers of C_s: coefficients(conicity, creep factor, v). */
function readMotion({ name, counts, monomials, places, values }) {
  const where = bytes(places);
  const constants = new Float64Array(bytes(values).buffer);
  const coefficients = (conicity, creep, v) => {
    const letters = [[conicity, 0], [creep, 0], over([1, 0], [v, 0])];
    const products = monomials.map((powers) =>
      powers.map((k, letter) => power(letters[letter], k)).reduce(times),
    );
    const parts = [];
    for (let k = 0; 3 * k < where.length; k++) {
      const [damping, s, monomial] = where.subarray(3 * k, 3 * k + 3);
      while (parts.length <= damping) parts.push([]);
      const part = parts[damping];
      while (part.length <= s) part.push([0, 0]);
      part[s] = plus(part[s], times([constants[2 * k], constants[2 * k + 1]], products[monomial]));
    }
    return parts;
  };
  return { name, counts, coefficients };
}

/** The polynomial of a motion at one C_s. */
function atDamping(parts, C) {
  const size = Math.max(...parts.map((part) => part.length));
  const out = [];
  for (let s = 0; s < size; s++) {
    let value = [0, 0];
    for (let k = parts.length - 1; k >= 0; k--) value = plus(times(value, C), parts[k][s] ?? [0, 0]);
    out.push(value);
  }
  while (out.length && out[out.length - 1][0] === 0) out.pop();
  return out;
}

/** p'(z) / p(z), or null where p(z) is zero to all digits. */
function slope(p, zr, zi) {
  let [vr, vi, dr, di] = [[0, 0], [0, 0], [0, 0], [0, 0]];
  let size = 0;
  const absolute = Math.hypot(zr, zi);
  const r = [zr, 0];
  const i = [zi, 0];
  const negative = [-zi, 0];
  for (let k = p.length - 1; k >= 0; k--) {
    [dr, di] = [plus(plus(times(dr, r), times(di, negative)), vr), plus(plus(times(dr, i), times(di, r)), vi)];
    [vr, vi] = [plus(plus(times(vr, r), times(vi, negative)), p[k]), plus(times(vr, i), times(vi, r))];
    size = size * absolute + Math.abs(p[k][0]);
  }
  const square = Math.hypot(vr[0], vi[0]);
  if (square <= NOISE * size) return null;
  const [a, b] = [vr[0] / square, vi[0] / square];
  const [c, d] = [dr[0] / square, di[0] / square];
  return [c * a + d * b, d * a - c * b];
}

/** Where to start: circles from the upper convex hull of log |p_k| (Bini 1996). */
function starts(p) {
  const height = p.map((a) => Math.log(Math.abs(a[0])));
  const hull = [];
  for (let k = 0; k < p.length; k++) {
    if (p[k][0] === 0) continue;
    while (hull.length > 1) {
      const [i, j] = hull.slice(-2);
      if ((height[j] - height[i]) * (k - i) > (height[k] - height[i]) * (j - i)) break;
      hull.pop();
    }
    hull.push(k);
  }
  const found = [];
  for (let n = 1; n < hull.length; n++) {
    const [i, j] = [hull[n - 1], hull[n]];
    const radius = Math.exp((height[i] - height[j]) / (j - i));
    for (let k = 0; k < j - i; k++) {
      const angle = (2 * Math.PI * k) / (j - i) + (2 * Math.PI * n) / p.length + 0.7;
      found.push([radius * Math.cos(angle), radius * Math.sin(angle)]);
    }
  }
  return found;
}

/** All roots of a polynomial, by the method of Ehrlich and Aberth. */
function roots(p) {
  const zeros = p.findIndex((a) => a[0] !== 0);
  const q = p.slice(zeros);
  const reversed = [...q].reverse();
  const z = starts(q);
  const n = z.length;
  const open = new Set(z.keys());
  for (let step = 0; step < 200 && open.size; step++) {
    for (const k of open) {
      const [x, y] = z[k];
      const square = x * x + y * y;
      let found;
      if (square > 1) { // there 1/z is small, a root of the reversed polynomial
        found = slope(reversed, x / square, -y / square);
        if (found) {
          const [wr, wi] = [x / square, -y / square];
          const [a, b] = [wr * found[0] - wi * found[1], wr * found[1] + wi * found[0]];
          found = [wr * (n - a) + wi * b, wi * (n - a) - wr * b];
        }
      } else found = slope(q, x, y);
      if (!found) {
        open.delete(k);
        continue;
      }
      let [a, b] = found;
      for (let j = 0; j < n; j++) {
        if (j === k) continue;
        const [dx, dy] = [x - z[j][0], y - z[j][1]];
        const distance = dx * dx + dy * dy;
        a -= dx / distance;
        b += dy / distance;
      }
      const size = a * a + b * b;
      const [dx, dy] = [a / size, -b / size];
      z[k] = [x - dx, y - dy];
      if (Math.hypot(dx, dy) <= 4e-16 * Math.sqrt(square)) open.delete(k);
    }
  }
  return [...Array(zeros).fill([0, 0]), ...z];
}

/** The number of roots that are not left of the imaginary axis, by Routh's array; NaN where it breaks down. */
function countUnstable(p) {
  const zeros = p.findIndex((a) => a[0] !== 0);
  const q = p.slice(zeros).reverse();
  let [upper, lower] = [q.filter((_, k) => k % 2 === 0), q.filter((_, k) => k % 2)];
  let changes = 0;
  while (lower.length) {
    if (lower[0][0] === 0 || !Number.isFinite(lower[0][0])) return NaN;
    if (upper[0][0] > 0 !== lower[0][0] > 0) changes++;
    const ratio = over(upper[0], lower[0]);
    const next = upper.slice(1).map((a, k) => (k + 1 < lower.length ? minus(a, times(ratio, lower[k + 1])) : a));
    [upper, lower] = [lower, next];
  }
  return zeros + changes;
}

/** Real part and imaginary part over w of a polynomial at j w, from its even and odd coefficients; x = w^2. */
function onAxis(part, x) {
  const squared = exactProduct(Math.sqrt(x), Math.sqrt(x));
  const negative = [-squared[0], -squared[1]];
  const halves = [[0, 0], [0, 0]];
  for (let k = part.length - 1; k >= 0; k--) halves[k % 2] = plus(times(halves[k % 2], negative), part[k]);
  return halves;
}

/** Something that is zero where a root lies on the axis at j w for a real C_s, between -1 and 1; and that C_s. */
function crossing(parts, w) {
  const values = parts.map((part) => onAxis(part, w * w));
  const size = values.map(([even, odd]) => Math.hypot(even[0], w * odd[0]));
  const across = ([a, b], [c, d]) => minus(times(a, d), times(b, c));
  const first = across(values[0], values[1]);
  if (values.length === 2) {
    const [[a, b], [c, d]] = values;
    const along = a[0] * c[0] + w * w * b[0] * d[0];
    return { miss: (first[0] * w) / (size[0] * size[1]), C: -along / size[1] ** 2 };
  }
  const [ends, last] = [across(values[0], values[2]), across(values[1], values[2])];
  const resultant = minus(times(ends, ends), times(first, last))[0];
  const scale = size[0] * size[2] * (size[0] * size[2] + size[1] ** 2);
  return { miss: (resultant * w * w) / scale, C: -ends[0] / last[0] };
}

const [SLOWEST, FASTEST, STEPS] = [1e-5, 1e3, 2400]; // w in units of time_unit

/** All C_s > 0 at which a root lies on the imaginary axis, in rising order. */
function criticalValues(parts) {
  const ratio = Math.log(FASTEST / SLOWEST) / STEPS;
  const place = (k) => SLOWEST * Math.exp(ratio * k);
  const miss = (k) => crossing(parts, place(k)).miss;
  const grid = Array.from({ length: STEPS + 1 }, (_, k) => [k, miss(k)]);
  const nodes = [];
  grid.forEach(([k, value], n) => {
    nodes.push([k, value]);
    // A dip towards zero without a change of sign may hide two values: its bottom is looked for.
    const [before, after] = [grid[n - 1]?.[1], grid[n + 1]?.[1]];
    const dips = value * before > 0 && value * after > 0 && value / before <= 1 && value / after <= 1;
    if (dips) nodes.push(bottom(miss, k - 1, k + 1, Math.sign(value)));
  });
  nodes.sort((a, b) => a[0] - b[0]);
  const found = [];
  for (let n = 1; n < nodes.length; n++) {
    if (nodes[n - 1][1] > 0 === nodes[n][1] > 0) continue;
    const w = place(bisected(miss, nodes[n - 1][0], nodes[n][0]));
    const { C } = crossing(parts, w);
    if (C > 0 && Number.isFinite(C)) found.push(C);
  }
  return found.sort((a, b) => a - b);
}

function bottom(f, low, high, sign) {
  const share = (Math.sqrt(5) - 1) / 2;
  for (let step = 0; step < 40; step++) {
    const [a, b] = [high - share * (high - low), low + share * (high - low)];
    const [x, y] = [sign * f(a), sign * f(b)];
    if (x < 0) return [a, sign * x];
    if (y < 0) return [b, sign * y];
    if (x < y) high = b;
    else low = a;
  }
  return [low, sign * Math.abs(f(low))];
}

function bisected(f, low, high) {
  const positive = f(low) > 0;
  for (let step = 0; step < 60; step++) {
    const middle = (low + high) / 2;
    if (f(middle) > 0 === positive) low = middle;
    else high = middle;
  }
  return (low + high) / 2;
}

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
    const each = polynomials.map((p) => roots(p).map(([x, y]) => [x * data.time_unit, y * data.time_unit]));
    const all = each.flat().sort((a, b) => b[0] - a[0] || Math.abs(a[1]) - Math.abs(b[1]) || b[1] - a[1]);
    const moved = each.filter((_, k) => motions[k].counts).flat();
    const undamped = all.filter(([x, y]) => x > -1e-10 * Math.max(1, Math.hypot(x, y))).length;
    const ratio = ([x, y]) => (x === 0 && y === 0 ? 0 : -x / Math.hypot(x, y));
    return {
      roots: all,
      decay_rate: -Math.max(...moved.map(([x]) => x)),
      damping_ratio: Math.min(...moved.map(ratio)),
      spectral_abscissa: all[0][0],
      stable: undamped === 0 && polynomials.every((p) => countUnstable(p) === 0),
    };
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
