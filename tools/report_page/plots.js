"use strict";
// Curves over time as SVG.

const WIDTH = 440, HEIGHT = 210, LEFT = 58, RIGHT = 10, TOP = 8, BOTTOM = 24;  // of a plot, in its own units

function make(name, attributes = {}, ...children) {
  const isDrawn = ["svg", "path", "line", "rect", "text", "g"].includes(name);
  const element = isDrawn ? document.createElementNS("http://www.w3.org/2000/svg", name) : document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  element.append(...children);
  return element;
}

/// Short, and as many digits as one can use.
function shortNumber(value) {
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e5 || size < 1e-3) return value.toExponential(2).replace(/\.?0+e/, "e").replace("e+", "e");
  return String(Number(value.toPrecision(4)));
}

function niceTicks(low, high, most) {
  const rough = (high - low) / most, power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((factor) => factor * power).find((size) => size >= rough);
  const ticks = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k) ticks.push(k * step);
  return ticks;
}

function logTicks(low, high) {
  const first = Math.ceil(Math.log10(low) - 1e-9), last = Math.floor(Math.log10(high) + 1e-9);
  const every = Math.max(1, Math.ceil((last - first) / 6)), ticks = [];
  for (let power = first; power <= last; power += every) ticks.push(10 ** power);
  return ticks;
}

/// Least and largest of what is shown, with some room; null if there is nothing.
function rangeOf(curves, isLog) {
  let low = Infinity, high = -Infinity;
  for (const { y } of curves) {
    for (const value of y) {
      if (Number.isFinite(value) && (!isLog || value > 0)) { low = Math.min(low, value); high = Math.max(high, value); }
    }
  }
  if (low > high) return null;
  if (isLog) return high > 1.5 * low ? [low, high] : [low / 3, high * 3];
  const room = high > low ? 0.04 * (high - low) : Math.abs(low) * 0.1 || 1;
  return [low >= 0 && low - room < 0 ? 0 : low - room, high + room];
}

/// A path through the points; of very many, the least and largest in each half unit.
function pathOf(x, y, toX, toY) {
  const parts = [];
  let move = true, column = NaN, low = 0, high = 0;
  const flush = () => { if (!Number.isNaN(column)) parts.push(`V${low}V${high}`); };
  for (let i = 0; i < x.length; ++i) {
    const py = toY(y[i]), px = Math.round(toX(x[i]) * 2) / 2;
    if (!Number.isFinite(py)) { flush(); column = NaN; move = true; continue; }
    const place = Math.round(py * 10) / 10;
    if (!move && px === column) { low = Math.min(low, place); high = Math.max(high, place); continue; }
    flush();
    parts.push(`${move ? "M" : "L"}${px} ${place}`);
    [move, column, low, high] = [false, px, place, place];
  }
  flush();
  return parts.join("");
}

