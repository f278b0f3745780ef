// Numbers, times and units as people write them.

const PREFIXES = [["G", 1e9], ["M", 1e6], ["k", 1e3], ["", 1], ["m", 1e-3], ["µ", 1e-6], ["n", 1e-9]];
const PREFIXABLE = new Set(["m", "s", "N", "Pa", "J", "N/m", "J/m", "m/s", "J/m2", "W"]);

/** A factor and a unit that bring `largest` between 1 and 1000: shown = value * factor. */
export function scaledUnit(unit, largest) {
  const plain = !unit || unit === "-" ? "" : unit;
  if (!(largest > 0) || !Number.isFinite(largest)) return {factor: 1, unit: plain};
  if (PREFIXABLE.has(plain)) {
    for (const [name, size] of PREFIXES)
      if (largest >= 0.9999 * size) return {factor: 1 / size, unit: name + plain};
    return {factor: 1e9, unit: "n" + plain};
  }
  if (largest >= 1e-2 && largest < 1e5) return {factor: 1, unit: plain};
  const power = Math.floor(Math.log10(largest));
  return {factor: 10 ** -power, unit: `10${superscript(power)}${plain ? " " + plain : ""}`};
}

const superscript = (n) => String(n).replace(/[-\d]/g, (c) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[c] ?? "⁻");

/** 0 where a value is rounding beside the largest one: sums and differences of that leave so much. */
export const aboveNoise = (value, largest) => Math.abs(value) < 1e-9 * largest ? 0 : value;

/** `digits` significant digits, without trailing zeros or an exponent where none is needed. */
export function round(value, digits = 4) {
  if (!Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e6 || size < 1e-4) {
    const [mantissa, exponent] = value.toExponential(digits - 1).split("e");
    return `${parseFloat(mantissa)}·10${superscript(parseInt(exponent, 10))}`;
  }
  return String(parseFloat(value.toPrecision(digits))).replace(/^-/, "−");
}

export function withUnit(value, unit, digits = 4) {
  if (!unit || unit === "-") return Number.isInteger(value) && Math.abs(value) < 1e12 ? count(value) : round(value, digits);
  const scaled = scaledUnit(unit, Math.abs(value));
  return `${round(value * scaled.factor, digits)}${scaled.unit ? " " + scaled.unit : ""}`;
}

/** What is nothing beside the largest of its kind is zero. */
export function besides(value, largest, unit) {
  return withUnit(Math.abs(value) < 1e-6 * largest ? 0 : value, unit, 3);
}

export const timeText = (seconds) => withUnit(seconds, "s", 4);
export const count = (number) => Math.round(number).toLocaleString("en-US");

export function duration(seconds) {
  if (seconds < 1) return `${Math.round(1000 * seconds)} ms`;
  if (seconds < 60) return `${seconds.toFixed(1)} s`;
  const whole = Math.round(seconds);
  if (whole < 3600) return `${Math.floor(whole / 60)} min ${whole % 60} s`;
  return `${Math.floor(whole / 3600)} h ${Math.floor((whole % 3600) / 60)} min`;
}

export function bytes(size) {
  return size < 1e6 ? `${Math.round(size / 1e3)} kB` : size < 1e9 ? `${round(size / 1e6, 3)} MB` : `${round(size / 1e9, 3)} GB`;
}

/** A name from a file, for people: "rock_velocity" becomes "rock velocity". */
export const words = (name) => name.replace(/_/g, " ");

/** A sentence from the program, which writes microseconds in ASCII. */
export const sentence = (text) => text.replace(/(\d) us\b/g, "$1 µs");

/** Hands the reader a file. */
export function save(blob, name) {
  const url = URL.createObjectURL(blob);
  make("a", {href: url, download: name}).click();
  setTimeout(() => URL.revokeObjectURL(url), 1000);
}

/** An element with attributes and children; text is never read as HTML. */
export function make(tag, attributes = {}, ...children) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("on")) node.addEventListener(name.slice(2), value);
    else if (name === "class") node.className = value;
    else if (value === true) node.setAttribute(name, "");
    else if (value !== false && value != null) node.setAttribute(name, value);
  }
  for (const child of children.flat(Infinity)) if (child != null && child !== false) node.append(child);
  return node;
}

const SVG = "http://www.w3.org/2000/svg";
export function draw(tag, attributes = {}, ...children) {
  const node = document.createElementNS(SVG, tag);
  for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
  for (const child of children.flat(Infinity)) if (child != null) node.append(child);
  return node;
}

/**
 * Marks of a logarithmic axis: 1 to 9 times each power of ten within it. Those of uPlot begin at the
 * axis' low end, and never come to its high end unless that is such a mark.
 */
export function logMarks(low, high) {
  const marks = [];
  for (let power = Math.floor(Math.log10(low)); power <= Math.log10(high); ++power)
    for (let k = 1; k < 10; ++k) {
      const mark = Number(`${k}e${power}`);
      if (mark >= low && mark <= high) marks.push(mark);
    }
  return marks;
}
