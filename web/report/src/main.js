// The page of `breccia report`: reads the data that the program put into it and builds the panels.

import "uplot/dist/uPlot.min.css";
import "./style.css";
import {count, duration, make, sentence, timeText} from "./format.js";
import {keepUp, restore} from "./live.js";
import {readTable} from "./packed.js";
import * as panels from "./panels.js";
import {ViewPanel} from "./view_panel.js";

/** The moment that all panels show. */
class Store {
  constructor() {
    this.listeners = [];
    this.time = null;
    this.setTime = (time) => {
      if (time == null || !Number.isFinite(time)) return;
      this.time = time;
      for (const listener of this.listeners) listener(time);
    };
  }
  onTime(listener) {
    this.listeners.push(listener);
  }
}

function heading(runs) {
  return make("header", {}, runs.map((run) => {
    const s = run.summary, good = s.status === "done";
    const model = s.model ?? {}, fracture = s.fracture ?? {};
    const facts = [
      model.elements && `${count(model.elements)} elements`, model.triangles && `${count(model.triangles)} triangles`,
      model.tetrahedra && `${count(model.tetrahedra)} tetrahedra`,
      model.links && `${count(model.links)} links`, model.joints && `${count(model.joints)} joints`,
      s.time != null && timeText(s.time), s.steps != null && `${count(s.steps)} steps`,
      s.wall_s?.total && duration(s.wall_s.total), fracture.fragments > 1 && `${count(fracture.fragments)} pieces`,
    ].filter(Boolean);
    return make("div", {class: "title"}, runs.length > 1 && make("p", {class: "run"}, run.label),
      make("h1", {}, run.title || run.name), make("p", {class: "facts"}, make("span", {class: good ? "chip good" : "chip bad"}, s.status ?? "unknown"), facts.map((f) => make("span", {}, f))),
      s.message && make("p", {class: "message"}, s.message));
  }));
}

function why(runs) {
  return make("section", {class: "why"}, runs.map((run) => make("div", {}, runs.length > 1 && make("h3", {}, run.label), run.why.map((text) => make("p", {}, sentence(text))))));
}

function remarks(runs) {
  const texts = runs.flatMap((run) => [...run.notes, ...run.warnings].map((text) => (runs.length > 1 ? `${run.label}: ${text}` : text)));
  return texts.length === 0 ? null : panels.panel("Remarks", null, make("ul", {class: "remarks"}, texts.map((t) => make("li", {}, sentence(t)))));
}

async function build() {
  const data = JSON.parse(document.getElementById("data").textContent);
  const store = new Store(), {runs, measured} = data;
  const alike = runs.length > 1 && runs[0].name === runs[1].name;
  runs.forEach((run) => (run.label = (alike ? run.folder : run.name) || run.name));
  for (const run of runs) {
    run.table = await readTable(run.history);
    run.cracks = await readTable(run.cracks);
  }
  document.getElementById("wait")?.remove();
  const view = runs.some((run) => run.film) ? new ViewPanel(runs, store) : null;
  const side = [panels.curvePanel(runs, measured, store), ...runs.map((run) => panels.energyPanel(run, run.table, store, runs.length > 1))].filter(Boolean);
  const below = [
    panels.eventPanel(runs, store), panels.rosePanel(runs), panels.fragmentPanel(runs), panels.stagePanel(runs),
  ].filter(Boolean);
  const wide = [panels.checkPanel(runs), panels.provenancePanel(runs)].filter(Boolean);
  document.body.append(make("main", {}, heading(runs), why(runs),
    make("div", {class: "first"}, view?.node ?? make("p", {class: "note bare"}, "The folder holds no frames, so there is no view."),
      make("div", {class: "side"}, side.map((p) => p.node))),
    make("div", {class: "grid"}, below.map((p) => p.node)),
    make("div", {class: "wide"}, wide.map((p) => p.node)), remarks(runs),
    make("footer", {}, `Written by breccia report. ${data.live ? "It asks its own server for news, and nobody else." : "This page is one file and asks no server for anything."} It holds three.js and uPlot (MIT licence).`)));
  for (const p of [...side, ...below]) p.start?.();
  if (view) await view.start();
  else store.setTime(runs[0].summary.time);
  if (data.live) {
    restore(view, store);
    keepUp(data.live, view, store);
  }
  document.documentElement.dataset.ready = "true";
}

build().catch((error) => {
  const place = document.getElementById("wait") ?? document.body.appendChild(make("p", {class: "wait"}));
  place.textContent = `This report cannot be shown: ${error.message}. A browser from 2023 or later is needed.`;
  console.error(error);
});
