// The panel with the view: one run or two with one camera, and what decides how they are drawn.

import {CATEGORIES, gradient, MAPS} from "./colors.js";
import {Film, colorings} from "./film.js";
import {make, round, save, scaledUnit, timeText, words} from "./format.js";
import {Viewer} from "./viewer.js";

/** Values at two shares of the way through the sorted finite ones. */
function percentiles(values, shares) {
  const step = Math.max(1, Math.floor(values.length / 20000)), picked = [];
  for (let i = 0; i < values.length; i += step) if (Number.isFinite(values[i])) picked.push(values[i]);
  picked.sort((a, b) => a - b);
  return shares.map((s) => picked[Math.round(s * (picked.length - 1))] ?? 0);
}

export class ViewPanel {
  constructor(runs, store) {
    this.runs = runs.filter((run) => run.film);
    this.store = store;
    this.views = this.runs.map((run) => {
      const film = new Film(run.film);
      const canvas = make("div", {class: "canvas", role: "img", "aria-label": `view of ${run.label}`});
      const host = make("div", {class: "view"}, canvas, this.runs.length > 1 && make("span", {class: "corner"}, run.label));
      return {run, film, host, canvas, viewer: null, wanted: 0, shown: -1};
    });
    this.film = this.views[0].film;
    this.plane = this.film.meta.plane;
    this.bodies = this.film.meta.solid;
    this.colorings = colorings(this.film).filter((c) => c.name !== "body" || this.film.meta.fields.some((f) => f.name === "group"));
    const named = (name) => this.colorings.find((c) => c.name === name);
    this.coloring = named(this.runs[0].color) ?? named("damage") ?? this.colorings[0];
    this.groups = this.film.meta.groups.length ? this.film.meta.groups : ["elements"];
    this.body = new Array(16).fill(1);
    this.build();
  }

  build() {
    this.caption = make("output", {class: "caption"});
    this.slider = make("input", {type: "range", min: 0, max: this.film.times.length - 1, step: 1, value: 0, "aria-label": "frame",
      oninput: () => this.store.setTime(this.film.times[Number(this.slider.value)])});
    this.play = make("button", {type: "button", class: "play", "aria-label": "play", onclick: () => this.playing ? this.stop() : this.begin()}, "▶");
    this.node = make("section", {class: "panel view-panel"},
      make("div", {class: `views n${this.views.length}`}, this.views.map((v) => v.host)),
      this.legend = make("div", {class: "scale"}),
      make("div", {class: "time"}, this.play, this.slider, this.caption),
      make("div", {class: "controls"}, this.controls()));
    this.node.tabIndex = -1;
  }

  /** Camera and colouring, as choose() takes them. */
  chosen() {
    return {camera: this.views[0].viewer?.cameraState(), coloring: this.coloring.name};
  }

  choose({camera, coloring}) {
    if (camera) this.each((v) => v.setCamera(camera));
    this.pickColoring(coloring);
  }

  pickColoring(name) {
    const found = this.colorings.find((c) => c.name === name);
    if (!found || found === this.coloring) return;
    this.coloring = found;
    this.fieldPick.value = name;
    this.range = null;
    this.map = null;
    this.recolor();
  }

  /** The camera as `breccia render --camera FILE` reads it. */
  async copyCamera() {
    const viewer = this.views[0].viewer;
    if (!viewer) return;
    const text = viewer.cameraText();
    try {
      await navigator.clipboard.writeText(text);
      this.caption.textContent = "camera copied: paste it into a file for breccia render --camera";
    } catch {
      save(new Blob([text], {type: "text/plain"}), "camera.toml"); // no clipboard for pages from a disk
    }
  }

