// A chart as a file of SVG: its lines by the text that draws them on the canvas, its axes by uPlot's marks.

import {draw, words} from "./format.js";

const short = (v) => Math.round(100 * v) / 100;

/** Takes the calls of a canvas that a chart makes, and leaves them as elements. */
class Paper {
  constructor() {
    Object.assign(this, {parts: [], path: "", dash: [], lineWidth: 1, globalAlpha: 1, strokeStyle: "", fillStyle: ""});
  }
  save() {}
  restore() {}
  rect() {}
  clip() {}
  beginPath() { this.path = ""; }
  moveTo(x, y) { this.path += `M${short(x)} ${short(y)}`; }
  lineTo(x, y) { this.path += `L${short(x)} ${short(y)}`; }
  closePath() { this.path += "Z"; }
  arc(x, y, r) { this.path += `M${short(x - r)} ${short(y)}a${r} ${r} 0 1 0 ${2 * r} 0a${r} ${r} 0 1 0 ${-2 * r} 0`; }
  setLineDash(dash) { this.dash = dash; }
  fill() { this.add({fill: this.fillStyle, "fill-opacity": this.globalAlpha}); }
  stroke() {
    this.add({fill: "none", stroke: this.strokeStyle, "stroke-width": this.lineWidth, "stroke-linejoin": "round", ...(this.dash.length ? {"stroke-dasharray": this.dash.join(" ")} : {})});
  }
  add(look) {
    if (this.path) this.parts.push(draw("path", {d: this.path, ...look}));
  }
}

/** `chart`: a Chart; `style(name)`: a colour of the page. */
export function svgOf(chart, style) {
  const {plot: u, lines, labels} = chart, ratio = window.devicePixelRatio || 1;
  const {left, top, width, height} = u.bbox, bottom = top + height;
  const all = u.ctx.canvas.width, row = 18 * ratio;
  const high = u.ctx.canvas.height + row * (lines.length + 0.5);
  const text = (x, y, anchor, said, more = {}) => draw("text", {x: short(x), y: short(y), "text-anchor": anchor, fill: style("--text-2"), ...more}, said);
  const marks = [0, 1].flatMap((k) => {
    const {_splits: at, _values: said} = u.axes[k];
    return at.flatMap((value, i) => {
      const place = u.valToPos(value, k ? "y" : "x", true), line = {stroke: style("--grid"), "stroke-width": ratio};
      if (k) return [draw("line", {x1: left, x2: left + width, y1: short(place), y2: short(place), ...line}), text(left - 8 * ratio, place + 4 * ratio, "end", said[i] ?? "")];
      return [draw("line", {x1: short(place), x2: short(place), y1: top, y2: bottom, ...line}), text(place, bottom + 17 * ratio, "middle", said[i] ?? "")];
    });
  });
  const paper = new Paper();
  chart.draw(u, paper);
  const names = lines.flatMap((line, i) => {
    const y = u.ctx.canvas.height + row * (i + 0.5);
    return [draw("line", {x1: left, x2: left + 2 * row, y1: y, y2: y, stroke: line.color, "stroke-width": 3 * ratio, ...(line.dash ? {"stroke-dasharray": `${6 * ratio} ${4 * ratio}`} : {})}), text(left + 2.4 * row, y + 4 * ratio, "start", words(line.label))];
  });
  const middle = top + 0.5 * height;
  const picture = draw("svg", {xmlns: "http://www.w3.org/2000/svg", width: short(all / ratio), height: short(high / ratio), viewBox: `0 0 ${all} ${short(high)}`, "font-family": "system-ui, sans-serif", "font-size": 12 * ratio},
    draw("rect", {width: all, height: short(high), fill: style("--surface")}),
    draw("clipPath", {id: "within"}, draw("rect", {x: left, y: top, width, height})),
    marks, draw("g", {"clip-path": "url(#within)"}, paper.parts), names,
    text(left + 0.5 * width, bottom + 34 * ratio, "middle", labels[0]),
    text(12 * ratio, middle, "middle", labels[1], {transform: `rotate(-90 ${12 * ratio} ${middle})`}));
  return new XMLSerializer().serializeToString(picture);
}
