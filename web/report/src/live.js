// A page that `breccia watch --serve` sends asks the server how far the run is, and loads again when there is more to see.

import {make} from "./format.js";

const KEY = "breccia view", PAUSE = 2000; // [ms]

/** Keeps the reader's choices over a loading of the page. */
function keep(view, store) {
  const film = view?.film, last = film ? film.times[film.times.length - 1] : null;
  sessionStorage.setItem(KEY, JSON.stringify({...view?.chosen(), time: store.time === last ? null : store.time, scroll: window.scrollY}));
}

/** Gives back what keep() has kept. */
export function restore(view, store) {
  const kept = JSON.parse(sessionStorage.getItem(KEY) ?? "null");
  if (!kept) return;
  sessionStorage.removeItem(KEY);
  view?.choose(kept);
  if (kept.time != null) store.setTime(kept.time);
  window.scrollTo(0, kept.scroll ?? 0);
}

/** Looks for news: also when the run has ended, since it may be resumed, but then only as long as there is a server. */
export function keepUp(live, view, store) {
  const begun = performance.now(), text = make("p", {class: "note bare", role: "status"});
  document.querySelector("header")?.append(text);
  let ended = false;
  const look = async () => {
    try {
      const answer = await fetch(`/state${window.location.search}`);
      if (!answer.ok) throw new Error(await answer.text());
      const state = await answer.json();
      const news = state.frames !== live.frames || state.status !== live.status;
      text.textContent = state.status === "running" ? `The run is at step ${state.step}; new frames appear by themselves.` : "";
      // A page takes a while to be made and read: one is looked at for ten times as long.
      if (news && performance.now() > 11 * begun) {
        keep(view, store);
        window.location.reload();
        return;
      }
      ended = state.status !== "running";
    } catch (error) {
      if (ended) return;
      text.textContent = `There is no news: ${error.message}`;
    }
    setTimeout(look, PAUSE);
  };
  setTimeout(look, PAUSE);
}