  controls() {
    const field = this.fieldPick = make("select", {onchange: () => this.pickColoring(field.value)}, this.colorings.map((c) => make("option", {value: c.name, selected: c === this.coloring}, c.label)));
    this.mapPick = make("select", {"aria-label": "colours", onchange: () => {
      this.map = this.mapPick.value;
      this.recolor();
    }}, Object.keys(MAPS).map((m) => make("option", {value: m}, m)));
    const bound = (end) => make("input", {type: "text", inputmode: "decimal", class: "bound", "aria-label": end ? "highest colour" : "lowest colour", onchange: (event) => {
      const value = parseFloat(event.target.value.replace("−", "-").replace("·10", "e"));
      this.range = [...(this.range ?? this.used)];
      if (Number.isFinite(value)) this.range[end] = value / this.unit.factor;
      else this.range = null;
      this.recolor();
    }});
    this.bounds = [bound(0), bound(1)];
    const list = [
      make("div", {class: "group"}, make("label", {}, "colour ", field), this.mapPick, make("span", {class: "bounds"}, this.bounds[0], "to", this.bounds[1])),
    ];
    const bodies = this.groups.slice(0, 16).map((name, g) => this.bodyButton(name, g));
    list.push(make("div", {class: "group"}, bodies));
    const toggle = (label, on, apply) => {
      const button = make("button", {type: "button", "aria-pressed": String(on), onclick: () => {
        const now = button.getAttribute("aria-pressed") !== "true";
        button.setAttribute("aria-pressed", String(now));
        apply(now);
        this.each((v) => {
          v.fillLines();
          v.redraw();
        });
      }}, label);
      return button;
    };
    const toggles = [];
    if (this.plane) {
      toggles.push(toggle("mesh", true, (on) => this.each((v) => (v.uniforms.uMesh.value = on ? 1 : 0))));
      toggles.push(this.cracksButton = toggle("cracks", true, (on) => this.each((v) => (v.cracks.visible = on))));
    } else if (this.bodies) {
      toggles.push(toggle("mesh", true, (on) => this.each((v) => (v.uniforms.uMesh.value = on ? 1 : 0))));
      toggles.push(this.xrayButton = toggle("x-ray", false, (on) => this.xray(on)));
      toggles.push(this.cracksButton = toggle("cracks", true, (on) => this.each((v) => (v.cracks.visible = on))));
    } else {
      const links = this.film.meta.frames[0].lines > 0, forces = this.film.meta.fields.some((f) => f.lines && f.name === "force");
      if (links) {
        toggles.push(this.xrayButton = toggle("x-ray", false, (on) => this.xray(on)));
        toggles.push(this.cracksButton = toggle("cracks", false, (on) => this.each((v) => (v.cracks.visible = on))));
        toggles.push(toggle("links", false, (on) => {
          this.each((v) => (v.links.visible = on));
        }));
        if (forces) toggles.push(toggle("forces", false, (on) => {
          this.each((v) => (v.forces.visible = on));
        }));
      }
    }
    if (this.film.meta.contact_force)
      toggles.push(this.contactsButton = toggle("contact forces", false, (on) => this.each((v) => {
        if (v.contacts) v.contacts.visible = on && v.uniforms.uScale.value === 1;
      })));
    if (this.film.meta.bolt_force != null)
      toggles.push(this.boltsButton = toggle("bolts", true, (on) => this.each((v) => {
        if (v.bolts) v.bolts.visible = on && v.uniforms.uScale.value === 1;
      })));
    if (!this.plane) {
      if (this.runs.some((r) => r.walls?.length)) toggles.push(toggle("walls", true, (on) => this.each((v) => (v.surroundings.visible = on))));
    }
    if (this.runs.some((r) => r.regions?.length)) toggles.push(toggle("supports", false, (on) => this.each((v) => (v.regions.visible = on))));
    list.push(make("div", {class: "group"}, toggles));
    list.push(this.scaleControl());
    if (!this.plane) list.push(this.clipControl());
    list.push(make("div", {class: "group"}, (this.plane ? ["z"] : ["iso", "x", "y", "z"]).map((view) =>
      make("button", {type: "button", onclick: () => this.each((v) => v.look(view))}, this.plane ? "fit" : view)),
      make("button", {type: "button", onclick: () => this.savePicture()}, "save picture"),
      make("button", {type: "button", onclick: () => this.copyCamera()}, "copy camera")));
    return list;
  }

  bodyButton(name, g) {
    const states = ["hidden", "solid", "x-ray"];
    const button = make("button", {type: "button", class: "body", title: "solid, x-ray or hidden", onclick: () => {
      this.setBody(g, {1: 2, 2: 0, 0: 1}[this.body[g]]);
    }});
    const key = make("span", {class: "key"});
    key.style.setProperty("--key", CATEGORIES[g % CATEGORIES.length]);
    const text = make("span");
    button.append(key, text);
    this.bodyButtons ??= [];
    this.bodyButtons[g] = () => {
      button.dataset.state = states[this.body[g]];
      text.textContent = this.body[g] === 1 ? words(name) : `${words(name)}: ${states[this.body[g]]}`;
    };
    this.bodyButtons[g]();
    return button;
  }

  setBody(g, state) {
    this.body[g] = state;
    this.bodyButtons[g]?.();
    this.each((v) => {
      v.uniforms.uBody.value = [...this.body];
      v.redraw();
    });
  }

