// Numbers of 30 digits: two doubles, [high, low], whose sum is the number (Dekker 1971).

const SPLITTER = 134217729; // 2^27 + 1

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
