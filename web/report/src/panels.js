// Panels that do not move with time, and those that are charts of a run's tables.

import {Chart, legend, nearest} from "./chart.js";
import {LINES} from "./colors.js";
import {aboveNoise, besides, bytes, count, draw, duration, make, round, save, timeText, withUnit, words} from "./format.js";
import {blobText} from "./packed.js";

export function panel(title, about, ...children) {
  return make("section", {class: "panel"}, make("h2", {}, title), about && make("p", {class: "about"}, about), children);
}

const ENERGIES = {
  kinetic: "#56b4e9", elastic: "#0072b2", fracture: "#c8102e", plastic: "#e69f00", friction: "#8b6f2a", damping: "#7d7d7d", contact: "#cc79a7",
};

/** Energies as areas upon each other. */
export function energyPanel(run, history, store, several) {
  const time = history.column?.("time");
  if (!time) return null;
  let parts = Object.keys(ENERGIES).map((name) => history.column(name)).filter(Boolean);
  const work = history.column("work");
  const largest = [...parts, work].reduce((most, c) => c ? c.values.reduce((m, v) => Math.max(m, Math.abs(v)), most) : most, 0);
  parts = parts.filter((c) => c.values.some((v) => aboveNoise(v, largest) > 0));
  if (parts.length === 0) return null;
  const unit = parts[0].unit;
  let base = new Float32Array(history.rows);
  const lines = parts.map((part) => {
    const top = base.map((b, i) => b + Math.max(part.values[i], 0));
    const line = {label: part.name, color: ENERGIES[part.name], x: time.values, y: top, base};
    base = top;
    return line;
  });
  const at = (column) => (t) => withUnit(aboveNoise(column.values[nearest(time.values, t)], largest), column.unit, 3);
  const entries = parts.map((part) => ({label: part.name, color: ENERGIES[part.name], value: at(part)}));
  if (work && work.values.some((v) => v !== 0)) entries.push({label: "work put in", color: "transparent", value: at(work)});
  const key = legend(entries);
  const error = history.column("error_relative");
  const missing = error?.values.at(-1);
  const host = make("div", {class: "chart"});
  const node = panel(`Where the energy is${several ? `: ${run.label}` : ""}`, null, host, key.node,
    missing != null && make("p", {class: "note"}, `At the end ${round(100 * missing, 2)} % is missing from the ledger.`));
  return {node, start: () => timeChart(host, {lines, yUnit: unit}, key, store)};
}

function timeChart(host, options, key, store) {
  const chart = new Chart(host, {x: {label: "time", unit: "s"}, onTime: store.setTime, ...options});
  store.onTime((t) => {
    chart.setTime(t);
    key?.setTime(t);
  });
  return chart;
}

const FIXED = new Set(["step", "time", "dt", "work", "error_relative", ...Object.keys(ENERGIES)]);
const probesOf = (history) => history.columns.filter((c) => !FIXED.has(c.name));

/** Which column of a run a measured one belongs to: by its name, else by its unit. */
function partner(column, columns) {
  const plain = (name) => name.toLowerCase().replace(/[^a-z0-9]/g, "");
  return columns.find((c) => plain(c.name) === plain(column.name));
}

