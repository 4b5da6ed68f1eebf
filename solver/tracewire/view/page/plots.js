// The curves of a run, panel below panel, and a row of marks for each block that had events.

import {make, part, shown} from "./page.js";

const COLORS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7"];
const STRONG = {impact: 1, reset: 1, rest: 1};
const MEASURED = "#4D4D4D";
const GUTTER = 64;  // pixels, without the label
const LABEL = 20;
const MOST_ROWS = 8;
const CLOSE = 3;     // pixels between marks
const MANY = 20;     // marks of a row
const PAUSE = 250;  // ms without a new run after which curves are drawn in their full width

const plain = (u, splits) => splits.map((v) => (v === null ? "" : String(+v.toPrecision(10))));
const large = () => document.body.classList.contains("present");
const wide = () => (large() ? 2.5 : 1.5);
// one pixel of the screen: without a graphics card a browser paints wider curves many times slower
const thin = () => 1 / (devicePixelRatio || 1);
const font = () => `${large() ? 15 : 12}px sans-serif`;

export class Plots {
  constructor() {
    this.holder = part("plots");
    this.plots = [];
    this.residuals = [];
    this.form = "";
    this.now = null;
    new ResizeObserver(() => this.resize()).observe(this.holder);
  }

  show(head) {
    this.head = head;
    this.follow();
    const rows = [...new Set(head.events.map((event) => event.block))].slice(0, MOST_ROWS);
    const measured = head.measured ? head.measured.signals : {};
    const panels = head.panels.map((p) => [p.unit, p.lines.map((l) => l.label)]);
    const form = JSON.stringify([panels, rows, Object.keys(measured)]);
    const t = head.arrays[head.t];
    this.span = [t[0], t[t.length - 1]];
    if (form !== this.form) this.build(head, rows);
    this.form = form;
    this.rows = rows;
    head.panels.forEach((panel, n) => {
      this.plots[n].panel = panel;
      panel.dots = panel.lines.filter((line) => line.name in measured).map((line) => ({
        t: head.arrays[measured[line.name].t], values: head.arrays[measured[line.name].values],
      }));
      this.plots[n].setData([t, ...panel.lines.map((line) => head.arrays[line.values])]);
    });
    Object.values(measured).forEach((one, n) => {
      this.residuals[n].setData([head.arrays[one.t], head.arrays[one.residual]]);
      this.residuals[n].setScale("x", {min: this.span[0], max: this.span[1]});
    });
    if (rows.length) this.plots[this.plots.length - 1].setData([this.span, [null, null]]);
    this.point(this.now);
  }

  // curves that follow a drag are thin until it pauses
  follow() {
    const now = performance.now();
    const moving = now - (this.shownAt ?? -Infinity) < PAUSE;
    this.shownAt = now;
    clearTimeout(this.timer);
    this.widen(moving ? thin() : wide());
    if (moving) {
      this.timer = setTimeout(() => {
        this.widen(wide());
        for (const plot of this.plots) plot.redraw(false);
      }, PAUSE);
    }
  }

  widen(width) {
    for (const plot of this.plots) {
      if (plot.panel) for (const line of plot.series.slice(1)) line.width = width;
    }
  }

  build(head, rows) {
    for (const plot of this.plots) plot.destroy();
    const measured = Object.keys(head.measured ? head.measured.signals : {});
    const count = head.panels.length + measured.length + (rows.length ? 1 : 0);
    this.plots = head.panels.map((panel, n) => this.panel(panel, n === count - 1));
    this.residuals = measured.map((name, n) =>
      this.residual(name, head, head.panels.length + n === count - 1));
    this.plots.push(...this.residuals);
    if (rows.length) this.plots.push(this.strip(rows));
    for (const plot of this.plots) {
      plot.line = make("div", {className: "now"});
      plot.over.append(plot.line);
    }
    this.resize();
  }

  options(height, last, y) {
    const axis = {stroke: "#444", font: font(), grid: {stroke: "#e6e6e6", width: 1}};
    return {
      width: Math.max(this.holder.clientWidth, 200),
      height,
      pxAlign: false,
      cursor: {sync: {key: "run", scales: ["x", null]}, drag: {x: true, y: false}, points: {size: 6}},
      scales: {x: {time: false}, y: {}},
      axes: [
        {...axis, values: plain, size: (last ? 34 : 24) + (large() ? 8 : 0), label: last ? "t [s]" : null,
          labelSize: 18, labelFont: font()},
        {...axis, values: plain, size: GUTTER, labelSize: LABEL, labelFont: font(), ...y},
      ],
      hooks: {},
    };
  }

  panel(panel, last) {
    const names = panel.lines.map((line) => line.label);
    const unit = panel.unit && panel.unit !== "1" ? ` [${panel.unit}]` : "";
    const made = this.options(this.tall(last), last, {label: names.length === 1 ? names[0] + unit : unit});
    const value = (u, v) => (v === null || v === undefined ? "" : shown(v, 5));
    made.series = [{label: "t", value}, ...panel.lines.map((line, n) => ({
      label: line.label, stroke: COLORS[n % 4], width: wide(), value, points: {show: false},
    }))];
    made.legend = {live: true};
    made.hooks.drawClear = [(u) => backdrop(u, u.panel)];
    made.scales.y.range = (u, least, most) => around(u.panel, least, most);
    const plot = new uPlot(made, [[0, 1], ...panel.lines.map(() => [null, null])], this.holder);
    plot.root.setAttribute("role", "img");
    plot.root.setAttribute("aria-label", `${names.join(", ")} over time`);
    plot.last = last;
    return plot;
  }

