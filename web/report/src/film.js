// The frames of a run: the reader of src/report/film.cpp.

import {blobBytes, Planes, unzigzag} from "./packed.js";

const KEPT = 3e8; // bytes of unpacked frames

function unscale(field, steps) {
  const values = new Float32Array(steps.length);
  if (field.category) {
    values.set(steps);
    return values;
  }
  const on = (v) => (field.root ? Math.sign(v) * Math.sqrt(Math.abs(v)) : v);
  const low = on(field.low), range = on(field.high) - low;
  const table = new Float32Array(field.last + 1);
  for (let q = 0; q <= field.last; ++q) {
    const place = low + (range * q) / field.last;
    table[q] = field.root ? Math.sign(place) * place * place : place;
  }
  for (let i = 0; i < steps.length; ++i) values[i] = table[steps[i]];
  return values;
}

const widthOf = (field) => (field.last < 256 ? 1 : field.last < 65536 ? 2 : field.last < 1 << 24 ? 3 : 4);

export class Film {
  constructor(meta) {
    this.meta = meta;
    this.times = meta.frames.map((f) => f.time);
    this.cache = new Map();
    this.kept = 0;
    this.first = null;
  }

  /** Corners of an element: of a sphere its centre. */
  get each() {
    return this.meta.solid ? 4 : this.meta.plane ? 3 : 1;
  }

  /** Points of a frame: centres of spheres, or the corners of triangles or tetrahedra. */
  get points() {
    return this.each * this.meta.elements;
  }

  get spheres() {
    return this.each === 1;
  }

  get axes() {
    return this.meta.plane ? 2 : 3;
  }

  /** Number of the frame nearest to a time. */
  nearest(time) {
    let best = 0;
    this.times.forEach((t, k) => {
      if (Math.abs(t - time) < Math.abs(this.times[best] - time)) best = k;
    });
    return best;
  }

  /** {position: x, y, z, radius of each point; fields; lines: {count, ends, fields}} */
  async frame(k) {
    if (this.cache.has(k)) return this.cache.get(k);
    if (k !== 0 && !this.first) await this.frame(0);
    const made = this.unpack(this.meta.frames[k], await blobBytes(this.meta.frames[k].blob));
    if (k === 0) this.first = made;
    this.cache.set(k, made);
    this.kept += made.size;
    for (const [old, frame] of this.cache) {
      if (this.kept < KEPT) break;
      if (old === k || old === 0) continue;
      this.cache.delete(old);
      this.kept -= frame.size;
    }
    return made;
  }

  unpack(info, bytes) {
    const {meta} = this, first = this.first;
    const planes = new Planes(bytes);
    const position = this.positions(planes);
    if (!first && this.spheres) {
      const steps = planes.numbers(meta.elements, 2);
      for (let i = 0; i < meta.elements; ++i) position[4 * i + 3] = (steps[i] * meta.largest_radius) / 65535;
    } else if (this.spheres) {
      for (let i = 0; i < meta.elements; ++i) position[4 * i + 3] = first.position[4 * i + 3];
    }
    const fields = {}, lines = {count: info.lines, fields: {}};
    for (const field of meta.fields) {
      if (field.lines) continue;
      fields[field.name] = first && field.constant ? first.fields[field.name] : this.field(planes, field, meta.elements);
    }
    lines.ends = info.ends ? this.ends(planes, info.lines) : first.lines.ends;
    for (const field of meta.fields) {
      if (!field.lines) continue;
      lines.fields[field.name] =
        info.ends || !field.constant ? this.field(planes, field, info.lines) : first.lines.fields[field.name];
    }
    const contacts = meta.contact_force ? this.contacts(planes, info.contacts) : null;
    const bolts = meta.bolt_force != null ? this.bolts(planes, info.bolts) : null;
    return {time: info.time, step: info.step, number: info.number, position, fields, lines, contacts, bolts, size: 8 * bytes.length + position.byteLength};
  }

