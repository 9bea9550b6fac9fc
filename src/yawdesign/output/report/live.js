// The part of the page that answers for other values: reads sliders and number fields, draws roots and intervals.

const panel = document.getElementById("live");
const data = JSON.parse(document.getElementById("live-data").textContent);
const vehicle = readVehicle(data);
const start = { ...data.start };
window.yawdesignLive = { at: (point) => vehicle.at({ ...start, ...point }) };

const SVG = "http://www.w3.org/2000/svg";
const POSITIONS = 1000; // of a slider
const rows = [...panel.querySelectorAll("[data-key]")].map((row) => {
  const [slider, field] = [row.querySelector("[type=range]"), row.querySelector("[type=number]")];
  const { key, factor, low, high, scale } = row.dataset;
  const [to, from] = scale === "log" ? [Math.log, Math.exp] : [(x) => x, (x) => x];
  const [bottom, top] = [to(Number(low)), to(Number(high))];
  const position = (x) => Math.round((POSITIONS * (to(x) - bottom)) / (top - bottom));
  const valueAt = (k) => Number(from(bottom + ((top - bottom) * k) / POSITIONS).toPrecision(3));
  return { key, slider, field, position, valueAt, factor: Number(factor), unit: row.dataset.unit, first: field.value };
});

const isGiven = ({ field }) => Number.isFinite(field.valueAsNumber) && field.valueAsNumber > 0;

function pointNow() {
  const point = {};
  for (const row of rows) point[row.key] = row.field.valueAsNumber * row.factor;
  return point;
}

function follow(row) {
  row.slider.value = row.position(row.field.valueAsNumber);
  row.slider.setAttribute("aria-valuetext", `${row.field.value} ${row.unit}`);
}

let asked = false;
function changed() {
  if (!asked) requestAnimationFrame(show);
  asked = true;
}

for (const row of rows) {
  row.slider.addEventListener("input", () => {
    row.field.value = row.valueAt(row.slider.valueAsNumber);
    row.slider.setAttribute("aria-valuetext", `${row.field.value} ${row.unit}`);
    changed();
  });
  row.field.addEventListener("input", () => {
    if (isGiven(row)) follow(row);
    changed();
  });
}
document.getElementById("live-reset").addEventListener("click", () => {
  for (const row of rows) {
    row.field.value = row.first;
    follow(row);
  }
  changed();
});

const write = (name, text) => {
  document.getElementById(`live-${name}`).textContent = text;
};

function digits(x, n = 4) {
  const text = Number(x.toPrecision(n));
  const [size, fixed] = [Math.abs(text), String(text)];
  return (size >= 1e6 || (size < 1e-3 && size > 0) ? text.toExponential() : fixed).replace("-", "\u2212");
}

function show() {
  asked = false;
  const missing = rows.filter((row) => !isGiven(row));
  for (const row of rows) row.field.setAttribute("aria-invalid", String(missing.includes(row)));
  const point = pointNow();
  const answer = missing.length ? null : answerAt(point);
  panel.classList.toggle("waiting", answer === null);
  if (missing.length) write("verdict", "A value is missing: give a number above zero.");
  else if (!answer) write("verdict", "These values are too far out to compute with.");
  else showAnswer(answer, point);
}

function answerAt(point) {
  try {
    return vehicle.at(point);
  } catch {
    return null;
  }
}

function showAnswer(answer, point) {
  panel.classList.toggle("unstable", !answer.stable || !answer.checked);
  const verdict = answer.stable ? "Stable." : "Unstable.";
  write("verdict", answer.checked ? verdict : "Not decided here: roots and polynomial do not agree.");
  write("decay-rate", `${digits(answer.decay_rate)} 1/s`);
  write("damping-ratio", `${digits(100 * answer.damping_ratio)} %`);
  write("abscissa", `${digits(answer.spectral_abscissa)} 1/s`);
  write("intervals", inWords(answer.stable_intervals));
  drawRoots(answer.roots);
  drawIntervals(answer.stable_intervals, point.C_s);
}

function inWords(intervals) {
  if (!intervals) return "not decided here: two ways to count unstable roots do not agree";
  if (!intervals.length) return "none";
  const each = intervals.map(([low, high]) => {
    if (high === null) return low ? `above ${digits(low / 1e3, 6)}` : "everywhere";
    return low ? `${digits(low / 1e3, 6)} \u2026 ${digits(high / 1e3, 6)}` : `below ${digits(high / 1e3, 6)}`;
  });
  return each.join(", ") + (each[0] === "everywhere" ? "" : " kN\u00b7s/m");
}

function drawn(parent, name, attributes, text) {
  const element = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  if (text !== undefined) element.textContent = text;
  parent.append(element);
  return element;
}

// The plane of the roots: near the imaginary axis, as high and as far right as the roots there go.
const plane = document.getElementById("live-plane-drawn");
const HERTZ = 2 * Math.PI;
const [LEFT, RIGHT] = [-15, 5]; // 1/s, with no root farther right
const APART = [5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000]; // numbers beside the axis [1/s]
const HEIGHTS = [1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64]; // Hz
const [WIDE, TALL, MARGIN] = [600, 300, { left: 46, right: 12, top: 10, bottom: 40 }];
const firstRoots = vehicle.at(start).roots;