/** Probes over time or over each other; runs and measurements in one chart. */
export function curvePanel(runs, measured, store) {
  const time = runs[0].table.column?.("time");
  if (!time) return null;
  const probes = probesOf(runs[0].table);
  if (probes.length === 0 && !measured) return null;
  const xs = [time, ...probes];
  const first = measured && (partner(measured.columns[0], xs) ?? xs.find((c) => c.unit === measured.columns[0].unit));
  const force = probes.find((c) => c.unit === "N" || c.unit === "N/m") ?? probes[0];
  const chosen = {x: (first ?? time).name, ys: new Set()};
  for (const column of measured?.columns.slice(1) ?? []) {
    const found = partner(column, probes) ?? probes.find((c) => c.unit && c.unit === column.unit);
    if (found) chosen.ys.add(found.name);
  }
  const strain = probes.find((c) => c.unit === "-" && /strain/i.test(c.name)), stress = probes.filter((c) => c.unit === "Pa");
  const named = runs[0].curve, has = (name) => probes.some((c) => c.name === name);
  if (!measured && named && has(named.x) && has(named.y)) {
    chosen.x = named.x;
    chosen.ys.add(named.y);
  } else if (!measured && strain && stress.length > 0) {
    chosen.x = strain.name;
    stress.slice(0, 4).forEach((c) => chosen.ys.add(c.name));
  }
  if (chosen.ys.size === 0 && force) probes.filter((c) => c.unit === force.unit).slice(0, 4).forEach((c) => chosen.ys.add(c.name));
  const host = make("div", {class: "chart"}), below = make("div");
  const pick = make("select", {"aria-label": "over", onchange: () => {
    chosen.x = pick.value;
    build();
  }}, xs.map((c) => make("option", {value: c.name, selected: c.name === chosen.x}, words(c.name))));
  const node = panel("Curves", null, make("div", {class: "row"}, make("label", {}, "over ", pick),
    make("span", {class: "hint"}, "drag along a curve: the view follows")), host, below);
  let chart = null, key = null;

  function build() {
    chart?.destroy();
    host.replaceChildren();
    const entries = [], lines = [];
    let unit = null;
    probes.forEach((probe, p) => {
      const color = LINES[p % LINES.length], on = chosen.ys.has(probe.name);
      if (on) unit ??= probe.unit;
      runs.forEach((run, r) => {
        const x = run.table.column?.(chosen.x), y = run.table.column?.(probe.name), t = run.table.column?.("time");
        if (!x || !y || !on) return;
        lines.push({label: probe.name, color, x: x.values, y: y.values, dash: r > 0, times: x === t ? null : t.values});
      });
      const largest = probe.values.reduce((a, b) => Math.max(a, Math.abs(b)), 0);
      const value = (t) => {
        const rows = runs[0].table.column("time").values;
        return on ? besides(probe.values[nearest(rows, t)], largest, probe.unit) : "";
      };
      entries.push({label: words(probe.name), color, value, on, toggle: () => {
        // Curves of one unit share the axis.
        if (on) chosen.ys.delete(probe.name);
        else {
          for (const name of chosen.ys) if (probes.find((c) => c.name === name).unit !== probe.unit) chosen.ys.delete(name);
          chosen.ys.add(probe.name);
        }
        build();
      }});
    });
    measured?.columns.slice(1).forEach((column, m) => {
      const found = partner(column, probes);
      const color = found ? LINES[probes.indexOf(found) % LINES.length] : LINES[(probes.length + m) % LINES.length];
      lines.push({label: column.name, color, x: measured.columns[0].values.map(Number), y: column.values.map((v) => (v == null ? NaN : v)), dash: true, dots: column.values.length < 80, measured: true, times: null});
      entries.push({label: `${words(column.name)} (${measured.name})`, color, dash: true});
      unit ??= column.unit;
    });
    key = legend(entries);
    below.replaceChildren(key.node, runs.length > 1 ? make("p", {class: "note"}, `Dashed: ${runs[1].label}.`) : "");
    if (lines.length === 0) return;
    const x = xs.find((c) => c.name === chosen.x);
    chart = new Chart(host, {lines, x: {label: words(x.name), unit: x.unit}, yUnit: unit, height: 240, onTime: store.setTime});
    if (x === time) chart.xIsTime = true;
    if (store.time != null) {
      chart.setTime(store.time);
      key.setTime(store.time);
    }
  }
  store.onTime((t) => {
    chart?.setTime(t);
    key?.setTime(t);
  });
  return {node, start: build};
}

const KINDS = ["concrete", "steel", "interface", "parallel", "ldpm"]; // as LinkKind of src/dem/setup/model.hpp

