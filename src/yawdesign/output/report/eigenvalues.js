// Eigenvalues of a real matrix, as EISPACK finds them: balanced, reduced to Hessenberg form, by shifted QR steps.

const EPSILON = Number.EPSILON;

/** A motion's state matrix at a point. */
function matrixAt({ size, matrix }, { lambda, creep_factor, v, C_s }) {
  const out = Array.from({ length: size }, () => new Float64Array(size));
  for (const [row, column, constant, i, j, k, l] of matrix) {
    out[row][column] += constant * lambda ** i * creep_factor ** j * v ** -k * C_s ** l;
  }
  return out;
}

function balance(a) {
  const n = a.length;
  for (let done = false, turns = 0; !done && turns < 100; turns++) {
    done = true;
    for (let i = 0; i < n; i++) {
      let [r, c] = [0, 0];
      for (let j = 0; j < n; j++) {
        if (j === i) continue;
        c += Math.abs(a[j][i]);
        r += Math.abs(a[i][j]);
      }
      if (!c || !r) continue;
      const f = 2 ** Math.round(Math.log2(r / c) / 2);
      if ((c * f + r / f) >= 0.95 * (c + r)) continue;
      done = false;
      for (let j = 0; j < n; j++) a[i][j] /= f;
      for (let j = 0; j < n; j++) a[j][i] *= f;
    }
  }
}

function reduce(a) {
  const n = a.length;
  for (let m = 1; m < n - 1; m++) {
    let pivot = m;
    for (let j = m + 1; j < n; j++) if (Math.abs(a[j][m - 1]) > Math.abs(a[pivot][m - 1])) pivot = j;
    const x = a[pivot][m - 1];
    if (!x) continue;
    [a[pivot], a[m]] = [a[m], a[pivot]];
    for (const row of a) [row[pivot], row[m]] = [row[m], row[pivot]];
    for (let i = m + 1; i < n; i++) {
      const y = a[i][m - 1] / x;
      if (!y) continue;
      for (let j = m; j < n; j++) a[i][j] -= y * a[m][j];
      for (const row of a) row[m] += y * row[i];
      a[i][m - 1] = 0;
    }
  }
}

/** All eigenvalues, [real, imaginary]. The matrix is used up. */
function eigenvalues(a) {
  balance(a);
  reduce(a);
  if (!a.every((row) => row.every(Number.isFinite))) throw new RangeError("a number is out of range");
  const found = [];
  let [last, shift, tries] = [a.length - 1, 0, 0];
  while (last >= 0) {
    const first = separated(a, last);
    const [x, y] = [a[last][last], first < last ? a[last - 1][last - 1] : 0];
    const w = first < last ? a[last][last - 1] * a[last - 1][last] : 0;
    if (first === last) {
      found.push([x + shift, 0]);
      last -= 1;
      tries = 0;
    } else if (first === last - 1) {
      found.push(...pair(x, y, w).map(([re, im]) => [re + shift, im]));
      last -= 2;
      tries = 0;
    } else {
      if (++tries > 90) throw new Error("the eigenvalues do not converge");
      let shifts = [x, y, w];
      if (tries % 10 === 0) { // an unusual shift, where the usual ones go round in circles
        shift += x;
        for (let i = 0; i <= last; i++) a[i][i] -= x;
        const s = Math.abs(a[last][last - 1]) + Math.abs(a[last - 1][last - 2]);
        shifts = [0.75 * s, 0.75 * s, -0.4375 * s * s];
      }
      step(a, first, last, shifts);
    }
  }
  return found;
}

/** Where the part of the matrix begins that is still connected with its last row. */
function separated(a, last) {
  for (let k = last; k > 0; k--) {
    const size = Math.abs(a[k - 1][k - 1]) + Math.abs(a[k][k]);
    if (Math.abs(a[k][k - 1]) <= EPSILON * size) {
      a[k][k - 1] = 0;
      return k;
    }
  }
  return 0;
}

function pair(x, y, w) {
  const p = (y - x) / 2;
  const q = p * p + w;
  const z = Math.sqrt(Math.abs(q));
  if (q < 0) return [[x + p, z], [x + p, -z]];
  const far = p + (p < 0 ? -z : z);
  return [[x + far, 0], [far ? x - w / far : x, 0]];
}

/** One double step of QR on the rows from first to last. */
function step(a, first, last, [x, y, w]) {
  let [m, p, q, r] = [last - 2, 0, 0, 0];
  for (; ; m--) {
    const z = a[m][m];
    [p, q, r] = [
      ((x - z) * (y - z) - w) / a[m + 1][m] + a[m][m + 1],
      a[m + 1][m + 1] - z - (x - z) - (y - z),
      a[m + 2][m + 1],
    ];
    const s = Math.abs(p) + Math.abs(q) + Math.abs(r);
    [p, q, r] = [p / s, q / s, r / s];
    if (m === first) break;
    const small = Math.abs(a[m][m - 1]) * (Math.abs(q) + Math.abs(r));
    const large = Math.abs(p) * (Math.abs(a[m - 1][m - 1]) + Math.abs(z) + Math.abs(a[m + 1][m + 1]));
    if (small <= EPSILON * large) break;
  }
  for (let i = m + 2; i <= last; i++) {
    a[i][i - 2] = 0;
    if (i > m + 2) a[i][i - 3] = 0;
  }
  for (let k = m; k < last; k++) {
    const three = k < last - 1;
    let scale = 1;
    if (k > m) {
      [p, q, r] = [a[k][k - 1], a[k + 1][k - 1], three ? a[k + 2][k - 1] : 0];
      scale = Math.abs(p) + Math.abs(q) + Math.abs(r);
      if (!scale) continue;
      [p, q, r] = [p / scale, q / scale, r / scale];
    }
    const s = Math.hypot(p, q, r) * (p < 0 ? -1 : 1);
    if (!s) continue;
    if (k > m) a[k][k - 1] = -s * scale;
    else if (first !== m) a[k][k - 1] = -a[k][k - 1];
    p += s;
    const [u, t, z] = [p / s, q / s, r / s];
    [q, r] = [q / p, r / p];
    for (let j = k; j < a.length; j++) {
      const sum = a[k][j] + q * a[k + 1][j] + (three ? r * a[k + 2][j] : 0);
      a[k][j] -= sum * u;
      a[k + 1][j] -= sum * t;
      if (three) a[k + 2][j] -= sum * z;
    }
    for (let i = 0; i <= Math.min(last, k + 3); i++) {
      const sum = u * a[i][k] + t * a[i][k + 1] + (three ? z * a[i][k + 2] : 0);
      a[i][k] -= sum;
      a[i][k + 1] -= sum * q;
      if (three) a[i][k + 2] -= sum * r;
    }
  }
}