  positions(planes) {
    const {meta, axes} = this, count = this.points;
    const position = new Float32Array(4 * count);
    const mask = meta.width === 2 ? 0xffff : 0xffffff;
    const start = !this.reference;
    if (start) this.reference = [];
    for (let axis = 0; axis < axes; ++axis) {
      const steps = planes.numbers(count, meta.width);
      if (start) {
        this.reference.push(steps);
      } else {
        const from = this.reference[axis], leader = this.leader, now = new Uint32Array(count);
        for (let i = 0; i < count; ++i) {
          let moved = unzigzag(steps[i]);
          if (leader && leader[i] !== i) moved += now[leader[i]] - from[leader[i]];
          now[i] = (from[i] + moved) & mask;
        }
        steps.set(now);
      }
      for (let i = 0; i < count; ++i) position[4 * i + axis] = meta.low[axis] + steps[i] * meta.step;
    }
    if (start && !this.spheres) this.leader = this.leaders();
    return position;
  }

  /** Of each corner the first one at the same place: see Positions in film.cpp. */
  leaders() {
    const [x, y, z] = this.reference, leader = new Uint32Array(x.length), inPlane = new Map(), inSpace = new Map();
    const first = (seen, key, i) => {
      const known = seen.get(key);
      if (known === undefined) seen.set(key, i);
      return known ?? i;
    };
    for (let i = 0; i < x.length; ++i) {
      leader[i] = first(inPlane, x[i] * 16777216 + y[i], i);
      if (z) leader[i] = first(inSpace, leader[i] * 16777216 + z[i], i);
    }
    return leader;
  }

  field(planes, field, count) {
    const width = widthOf(field);
    if (field.components === 1) return unscale(field, planes.numbers(count, width));
    const values = [];
    for (let c = 0; c < field.components; ++c) values.push(unscale(field, planes.numbers(count, width)));
    return values;
  }

  /** Both ends of each contact, with the force over the largest. */
  contacts(planes, count) {
    return this.segments(planes, count, (step) => (step / 63) ** 2);
  }

  /** Both ends of each piece of a bolt, with the force over the largest, pulled above 0. */
  bolts(planes, count) {
    return this.segments(planes, count, (step) => step / 127 - 1);
  }

  /** Of each eight numbers: x, y, z of an end and its share, twice. */
  segments(planes, count, share) {
    const {meta, axes} = this, ends = new Float32Array(8 * count);
    for (let axis = 0; axis < axes; ++axis) {
      const steps = planes.numbers(2 * count, meta.width);
      for (let e = 0; e < 2 * count; ++e) ends[4 * e + axis] = meta.low[axis] + steps[e] * meta.step;
    }
    const force = planes.numbers(count, 1);
    for (let i = 0; i < count; ++i) ends[8 * i + 3] = ends[8 * i + 7] = share(force[i]);
    return ends;
  }

  ends(planes, count) {
    const {meta, axes} = this;
    if (!this.spheres) {
      // x0, y0, x1, y1 of a line; of a joint of tetrahedra three times x, y, z and a gap.
      const points = meta.solid ? 3 : 2, stride = meta.solid ? 4 : 2;
      const ends = new Float32Array(points * stride * count);
      for (let axis = 0; axis < axes; ++axis) {
        const steps = planes.numbers(points * count, meta.width);
        for (let e = 0; e < points * count; ++e) ends[stride * e + axis] = meta.low[axis] + steps[e] * meta.step;
      }
      return ends;
    }
    const a = planes.numbers(count, 4), b = planes.numbers(count, 4);
    const ends = new Uint32Array(2 * count);
    let from = 0;
    for (let l = 0; l < count; ++l) {
      from += unzigzag(a[l]);
      ends[2 * l] = from;
      ends[2 * l + 1] = from + unzigzag(b[l]);
    }
    return ends;
  }
}

/** What can colour the elements: fields, components and lengths of vectors, displacement. */
export function colorings(film) {
  const list = [{name: "body", label: "body", unit: "", category: true, read: (f) => f.fields.group}];
  for (const field of film.meta.fields) {
    if (field.lines || field.name === "group" || field.name === "exposed") continue;
    const {name, unit, category} = field;
    if (field.components === 6) {
      TENSOR.forEach((part, c) =>
        list.push({name: `${name}_${part}`, label: `${name} ${part}`, unit, category: false, read: (f) => f.fields[name][c]}));
      continue;
    }
    if (field.components === 1) {
      list.push({name, label: name.replace(/_/g, " ") + (field.length ? " (length)" : ""), unit, category, read: (f) => f.fields[name]});
      continue;
    }
    list.push({name, label: name, unit, category: false, read: (f) => lengths(f.fields[name])});
    "xyz".slice(0, film.meta.plane ? 2 : 3).split("").forEach((axis, c) =>
      list.push({name: `${name}_${axis}`, label: `${name} ${axis}`, unit, category: false, read: (f) => f.fields[name][c]}));
  }
  list.push(...stressMeasures(film));
  const moved = (pick) => (f) => displacement(film, f, pick);
  list.push({name: "displacement", label: "displacement", unit: "m", read: moved((d) => Math.hypot(d[0], d[1], d[2]))});
  "xyz".slice(0, film.meta.plane ? 2 : 3).split("").forEach((axis, c) =>
    list.push({name: `displacement_${axis}`, label: `displacement ${axis}`, unit: "m", read: moved((d) => d[c])}));
  return list;
}