  /** The largest body seen through, with what is inside: bars and cracks. */
  xray(on) {
    const first = this.film.first?.fields.group ?? (this.bodies ? [0] : null);
    if (!first) return;
    const sizes = new Array(16).fill(0);
    for (const g of first) sizes[Math.min(g, 15)]++;
    const largest = sizes.indexOf(Math.max(...sizes));
    this.setBody(largest, on ? 2 : 1);
    const steel = this.groups.findIndex((name) => /steel|bar|rebar/i.test(name));
    if (steel >= 0 && steel !== largest) this.setBody(steel, on ? 2 : 1);
    this.each((v) => {
      if (v.bars) v.bars.visible = on;
      v.fillLines();
    });
    if (on && this.cracksButton.getAttribute("aria-pressed") !== "true") this.cracksButton.click();
  }

  scaleControl() {
    const text = make("output", {}, "1×");
    const factors = [0, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000];
    const input = make("input", {type: "range", min: 0, max: factors.length - 1, step: 1, value: 1, "aria-label": "displacement", title: this.plane || this.bodies ? "cracks are drawn at 1× only" : "how large displacements are drawn", oninput: () => {
      const factor = factors[Number(input.value)];
      text.textContent = `${factor}×`;
      this.each((v) => {
        v.uniforms.uScale.value = factor;
        if (v.contacts) v.contacts.visible = factor === 1 && this.contactsButton?.getAttribute("aria-pressed") === "true";
        if (v.bolts) v.bolts.visible = factor === 1 && this.boltsButton?.getAttribute("aria-pressed") === "true";
        v.fillContacts();
        if (this.plane || this.bodies) v.cracks.visible = factor === 1 && this.cracksButton.getAttribute("aria-pressed") === "true";
        v.redraw();
      });
    }});
    return make("div", {class: "group"}, make("label", {}, "displacement ", input), text);
  }

  clipControl() {
    const axis = make("select", {"aria-label": "clip", onchange: () => apply()}, ["no cut", "x", "y", "z"].map((a) => make("option", {value: a}, a)));
    const place = make("input", {type: "range", min: 0, max: 1000, value: 500, "aria-label": "place of the cut", oninput: () => apply()});
    const flip = make("button", {type: "button", "aria-pressed": "false", onclick: () => {
      flip.setAttribute("aria-pressed", String(flip.getAttribute("aria-pressed") !== "true"));
      apply();
    }}, "other side");
    const text = make("output");
    const apply = () => {
      const a = "xyz".indexOf(axis.value);
      place.disabled = flip.disabled = a < 0;
      this.each((v) => {
        if (a < 0) v.clip = null;
        else {
          const low = v.box.low.getComponent(a), high = v.box.high.getComponent(a);
          const at = low + ((high - low) * Number(place.value)) / 1000;
          const back = flip.getAttribute("aria-pressed") === "true";
          // The half towards the camera of the first view goes.
          v.clip = {axis: a, sign: (a === 1 ? -1 : 1) * (back ? -1 : 1), at};
          text.textContent = `${axis.value} = ${round(at, 3)} m`;
        }
        v.redraw();
      });
      if (a < 0) text.textContent = "";
    };
    this.clipAxis = axis;
    place.disabled = flip.disabled = true;
    return make("div", {class: "group"}, make("label", {}, "cut ", axis), place, flip, text);
  }

  each(work) {
    for (const {viewer} of this.views) if (viewer) work(viewer);
  }

  async start() {
    for (const view of this.views) {
      try {
        view.viewer = new Viewer(view.canvas, view.run, view.film);
      } catch {
        view.host.append(make("p", {class: "note"}, "This browser has no WebGL 2, so there is no view here. The curves below need none."));
        continue;
      }
      await view.viewer.start();
      view.bar = make("span", {class: "bar-of-scale"}, make("span"));
      view.host.append(view.bar);
      view.viewer.drawn = (viewer) => this.drawn(view, viewer);
      view.viewer.turned = (viewer) => this.each((other) => other !== viewer && other.follow(viewer));
      this.keyboard(view.canvas);
    }
    await this.recolor();
    this.store.onTime((t) => this.show(t));
    this.store.setTime(this.film.times[this.film.times.length - 1]);
  }

  keyboard(canvas) {
    canvas.tabIndex = 0;
    canvas.addEventListener("keydown", (event) => {
      const step = {ArrowRight: 1, ArrowLeft: -1}[event.key];
      if (step) {
        const k = Math.min(Math.max(Number(this.slider.value) + step, 0), this.film.times.length - 1);
        this.store.setTime(this.film.times[k]);
      } else if (event.key === " ") this.play.click();
      else return;
      event.preventDefault();
    });
  }

  drawn(view, viewer) {
    const metres = 90 * viewer.metresPerPixel, power = 10 ** Math.floor(Math.log10(metres));
    const length = [5, 2, 1].map((m) => m * power).find((l) => l <= metres) ?? power;
    const scaled = scaledUnit("m", length);
    view.bar.style.width = `${(length / viewer.metresPerPixel).toFixed(1)}px`;
    view.bar.firstChild.textContent = `${round(length * scaled.factor, 3)} ${scaled.unit}`;
  }