/** How many links or joints are broken, over time. */
export function eventPanel(runs, store) {
  const lines = [], entries = [];
  let what = "links";
  const jointed = (run) => run.film?.plane || run.film?.solid;
  runs.forEach((run, r) => {
    const cracks = run.cracks.column?.("time");
    if (cracks && run.cracks.rows > 0) {
      const end = run.summary.time, mode = run.cracks.column("mode");
      what = jointed(run) ? "joints" : "links";
      const groups = mode ? [["by opening", (i) => mode.values[i] < 0.5, "#c8102e"], ["by sliding", (i) => mode.values[i] >= 0.5, "#1f5fbf"]] : [["broken", () => true, "#c8102e"]];
      for (const [label, is, color] of groups) {
        const x = [0], y = [0];
        for (let i = 0; i < run.cracks.rows; ++i)
          if (is(i)) {
            x.push(cracks.values[i]);
            y.push(y.length);
          }
        x.push(end);
        y.push(y[y.length - 1]);
        lines.push({label, color, x, y, step: true, dash: r > 0});
        if (r === 0) entries.push({label, color, value: (t) => count(y[Math.max(0, x.findLastIndex((v) => v <= t * 1.000001))])});
      }
    } else if (run.events?.some((e) => e.broken.some((b) => b > 0))) {
      if (jointed(run)) what = "joints";
      const x = run.events.map((e) => e.time), kinds = Math.max(...run.events.map((e) => e.broken.length));
      for (let k = 0; k < kinds; ++k) {
        const y = run.events.map((e) => e.broken[k] ?? 0);
        if (!y.some((v) => v > 0)) continue;
        const color = ["#c8102e", "#6b7280", "#1f77b4"][k] ?? LINES[k];
        lines.push({label: jointed(run) ? "broken" : KINDS[k], color, x, y, dash: r > 0});
        if (r === 0) entries.push({label: kinds > 1 ? KINDS[k] : "broken", color, value: (t) => count(y[nearest(x, t)])});
      }
    }
  });
  if (lines.length === 0) return null;
  const key = legend(entries), host = make("div", {class: "chart"});
  const node = panel(`Broken ${what}`, null, host, key.node, runs.length > 1 && make("p", {class: "note"}, `Dashed: ${runs[1].label}.`));
  return {node, start: () => timeChart(host, {lines, yUnit: "-", height: 190}, key, store)};
}

/** Histograms of directions as half or quarter roses. */
export function rosePanel(runs) {
  const all = runs.filter((run) => run.roses?.length);
  if (all.length === 0) return null;
  const node = panel("Where cracks point", null, make("div", {class: "row top"}, all.map((run) => make("div", {},
    runs.length > 1 && make("h3", {}, run.label), make("div", {class: "roses"}, run.roses.map(roseOf))))));
  if (all.length > 1) node.classList.add("double");
  return {node};
}