const TENSOR = ["xx", "yy", "zz", "xy", "yz", "xz"];

/** Single numbers of the stress, wherever it is: those of `breccia render --color stress_mises` and others. */
function stressMeasures(film) {
  const named = (name) => film.meta.fields.find((field) => !field.lines && field.name === name);
  const whole = named("stress")?.components === 6, unit = (named("stress") ?? named("stress_xx"))?.unit;
  if (!whole && !["xx", "yy", "xy"].every((part) => named(`stress_${part}`))) return [];
  const parts = (f) => TENSOR.map((part, c) => (whole ? f.fields.stress[c] : f.fields[`stress_${part}`]));
  const read = (measure) => (f) => {
    const of = parts(f), values = new Float32Array(of[0].length);
    for (let i = 0; i < values.length; ++i) values[i] = measure(...of.map((p) => (p ? p[i] : 0)));
    return values;
  };
  const ends = (xx, yy, zz, xy, yz, xz) => (film.meta.plane ? inPlane(xx, yy, xy) : inSpace(xx, yy, zz, xy, yz, xz));
  return [
    ["largest", "largest principal", (...s) => ends(...s)[0]],
    ["smallest", "smallest principal", (...s) => ends(...s)[1]],
    ["mean", "mean", (xx, yy, zz) => (xx + yy + zz) / 3],
    ["mises", "von Mises", (xx, yy, zz, xy, yz, xz) =>
      Math.sqrt(0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) + 3 * (xy * xy + yz * yz + xz * xz))],
    ["shear", "greatest shear", (...s) => (ends(...s)[0] - ends(...s)[1]) / 2],
  ].map(([name, label, measure]) => ({name: `stress_${name}`, label: `stress, ${label}`, unit, category: false, read: read(measure)}));
}

function inPlane(xx, yy, xy) {
  const mean = (xx + yy) / 2, radius = Math.hypot((xx - yy) / 2, xy);
  return [mean + radius, mean - radius];
}

/** The outer eigenvalues, from the invariants of the deviator. */
function inSpace(xx, yy, zz, xy, yz, xz) {
  const mean = (xx + yy + zz) / 3, x = xx - mean, y = yy - mean, z = zz - mean;
  const p = Math.sqrt((x * x + y * y + z * z + 2 * (xy * xy + yz * yz + xz * xz)) / 6);
  if (!(p > 0)) return [mean, mean];
  const det = x * (y * z - yz * yz) - xy * (xy * z - yz * xz) + xz * (xy * yz - y * xz);
  const phi = Math.acos(Math.min(1, Math.max(-1, (0.5 * det) / p ** 3))) / 3;
  return [mean + 2 * p * Math.cos(phi), mean + 2 * p * Math.cos(phi + (2 * Math.PI) / 3)];
}

function lengths(components) {
  const values = new Float32Array(components[0].length);
  for (let i = 0; i < values.length; ++i) values[i] = Math.hypot(...components.map((c) => c[i]));
  return values;
}

function displacement(film, frame, pick) {
  const {elements} = film.meta, {each} = film, from = film.first.position, to = frame.position;
  const values = new Float32Array(elements), d = [0, 0, 0];
  for (let i = 0; i < elements; ++i) {
    for (let c = 0; c < 3; ++c) {
      d[c] = 0;
      for (let k = 0; k < each; ++k) d[c] += (to[4 * (each * i + k) + c] - from[4 * (each * i + k) + c]) / each;
    }
    values[i] = pick(d);
  }
  return values;
}