  /** Shows the frames nearest to a time; of many calls the last one counts. */
  async show(time) {
    const k = this.film.nearest(time);
    this.slider.value = k;
    const info = this.film.meta.frames[k];
    this.caption.textContent = `${timeText(info.time)} · frame ${info.number}`;
    await Promise.all(this.views.map(async (view) => {
      view.wanted = view.film.nearest(time);
      if (view.busy || !view.viewer) return;
      view.busy = true;
      while (view.shown !== view.wanted) {
        const now = view.wanted, frame = await view.film.frame(now);
        view.viewer.show(frame, this.read(view.film, frame));
        view.shown = now;
      }
      view.busy = false;
    }));
  }

  read(film, frame) {
    const own = film === this.film ? this.coloring : colorings(film).find((c) => c.name === this.coloring.name);
    try {
      return own?.read(frame) ?? null;
    } catch {
      return null; // the other run has no such field
    }
  }

  async recolor() {
    const {coloring, film} = this, last = film.times.length - 1;
    let low = 0, high = 1;
    if (!coloring.category && coloring.name !== "damage") {
      low = Infinity;
      high = -Infinity;
      for (const k of new Set([0, Math.floor(last / 2), last])) {
        const [a, b] = percentiles(coloring.read(await film.frame(k)), [0.01, 0.99]);
        low = Math.min(low, a);
        high = Math.max(high, b);
      }
      if (low < 0 && high > 0) high = Math.max(high, -low), low = -high;
      else if (low > 0 && low < 0.3 * high) low = 0;
      if (!(high > low)) high = low + (Math.abs(low) || 1);
    }
    this.used = this.range ?? [low, high];
    const map = this.map ?? (coloring.name === "damage" ? "damage" : low < 0 && high > 0 ? "diverging" : "viridis");
    this.mapPick.value = map;
    this.unit = scaledUnit(coloring.unit, Math.max(...this.used.map(Math.abs)));
    const text = (v) => round(v * this.unit.factor, 3);
    this.bounds.forEach((input, end) => {
      input.value = text(this.used[end]);
      input.parentElement.hidden = Boolean(coloring.category);
    });
    this.mapPick.hidden = Boolean(coloring.category);
    const names = coloring.name === "body" ? this.groups : null;
    if (coloring.category) {
      this.legend.replaceChildren(make("span", {class: "what"}, coloring.label), ...(names ?? []).slice(0, 10).map((name, g) => {
        const key = make("span", {class: "key"});
        key.style.setProperty("--key", CATEGORIES[g % CATEGORIES.length]);
        return make("span", {class: "entry"}, key, words(name));
      }));
    } else {
      const bar = make("span", {class: "ramp"});
      bar.style.background = gradient(map);
      const middle = 0.5 * (this.used[0] + this.used[1]);
      this.legend.replaceChildren(make("span", {class: "what"}, `${coloring.label}${this.unit.unit ? ` [${this.unit.unit}]` : ""}`),
        make("span", {class: "ramp-box"}, bar, make("span", {class: "ticks"}, [this.used[0], middle, this.used[1]].map((v) => make("span", {}, text(v))))));
    }
    for (const view of this.views) {
      if (!view.viewer) continue;
      view.viewer.color({category: coloring.category, map, low: this.used[0], high: this.used[1]});
      const k = Math.max(view.shown, 0), frame = await view.film.frame(k);
      view.viewer.show(frame, this.read(view.film, frame));
      view.shown = k;
    }
  }

  begin() {
    this.playing = true;
    this.play.textContent = "❚❚";
    this.play.setAttribute("aria-label", "pause");
    const last = this.film.times.length - 1;
    if (Number(this.slider.value) >= last) this.store.setTime(this.film.times[0]);
    const pause = Math.max(60, Math.min(400, 6000 / Math.max(last, 1)));
    const next = async () => {
      if (!this.playing) return;
      const k = Number(this.slider.value) + 1;
      if (k > last) return this.stop();
      this.store.setTime(this.film.times[k]);
      setTimeout(next, pause);
    };
    setTimeout(next, pause);
  }

  stop() {
    this.playing = false;
    this.play.textContent = "▶";
    this.play.setAttribute("aria-label", "play");
  }

  savePicture() {
    const [{viewer, run}] = this.views;
    if (!viewer) return;
    viewer.draw();
    viewer.renderer.domElement.toBlob((blob) => save(blob, `${run.name || "breccia"}.png`));
  }
}