function roseOf(rose) {
  const largest = Math.max(...rose.bars, 1e-300), bars = rose.bars.length, reach = 86, wide = rose.to > 100;
  const center = wide ? 100 : 16, width = wide ? 200 : 124, height = 122;
  const at = (degrees, r) => {
    const angle = (degrees * Math.PI) / 180;
    return `${(center + r * Math.cos(angle)).toFixed(2)} ${(100 - r * Math.sin(angle)).toFixed(2)}`;
  };
  const arc = (a, b, r) => `M${at(a, 0)} L${at(a, r)} A${r} ${r} 0 0 0 ${at(b, r)} Z`;
  const wedges = rose.bars.map((bar, k) => {
    const a = rose.from + ((rose.to - rose.from) * k) / bars, b = rose.from + ((rose.to - rose.from) * (k + 1)) / bars;
    return draw("path", {d: arc(a, b, reach * Math.sqrt(bar / largest)), class: "wedge"}, draw("title", {}, `${a}° to ${b}°: ${withUnit(bar, rose.unit, 3)}`));
  });
  const rings = [0.5, 1].map((share) => draw("path", {d: `M${at(rose.from, reach * Math.sqrt(share))} A${reach * Math.sqrt(share)} ${reach * Math.sqrt(share)} 0 0 0 ${at(rose.to, reach * Math.sqrt(share))}`, class: "ring"}));
  const label = (degrees, text, dx = 0, dy = 0) => {
    const [x, y] = at(degrees, reach + 7).split(" ").map(Number);
    return draw("text", {x: x + dx, y: y + dy, class: "tick", "text-anchor": degrees === 90 && wide ? "middle" : degrees > 90 ? "end" : "start"}, text);
  };
  const labels = wide ? [label(0, "0°", -14, 12), label(90, "90°"), label(180, "180°", 24, 12)] : [label(0, "0°", -14, 12), label(90, "90°", 4, 4)];
  return make("figure", {},
    draw("svg", {viewBox: `0 -6 ${width} ${height}`, role: "img", "aria-label": rose.name, style: `width:${width}px`}, rings, draw("path", {d: `M${at(0, reach)} L${center} 100 L${at(rose.to, reach)}`, class: "ring"}), wedges, labels),
    make("figcaption", {}, rose.name));
}

/** How many pieces are at least of a size. */
export function fragmentPanel(runs) {
  const lines = runs.map((run, r) => {
    const shares = run.fragments ?? []; // falling
    if (shares.length < 2) return null;
    return {label: "pieces", color: LINES[r], x: shares, y: shares.map((_, k) => k + 1), dots: shares.length < 200, dash: r > 0};
  }).filter(Boolean);
  if (lines.length === 0) return null;
  const host = make("div", {class: "chart"}), run = runs.find((r) => r.fragments?.length > 1);
  const node = panel("Pieces", null, host, make("p", {class: "note"},
    `${count(run.fragments.length)} pieces; the largest holds ${round(100 * run.fragments[0], 3)} % of all. The curve tells how many are at least of a size.`));
  return {node, start: () => new Chart(host, {lines, x: {label: "share of a piece in all", unit: ""}, yUnit: "", logX: true, logY: true, height: 190})};
}

/** Where the wall time went. */
export function stagePanel(runs) {
  const bars = runs.map((run) => {
    const {stages_s: stages = {}, wall_s: wall = {}} = run.summary;
    const all = Object.entries(stages).filter(([name]) => name !== "output");
    const known = all.reduce((sum, [, s]) => sum + s, 0);
    if (wall.loop > known) all.push(["other", wall.loop - known]);
    if (wall.output) all.push(["output", wall.output]);
    if (wall.setup) all.push(["setup", wall.setup]);
    return all.filter(([, s]) => s > 0).sort((a, b) => b[1] - a[1]);
  });
  if (bars[0].length === 0) return null;
  const total = bars[0].reduce((sum, [, s]) => sum + s, 0);
  const rows = bars[0].filter(([, s], k) => s > 0.002 * total && k < 9).map(([name, seconds]) => {
    const bar = make("span", {class: "bar"});
    bar.style.width = `${(100 * seconds) / bars[0][0][1]}%`;
    const other = bars[1]?.find(([n]) => n === name)?.[1];
    return make("tr", {}, make("th", {scope: "row"}, words(name)), make("td", {class: "number"}, duration(seconds)),
      bars[1] ? make("td", {class: "number"}, other == null ? "–" : duration(other)) : make("td", {class: "bars"}, bar));
  });
  const {step_us: step = {}} = runs[0].summary;
  return {node: panel("Where the time went", null, make("table", {class: "stages"},
    bars[1] && make("thead", {}, make("tr", {}, make("th"), runs.map((r) => make("th", {class: "number wrap"}, r.label)))),
    make("tbody", {}, rows)),
    make("p", {class: "note"}, `${duration(runs[0].summary.wall_s?.total ?? total)} in all${step.median ? `; half of the steps took less than ${withUnit(1e-6 * step.median, "s", 3)}` : ""}.`))};
}