  residual(name, head, last) {
    const unit = unitOf(head, name);
    const label = unit ? `residual [${unit}]` : "residual";
    const made = this.options((large() ? 165 : 125) + (last ? 24 : 0), last, {label, space: 18});
    made.legend = {show: false};
    made.series = [{label: "t"}, {label: "residual", stroke: MEASURED, width: 1, points: {show: false}}];
    const plot = new uPlot(made, [[0, 1], [null, null]], this.holder);
    plot.root.setAttribute("role", "img");
    plot.root.setAttribute("aria-label", `Residual of ${name} over time: measured minus simulated`);
    return plot;
  }

  strip(rows) {
    const splits = rows.map((_, n) => n);
    const made = this.options((large() ? 26 : 20) * rows.length + (large() ? 70 : 62), true, {
      splits: () => splits,
      values: () => rows.map((row) => (row.length > 15 ? `…${row.slice(-14)}` : row)),
      ticks: {show: false}, grid: {show: false}, size: GUTTER + LABEL, font: `${large() ? 11 : 10}px sans-serif`,
    });
    made.scales.y = {range: () => [-0.6, rows.length - 0.4], dir: -1};
    made.legend = {show: false};
    made.series = [{label: "t"}, {label: "", show: false}];
    made.hooks.drawClear = [(u) => marks(u, rows, this.head.events)];
    const plot = new uPlot(made, [[0, 1], [null, null]], this.holder);
    plot.root.setAttribute("role", "img");
    plot.root.setAttribute("aria-label", "Events over time");
    plot.strip = true;
    return plot;
  }

  tall(last) {
    const panels = this.head.panels.length;
    const height = panels > 3 ? 130 : 190;
    return (large() ? 1.3 * height : height) + (last ? 24 : 0);
  }

  resize() {
    const width = Math.max(this.holder.clientWidth, 200);
    for (const plot of this.plots) {
      if (plot.width !== width) plot.setSize({width, height: plot.height});
    }
    this.point(this.now);
  }

  // a line at a time in s; none where it is null
  point(time) {
    this.now = time;
    for (const plot of this.plots) {
      if (!plot.line) continue;
      plot.line.hidden = time === null || this.span === undefined;
      if (!plot.line.hidden) plot.line.style.left = `${plot.valToPos(time, "x")}px`;
    }
  }
}

// the unit in which a signal is drawn; empty where it has none
export function unitOf(head, name) {
  const panel = head.panels.find((one) => one.lines.some((line) => line.name === name));
  return panel && panel.unit !== "1" ? panel.unit || "" : "";
}

function faded(color, alpha) {
  return color + ("0" + Math.round(255 * alpha).toString(16)).slice(-2);
}

function inside(u, work) {
  const box = u.bbox;
  u.ctx.save();
  u.ctx.beginPath();
  u.ctx.rect(box.left, box.top, box.width, box.height);
  u.ctx.clip();
  work(u.ctx, box, (t) => u.valToPos(t, "x", true));
  u.ctx.restore();
}

// the range of a panel, in which its measured samples are, too
function around(panel, least, most) {
  let [low, high] = [least ?? Infinity, most ?? -Infinity];
  for (const dots of panel ? panel.dots : []) {
    for (const value of dots.values) {
      if (value < low) low = value;
      if (value > high) high = value;
    }
  }
  return Number.isFinite(low) && Number.isFinite(high) ? uPlot.rangeNum(low, high, 0.1, true) : [0, 1];
}

// behind the curves: measured samples, shades while a friction holds a signal, thin lines where an event sets one
function backdrop(u, panel) {
  if (!panel) return;
  inside(u, (c, box, x) => {
    panel.lines.forEach((line, n) => {
      c.fillStyle = faded(COLORS[n % 4], 0.13);
      for (const [from, to] of line.held) {
        c.fillRect(x(from), box.top, Math.max(x(to) - x(from), 1), box.height);
      }
    });
    c.fillStyle = MEASURED;
    for (const dots of panel.dots) {
      const size = (dots.t.length > 600 ? 1.5 : 3) * devicePixelRatio;
      dots.t.forEach((t, n) => {
        c.fillRect(x(t) - size / 2, u.valToPos(dots.values[n], "y", true) - size / 2, size, size);
      });
    }
    if (panel.jumps.length > 60) return;
    c.strokeStyle = faded("#B22222", 0.45);
    c.lineWidth = 0.8 * devicePixelRatio;
    for (const time of panel.jumps) {
      c.beginPath();
      c.moveTo(x(time), box.top);
      c.lineTo(x(time), box.top + box.height);
      c.stroke();
    }
  });
}

// from where to where marks stand closer than they are told apart; null where they do not
function bar(events, x) {
  if (events.length < MANY) return null;
  const ends = [x(events[0].t), x(events[events.length - 1].t)];
  return ends[1] - ends[0] < CLOSE * devicePixelRatio * events.length ? ends : null;
}

function marks(u, rows, events) {
  inside(u, (c, box, x) => {
    c.lineWidth = devicePixelRatio;
    const crowded = rows.map((block) => bar(events.filter((event) => event.block === block), x));
    crowded.forEach((ends, row) => {
      if (!ends) return;
      c.fillStyle = faded("#B22222", 0.25);
      const [top, bottom] = [-0.3, 0.3].map((half) => u.valToPos(row + half, "y", true));
      c.fillRect(ends[0], top, ends[1] - ends[0], bottom - top);
    });
    for (const event of events) {
      const row = rows.indexOf(event.block);
      if (row < 0 || crowded[row]) continue;
      const strong = STRONG[event.kind];
      const half = strong ? 0.38 : 0.2;
      c.strokeStyle = strong ? "#B22222" : "#6b6b6b";
      c.beginPath();
      c.moveTo(x(event.t), u.valToPos(row - half, "y", true));
      c.lineTo(x(event.t), u.valToPos(row + half, "y", true));
      c.stroke();
    }
  });
}
