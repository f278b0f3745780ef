// Charts on uPlot's axes. Lines are drawn here, since a load over a displacement turns back and two
// runs have rows at different times.

import uPlot from "uplot";
import {svgOf} from "./chart_svg.js";
import {logMarks, make, round, save, scaledUnit} from "./format.js";

const style = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

/** Index of the value nearest to `at` in ascending values. */
export function nearest(values, at) {
  let low = 0, high = values.length - 1;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (values[middle] < at) low = middle + 1;
    else high = middle;
  }
  return low > 0 && at - values[low - 1] < values[low] - at ? low - 1 : low;
}

/** Powers of ten. */
function logTick(v) {
  const power = Math.log10(v);
  return Math.abs(power - Math.round(power)) < 1e-6 ? (power >= 0 && power < 5 ? String(Math.round(v)) : `10${String(Math.round(power)).replace(/[-\d]/g, (c) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[c] ?? "⁻")}`) : "";
}

function span(arrays) {
  let low = Infinity, high = -Infinity;
  for (const values of arrays)
    for (const v of values) {
      if (!Number.isFinite(v)) continue;
      if (v < low) low = v;
      if (v > high) high = v;
    }
  return low > high ? [0, 1] : low === high ? [low - 0.5 * Math.abs(low || 1), high + 0.5 * Math.abs(high || 1)] : [low, high];
}

/**
 * A chart.
 * lines: [{label, color, x, y, unit, dash, dots, base, times}]; `base`: the line is the upper edge of
 * an area above these values; `times`: of its points, if x is no time.
 * onTime(t): the reader dragged to this time.
 */
export class Chart {
  constructor(host, {lines, x, yUnit, height = 220, onTime, logX = false, logY = false, xRange}) {
    Object.assign(this, {host, lines, onTime, logX});
    this.time = null;
    const [xLow, xHigh] = xRange ?? span(lines.map((l) => l.x));
    const [yLow, yHigh] = span(lines.flatMap((l) => (l.base ? [l.y, l.base] : [l.y])));
    this.xScale = logX ? {factor: 1, unit: ""} : scaledUnit(x.unit, Math.max(Math.abs(xLow), Math.abs(xHigh)));
    this.yScale = logY ? {factor: 1, unit: ""} : scaledUnit(yUnit, Math.max(Math.abs(yLow), Math.abs(yHigh)));
    this.xIsTime = x.unit === "s" && lines.every((l) => !l.times);
    const room = 0.04 * (yHigh - yLow);
    const axis = (label, scaled, log) => ({
      stroke: () => style("--text-2"), font: "12px system-ui, sans-serif", labelFont: "12px system-ui, sans-serif",
      label: `${label}${scaled.unit ? ` [${scaled.unit}]` : ""}`, labelSize: 15, size: 24, gap: 4,
      ...(log ? {splits: (_, _axis, low, high) => logMarks(low, high)} : {}),
      grid: {stroke: () => style("--grid"), width: 1}, ticks: {stroke: () => style("--grid"), size: 4},
      values: (_, ticks) => ticks.map((v) => (v == null ? "" : log ? logTick(v) : round(v * scaled.factor, 4))),
    });
    const left = axis("", this.yScale, logY);
    left.label = this.yScale.unit ? `[${this.yScale.unit}]` : "";
    left.labelSize = this.yScale.unit ? 16 : 0;
    left.size = 46;
    const below = axis(x.label, this.xScale, logX);
    this.labels = [below.label, left.label];
    this.plot = new uPlot({
      width: Math.max(host.clientWidth, 120), height,
      legend: {show: false}, padding: [8, 12, 0, 0],
      cursor: {x: false, y: false, points: {show: false}, drag: {x: false, y: false}},
      scales: {
        x: {time: false, distr: logX ? 3 : 1, range: () => [xLow, xHigh]},
        y: {distr: logY ? 3 : 1, range: () => logY ? [0.8 * yLow, 1.3 * yHigh] : [Math.min(yLow - (yLow < 0 ? room : 0), 0 < yLow && yLow < 0.4 * yHigh ? 0 : yLow), yHigh + room]},
      },
      series: [{}, {show: true, stroke: "transparent", paths: () => null, points: {show: false}}],
      axes: [below, left],
      hooks: {draw: [(u) => this.draw(u)]},
    }, [[xLow, xHigh], [yLow, yHigh]], host);
    this.plot.over.classList.add("drag");
    this.listen();
    this.exports = make("div", {class: "export"},
      make("button", {type: "button", title: "save these numbers", onclick: () => save(new Blob([this.csv(x, yUnit)], {type: "text/csv"}), "curve.csv")}, "csv"),
      make("button", {type: "button", title: "save this picture", onclick: () => this.plot.ctx.canvas.toBlob((blob) => save(blob, "curve.png"))}, "png"),
      make("button", {type: "button", title: "save this picture as lines", onclick: () => save(new Blob([svgOf(this, style)], {type: "image/svg+xml"}), "curve.svg")}, "svg"));
    host.append(this.exports);
    this.observer = new ResizeObserver(() => {
      const width = host.clientWidth;
      if (width > 0 && width !== this.plot.width) this.plot.setSize({width, height});
    });
    this.observer.observe(host);
  }

  destroy() {
    this.observer.disconnect();
    this.plot.destroy();
  }