export function checkPanel(runs) {
  const tables = runs.filter((run) => run.summary.checks?.length).map((run) => make("div", {class: "scroll"}, make("table", {class: "checks"},
    runs.length > 1 && make("caption", {}, run.label),
    make("thead", {}, make("tr", {}, ["check", "value", "expected", "tolerance", ""].map((h, i) => make("th", {class: i > 0 && i < 4 ? "number" : null}, h)))),
    make("tbody", {}, run.summary.checks.map((check) => {
      const unit = check.unit === "-" ? "" : check.unit;
      const text = (v) => (v == null ? "none" : withUnit(v, unit, 4));
      return make("tr", {}, make("th", {scope: "row"}, check.name), make("td", {class: "number"}, text(check.value)), make("td", {class: "number"}, text(check.expected)),
        make("td", {class: "number"}, `± ${text(check.tolerance)}`), make("td", {}, make("span", {class: check.pass ? "chip good" : "chip bad"}, check.pass ? "pass" : "fail")));
    })))));
  return tables.length === 0 ? null : {node: panel("Checks of the case", null, tables)};
}

/** What makes the run again, and what it was made with. */
export function provenancePanel(runs) {
  return {node: panel("How to make it again", null, runs.map((run) => {
    const s = run.summary, machine = s.machine ?? {}, build = s.breccia ?? {};
    const command = `${machine.ranks > 1 ? `mpirun -n ${machine.ranks} ` : ""}breccia run case.toml -o again${machine.device && !/^cpu/.test(machine.device) ? " --device cuda" : ""} --threads ${machine.threads ?? 1}`;
    const copy = make("button", {type: "button", onclick: async () => {
      await navigator.clipboard?.writeText(command).catch(() => {});
      copy.textContent = "copied";
    }}, "copy");
    const saveCase = run.case != null && make("button", {type: "button", onclick: async () => save(new Blob([await blobText(run.case)], {type: "text/plain"}), "case.toml")}, "save case.toml");
    const facts = [
      ["case", `${s.case?.name ?? ""}${s.case?.seed != null ? `, seed ${s.case.seed}` : ""}`],
      ["state hash", s.state_hash && make("code", {}, s.state_hash)],
      ["case digest", s.case?.sha256 && make("code", {class: "long"}, s.case.sha256)],
      ["program", build.version && `breccia ${build.version ?? ""} ${build.commit ? `(${build.commit})` : ""}, ${build.build?.type ?? ""}, ${build.build?.compiler ?? ""}`],
      ["machine", machine.cpu && `${machine.cpu}, ${machine.device ?? "cpu"}, ${machine.threads ?? 1} thread${machine.threads > 1 ? "s" : ""}${machine.ranks > 1 ? `, ${machine.ranks} ranks` : ""}`],
      ["precision", s.precision],
      ["steps", s.dt && `${count(s.steps)} of ${timeText(s.dt.min)}${s.dt.max > 1.001 * s.dt.min ? ` to ${timeText(s.dt.max)}` : ""}${s.dt.ruled_by ? `, ruled by ${s.dt.ruled_by}` : ""}`],
      ["memory", s.peak_memory_bytes && bytes(s.peak_memory_bytes)],
    ].filter(([, value]) => value);
    return make("div", {class: "provenance"}, runs.length > 1 && make("h3", {}, run.label),
      make("div", {class: "command"}, make("code", {}, command.split(" ").map((word, k) => [k > 0 && " ", make("span", {}, word)])), copy, saveCase),
      make("p", {class: "note"}, "The hash of the last state does not depend on threads, ranks or device: a run of this case with the same program ends with the same one. Files that the case names (meshes, tables) must lie beside case.toml."),
      make("dl", {}, facts.flatMap(([name, value]) => [make("dt", {}, name), make("dd", {}, value)])));
  }))};
}
