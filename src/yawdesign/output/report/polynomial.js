// Characteristic polynomials whose coefficients are sums of constants times powers of conicity, creep factor and 1/v: how
// many roots are unstable, and at which C_s one of them lies on the imaginary axis.

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

/**
 * The number of roots that are not left of the imaginary axis, by Routh's array; NaN where it breaks down. Where a row is
 * zero, the row above it is a factor with roots s and -s: it goes on with the derivative of that factor, of whose roots
 * as many lie left of the axis as right of it.
 */
function countUnstable(p) {
  const zeros = p.findIndex((a) => a[0] !== 0);
  const q = p.slice(zeros).reverse();
  let [upper, lower] = [q.filter((_, k) => k % 2 === 0), q.filter((_, k) => k % 2)];
  let [changes, whole, factor] = [0, 0, 0]; // changes of sign: until now, above the zero row; degree of the factor
  for (let degree = q.length - 1; lower.length; degree--) {
    if (lower.every((a) => a[0] === 0)) {
      [whole, factor, changes] = [changes, degree, 0];
      lower = upper.map((a, k) => times(a, [degree - 2 * k, 0])).slice(0, Math.ceil(degree / 2));
    }
    if (lower[0][0] === 0 || !Number.isFinite(lower[0][0])) return NaN;
    if (upper[0][0] > 0 !== lower[0][0] > 0) changes++;
    const ratio = over(upper[0], lower[0]);
    const next = upper.slice(1).map((a, k) => (k + 1 < lower.length ? minus(a, times(ratio, lower[k + 1])) : a));
    [upper, lower] = [lower, next];
  }
  return zeros + whole + (factor ? factor - changes : changes);
}

/** |p(s)| relative to the sum of the magnitudes of its terms; p in s / unit, s in 1/s. */
function backwardError(p, [x, y], unit) {
  const size = Math.hypot(x, y) / unit;
  const q = size > 1 ? [...p].reverse() : p; // powers of a large s overflow: there 1/s is taken
  const [u, w] = size > 1 ? [x / (size * size * unit), -y / (size * size * unit)] : [x / unit, y / unit];
  let [re, im, sum] = [0, 0, 0];
  const least = Math.max(size > 1 ? 1 / size : size, 1e-3);
  for (let k = q.length - 1; k >= 0; k--) {
    [re, im] = [re * u - im * w + q[k][0], re * w + im * u];
    sum = sum * least + Math.abs(q[k][0]);
  }
  return Math.hypot(re, im) / sum;
}

/** Every second coefficient of a polynomial from a first one on, as a polynomial in -w^2; w a double. */
function halfAt(part, first, w) {
  const [x, y] = exactProduct(-w, w);
  let t = SPLITTER * x;
  const xh = t - (t - x);
  const xl = x - xh;
  let [high, low] = [0, 0];
  // times and plus written out: a picture needs this a million times.
  for (let k = part.length - 1 - ((part.length - 1 - first) % 2); k >= first; k -= 2) {
    const p = high * x;
    t = SPLITTER * high;
    const hh = t - (t - high);
    const hl = high - hh;
    const error = hh * xh - p + hh * xl + hl * xh + hl * xl + (high * y + low * x);
    const [a, b] = part[k];
    const sum = p + a;
    const v = sum - p;
    const rest = p - (sum - v) + (a - v) + (error + b);
    high = sum + rest;
    low = rest - (high - sum);
  }
  return [high, low];
}

/** Real part, and imaginary part over w, of a polynomial at j w. */
const onAxis = (part, w) => [halfAt(part, 0, w), halfAt(part, 1, w)];

/** Something that is zero where a root lies on the axis at j w for a real C_s, between -1 and 1; and that C_s. */
function crossing(parts, w) {
  const values = parts.map((part) => onAxis(part, w));
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
    const [one, other] = [before / value, after / value];
    const dips = one >= 1 && other >= 1 && Math.max(one, other) > 2; // two in one step: at least nine times as high
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