function axesFor(roots) {
  const near = roots.filter(([x, y]) => y >= 0 && x >= LEFT);
  const farthest = Math.min(1.1 * Math.max(...near.map(([x]) => x), 0), 6 * APART.at(-1));
  const step = APART.find((each) => Math.max(farthest, RIGHT) <= 6 * each);
  const end = Math.max(RIGHT, step * Math.ceil(farthest / step));
  const highest = Math.max(...near.map(([, y]) => y), 0) / HERTZ;
  const top = HEIGHTS.find((hertz) => hertz >= 1.1 * highest) ?? HEIGHTS.at(-1);
  const across = (x) => MARGIN.left + ((WIDE - MARGIN.left - MARGIN.right) * (x - LEFT)) / (end - LEFT);
  const upward = (y) => TALL - MARGIN.bottom - ((TALL - MARGIN.top - MARGIN.bottom) * y) / (top * HERTZ);
  return { step, end, top, across, upward };
}

function drawRoots(roots) {
  const upper = roots.filter(([, y]) => y >= 0);
  const axes = axesFor(roots);
  const { across, upward } = axes;
  const isIn = ([x, y]) => y >= 0 && x >= LEFT && x <= axes.end && y <= axes.top * HERTZ;
  drawFrame(axes);
  for (const [x, y] of firstRoots.filter(isIn)) {
    drawn(plane, "circle", { class: "first", cx: across(x), cy: upward(y), r: 5 });
  }
  const seen = upper.filter(isIn);
  for (const [x, y] of seen) {
    const [h, v] = [across(x), upward(y)];
    const shape = x < 0 ? `M${h - 4} ${v - 4}l8 8m0 -8l-8 8` : `M${h - 5} ${v + 4}h10l-5 -9z`;
    drawn(plane, "path", { class: x < 0 ? "root" : "root growing", d: shape });
  }
  const beyond = upper.filter((s) => !isIn(s));
  const farthest = digits(Math.max(...beyond.map(([x]) => x)));
  const some = `${beyond.length} more outside the picture, the farthest right of them at ${farthest} 1/s.`;
  write("plane-note", beyond.length ? some : "All are in the picture.");
  const undamped = upper.filter(([x]) => x >= 0).length;
  const [[x, y]] = roots;
  write(
    "plane-description",
    `${seen.length} roots and pairs of roots in the picture, ${undamped} of all not left of the imaginary axis; ` +
      `the rightmost at ${digits(x)} 1/s and ${digits(Math.abs(y) / HERTZ)} Hz.`,
  );
}

function drawFrame({ step, end, top, across, upward }) {
  plane.replaceChildren();
  const [zero, base] = [across(0), upward(0)];
  const half = { x: zero, y: MARGIN.top, width: across(end) - zero, height: base - MARGIN.top };
  drawn(plane, "rect", { class: "half", ...half });
  drawn(plane, "rect", { class: "hatched", ...half });
  for (let x = step * Math.ceil(LEFT / step); x <= end; x += step) {
    drawn(plane, "line", { class: "grid", x1: across(x), x2: across(x), y1: MARGIN.top, y2: base });
    drawn(plane, "text", { x: across(x), y: base + 19, "text-anchor": "middle" }, digits(x));
  }
  for (let k = 0; k <= 4; k++) {
    const height = upward((top * HERTZ * k) / 4);
    drawn(plane, "line", { class: "grid", x1: across(LEFT), x2: across(end), y1: height, y2: height });
    drawn(plane, "text", { x: across(LEFT) - 6, y: height + 4, "text-anchor": "end" }, digits((top * k) / 4));
  }
  drawn(plane, "line", { class: "axis", x1: zero, x2: zero, y1: MARGIN.top, y2: base });
  drawn(plane, "line", { class: "axis", x1: across(LEFT), x2: across(end), y1: base, y2: base });
  const [center, middle] = [across((LEFT + end) / 2), (MARGIN.top + base) / 2];
  drawn(plane, "text", { x: center, y: TALL - 6, "text-anchor": "middle" }, "real part [1/s]");
  const turned = { x: 12, y: middle, "text-anchor": "middle", transform: `rotate(-90 12 ${middle})` };
  drawn(plane, "text", turned, "frequency [Hz]");
}

// The axis of the damping, in decades.
const line = document.getElementById("live-axis-drawn");
const [LEAST, MOST, BAR] = [1e3, 1e8, { y: 14, height: 26 }]; // N s/m
const along = (C) => 20 + (560 * (Math.log10(Math.min(Math.max(C, LEAST), MOST)) - 3)) / 5;

function drawIntervals(intervals, C_s) {
  line.replaceChildren();
  const whole = { x: along(LEAST), width: along(MOST) - along(LEAST), ...BAR };
  drawn(line, "rect", { class: intervals ? "half" : "unknown", ...whole });
  if (intervals) drawn(line, "rect", { class: "hatched", ...whole });
  for (const [low, high] of intervals ?? []) {
    const [a, b] = [along(low), along(high ?? MOST)];
    drawn(line, "rect", { class: "paper", x: a, width: b - a, ...BAR });
    drawn(line, "rect", { class: "stable", x: a, width: b - a, ...BAR });
  }
  for (let C = LEAST, k = 0; k <= 5; k++, C *= 10) {
    drawn(line, "line", { class: "axis", x1: along(C), x2: along(C), y1: 40, y2: 45 });
    drawn(line, "text", { x: along(C), y: 58, "text-anchor": k === 5 ? "end" : "middle" }, (C / 1e3).toLocaleString("en").replaceAll(",", "\u202f"));
  }
  drawn(line, "text", { x: 300, y: 74, "text-anchor": "middle" }, "C_s [kN\u00b7s/m]");
  drawn(line, "rect", { class: "frame", ...whole });
  drawn(line, "path", { class: "chosen", d: `M${along(C_s)} 6v40` });
  drawn(line, "path", { class: "chosen point", d: `M${along(C_s) - 5} 2h10l-5 8z` });
}

for (const row of rows) follow(row);
panel.hidden = false;
show();