  /** The numbers in SI, the lines below each other. */
  csv(x, yUnit) {
    const quoted = (text) => `"${String(text).replaceAll('"', '""')}"`;
    const rows = [`curve,${quoted(`${x.label || "x"}${x.unit ? ` [${x.unit}]` : ""}`)},${quoted(`value${yUnit && yUnit !== "-" ? ` [${yUnit}]` : ""}`)}`];
    for (const line of this.lines)
      for (let i = 0; i < line.x.length; ++i)
        if (Number.isFinite(line.y[i])) rows.push(`${quoted(line.label)},${line.x[i]},${line.base ? line.y[i] - line.base[i] : line.y[i]}`);
    return rows.join("\n") + "\n";
  }

  setTime(time) {
    this.time = time;
    this.plot.redraw(false);
  }

  listen() {
    if (!this.onTime) return;
    const {over} = this.plot;
    const follow = (event) => {
      const box = over.getBoundingClientRect();
      const left = event.clientX - box.left, top = event.clientY - box.top;
      if (this.xIsTime) this.onTime(this.plot.posToVal(left, "x"));
      else this.onTime(this.timeAt(left, top));
    };
    over.addEventListener("pointerdown", (event) => {
      over.setPointerCapture(event.pointerId);
      follow(event);
    });
    over.addEventListener("pointermove", (event) => {
      if (event.buttons & 1) follow(event);
    });
  }

  /** Time of the nearest point of a line. */
  timeAt(left, top) {
    let best = this.time, distance = Infinity;
    for (const line of this.lines) {
      if (!line.times) continue;
      for (let i = 0; i < line.x.length; ++i) {
        const d = Math.hypot(this.plot.valToPos(line.x[i], "x") - left, this.plot.valToPos(line.y[i], "y") - top);
        if (d < distance) [best, distance] = [line.times[i], d];
      }
    }
    return best;
  }

  /** On the canvas, or on what takes its calls. */
  draw(u, ctx = u.ctx) {
    const ratio = window.devicePixelRatio || 1;
    const X = (v) => u.valToPos(v, "x", true), Y = (v) => u.valToPos(v, "y", true);
    ctx.save();
    ctx.beginPath();
    ctx.rect(u.bbox.left, u.bbox.top, u.bbox.width, u.bbox.height);
    ctx.clip();
    ctx.lineJoin = "round";
    for (const line of this.lines) {
      ctx.strokeStyle = ctx.fillStyle = line.color;
      ctx.lineWidth = (line.base ? 1 : 1.75) * ratio;
      ctx.setLineDash(line.dash ? [6 * ratio, 4 * ratio] : []);
      ctx.beginPath();
      let open = false;
      for (let i = 0; i < line.x.length; ++i) {
        if (!Number.isFinite(line.y[i]) || !Number.isFinite(line.x[i])) {
          open = false;
          continue;
        }
        if (open) ctx.lineTo(X(line.x[i]), line.step ? (ctx.lineTo(X(line.x[i]), Y(line.y[i - 1])), Y(line.y[i])) : Y(line.y[i]));
        else ctx.moveTo(X(line.x[i]), Y(line.y[i]));
        open = true;
      }
      if (line.base) {
        for (let i = line.x.length - 1; i >= 0; --i) ctx.lineTo(X(line.x[i]), Y(line.base[i]));
        ctx.closePath();
        ctx.globalAlpha = 0.8;
        ctx.fill();
        ctx.globalAlpha = 1;
      } else {
        ctx.stroke();
      }
      if (line.dots)
        for (let i = 0; i < line.x.length; ++i) {
          ctx.beginPath();
          ctx.arc(X(line.x[i]), Y(line.y[i]), 2.6 * ratio, 0, 7);
          ctx.fill();
        }
    }
    ctx.setLineDash([]);
    if (this.time != null) this.mark(ctx, X, Y, u, ratio);
    ctx.restore();
  }

  mark(ctx, X, Y, u, ratio) {
    ctx.strokeStyle = style("--text-1");
    ctx.fillStyle = style("--text-1");
    if (this.xIsTime) {
      ctx.lineWidth = ratio;
      ctx.beginPath();
      ctx.moveTo(X(this.time), u.bbox.top);
      ctx.lineTo(X(this.time), u.bbox.top + u.bbox.height);
      ctx.stroke();
    }
    for (const line of this.lines) {
      if (line.base || line.measured) continue;
      const times = line.times ?? (this.xIsTime ? line.x : null);
      if (!times) continue;
      const i = nearest(times, this.time);
      if (!Number.isFinite(line.y[i])) continue;
      ctx.beginPath();
      ctx.arc(X(line.x[i]), Y(line.y[i]), 4 * ratio, 0, 7);
      ctx.fillStyle = line.color;
      ctx.fill();
      ctx.lineWidth = 1.5 * ratio;
      ctx.strokeStyle = style("--surface");
      ctx.stroke();
    }
  }
}

/** A legend: entries {label, color, dash, value(time) -> text, on, toggle}. */
export function legend(entries) {
  const values = [];
  const node = make("div", {class: "legend"}, entries.map((entry) => {
    const value = make("span", {class: "value"});
    values.push([entry, value]);
    const key = make("span", {class: entry.dash ? "key dash" : "key"});
    key.style.setProperty("--key", entry.color);
    const inside = [key, make("span", {}, entry.label), value];
    if (!entry.toggle) return make("span", {class: "entry"}, inside);
    return make("button", {class: "entry", type: "button", "aria-pressed": String(entry.on), onclick: entry.toggle}, inside);
  }));
  return {node, setTime: (time) => values.forEach(([entry, span_]) => (span_.textContent = entry.value ? entry.value(time) : ""))};
}