/// A plot of curves {label, colour, dash, x, y}. `title` and `unit` are texts; `choices`, if there are
/// any, are names of which `onChoice` hears. Its `setTime` moves the cursor and shows the values there.
class Plot {
  constructor({ title, unit, isLog, curves, choices, chosen, onChoice, onTime, hidden }) {
    Object.assign(this, { isLog, curves, hidden });
    this.svg = make("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}` });
    this.legend = make("div", { class: "legend" });
    const head = make("div", { class: "head" }, make("h3", {}, unit ? `${title} [${unit}]` : title));
    if (choices) head.append(this.choice(choices, chosen, onChoice));
    this.element = make("div", { class: "plot" }, head, this.svg, this.legend);
    this.element.dataset.title = title;
    this.values = curves.map((curve) => this.legendEntry(curve));
    this.svg.addEventListener("click", (event) => onTime(this.timeAt(event)));
    this.svg.addEventListener("pointermove", (event) => this.moveCursor(this.timeAt(event)));
    this.svg.addEventListener("pointerleave", () => this.moveCursor(this.time));
    this.time = 0;
    this.draw();
  }

  choice(choices, chosen, onChoice) {
    const select = make("select", {}, ...choices.map((name) => make("option", {}, name)));
    select.value = chosen;
    select.addEventListener("change", () => onChoice(select.value));
    return select;
  }

  legendEntry(curve) {
    const line = make("line", { x1: 0, x2: 20, y1: 5, y2: 5, stroke: curve.colour, "stroke-width": 2, "stroke-dasharray": curve.dash });
    const value = make("span", { class: "value" });
    const button = make("button", { title: "hide or show" }, make("svg", {}, line), ` ${curve.label} `, value);
    button.classList.toggle("hidden", this.hidden.has(curve.label));
    button.addEventListener("click", () => {
      if (!this.hidden.delete(curve.label)) this.hidden.add(curve.label);
      button.classList.toggle("hidden", this.hidden.has(curve.label));
      this.draw();
    });
    this.legend.append(button);
    return value;
  }

  draw() {
    this.svg.replaceChildren();
    const shown = this.curves.filter(({ label }) => !this.hidden.has(label));
    const range = rangeOf(shown, this.isLog);
    if (!range) {
      this.svg.append(make("text", { x: WIDTH / 2, y: HEIGHT / 2, "text-anchor": "middle" }, "nothing but zeros or no number"));
      this.cursor = null;
      return;
    }
    this.ends = [Math.min(...shown.map(({ x }) => x[0])), Math.max(...shown.map(({ x }) => x[x.length - 1]))];
    if (this.ends[1] <= this.ends[0]) this.ends[1] = this.ends[0] + 1e-9;
    const scale = this.isLog ? Math.log10 : (value) => value;
    const [low, high] = range.map(scale);
    const toX = (time) => LEFT + ((time - this.ends[0]) / (this.ends[1] - this.ends[0])) * (WIDTH - LEFT - RIGHT);
    const toY = (value) => HEIGHT - BOTTOM - ((scale(value) - low) / (high - low)) * (HEIGHT - TOP - BOTTOM);
    this.toX = toX;
    for (const tick of this.isLog ? logTicks(...range) : niceTicks(...range, 5)) {
      this.svg.append(make("line", { class: "gridline", x1: LEFT, x2: WIDTH - RIGHT, y1: toY(tick), y2: toY(tick) }),
        make("text", { x: LEFT - 5, y: toY(tick) + 4, "text-anchor": "end" }, shortNumber(tick)));
    }
    for (const tick of niceTicks(...this.ends, 6)) {
      this.svg.append(make("line", { class: "gridline", x1: toX(tick), x2: toX(tick), y1: TOP, y2: HEIGHT - BOTTOM }),
        make("text", { x: toX(tick), y: HEIGHT - BOTTOM + 15, "text-anchor": "middle" }, shortNumber(tick)));
    }
    this.svg.append(make("rect", { class: "frame", x: LEFT, y: TOP, width: WIDTH - LEFT - RIGHT, height: HEIGHT - TOP - BOTTOM }));
    for (const { x, y, colour, dash } of shown)
      this.svg.append(make("path", { class: "curve", d: pathOf(x, y, toX, this.isLog ? (v) => (v > 0 ? toY(v) : NaN) : toY), stroke: colour, "stroke-dasharray": dash }));
    this.cursor = make("line", { class: "cursor", y1: TOP, y2: HEIGHT - BOTTOM });
    this.svg.append(this.cursor);
    this.moveCursor(this.time);
  }

  timeAt(event) {
    const box = this.svg.getBoundingClientRect();
    const x = ((event.clientX - box.left) / box.width) * WIDTH;
    const part = Math.min(Math.max((x - LEFT) / (WIDTH - LEFT - RIGHT), 0), 1);
    return this.ends ? this.ends[0] + part * (this.ends[1] - this.ends[0]) : 0;
  }

  setTime(time) {
    this.time = time;
    this.moveCursor(time);
  }

  moveCursor(time) {
    if (!this.cursor) return;
    const x = this.toX(Math.min(Math.max(time, this.ends[0]), this.ends[1]));
    this.cursor.setAttribute("x1", x);
    this.cursor.setAttribute("x2", x);
    this.curves.forEach((curve, i) => {
      const row = rowAt(curve.x, time);
      this.values[i].textContent = row < 0 ? "" : shortNumber(curve.y[row]);
    });
  }
}

/// The last row that is not later than the time, by bisection; -1 if all are.
function rowAt(times, time) {
  let low = -1, high = times.length;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle] <= time * (1 + 1e-6)) low = middle; else high = middle;
  }
  return low;
}
