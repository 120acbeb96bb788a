// ---- What can be read, pressed, clicked and typed ----

// What is said about the run.
const count = run.bodies.length === 1 ? "1 body" : `${run.bodies.length} bodies`;
find("about").textContent = [
  `${count}, ${withUnit(run.span, "s")}`, run.status, run.note && `shown: ${run.note}`,
].filter(Boolean).join(" · ");
find("struck").textContent = run.impacts.time.length
  ? "click one, or its mark, to see inside" : "none";
const legend = (colour, text) => {
  const item = document.createElement("li"), line = document.createElement("i");
  line.style.background = colour;
  item.append(line, text);
  find("legend").append(item);
};
if (painter) {
  const { strongest, largestForce, cell } = painter;
  if (strongest > 0) legend(run.colours.impulse, `impulse, greatest ${withUnit(strongest, "N s")}`);
  if (largestForce > 0)
    legend(run.colours.force, `force of persistent contact, greatest ${withUnit(largestForce, "N")}`);
  if (run.planes.length) legend("#b9c3cb", `grid ${withUnit(cell, "m")}`);
}

// Controls.
const speeds = [...new Set([run.speed, 0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10])];
for (const s of speeds.sort((a, b) => a - b)) find("speed").append(new Option(`${s} ×`, s));
find("speed").value = run.speed;
find("follow").append(new Option("nothing", -1), ...run.bodies.map((name, b) => new Option(name, b)));
find("play").addEventListener("click", () => play());
find("slider").addEventListener("input", (event) => {
  play(false);
  seek(motion.start + run.span * Number(event.target.value));
});
find("speed").addEventListener("change", (event) => (state.speed = Number(event.target.value)));
find("follow").addEventListener("change", (event) => follow(Number(event.target.value)));
for (const name of ["arrows", "paths", "labels"])
  find(name).addEventListener("change", (event) => change(name, event.target.checked));
find("length").addEventListener("input", (event) => change("length", 10 ** Number(event.target.value)));
function resetView() {
  follow(-1);
  camera.reset();
}
find("reset").addEventListener("click", resetView);
const fold = () => (find("panel").hidden = !find("panel").hidden);
find("fold").addEventListener("click", fold);
new ResizeObserver(() => (stale = true)).observe(find("stage"));

find("ticks").setAttribute("viewBox", "0 0 1000 7");
find("ticks").setAttribute("preserveAspectRatio", "none");
run.impacts.time.forEach((t) => {
  const x = (1000 * (t - motion.start)) / run.span - 1.2, fill = run.colours.impulse;
  find("ticks").append(svg("rect", { x, y: 0, width: 2.4, height: 7, fill, opacity: 0.75 }));
});

/** Where the mark of impact k is in the window [pixels]; null behind the eye. */
function markOf(k) {
  const at = projected(view, row(run.impacts.point, k)), box = find("space").getBoundingClientRect();
  return at && [box.left + (0.5 + 0.5 * at[0]) * box.width, box.top + (0.5 - 0.5 * at[1]) * box.height];
}

// A click, not a turn, on the mark of an impact chooses it; on nothing, none.
let pressed = null;
find("space").addEventListener("pointerdown", (event) => (pressed = [event.clientX, event.clientY]));
find("space").addEventListener("pointerup", (event) => {
  if (!pressed || !view || Math.hypot(event.clientX - pressed[0], event.clientY - pressed[1]) > 4) return;
  const away = Array.from(run.impacts.time, (_, k) => {
    const at = markOf(k);
    return at ? Math.hypot(event.clientX - at[0], event.clientY - at[1]) : Infinity;
  });
  const least = Math.min(...away);
  choose(least < 14 ? away.indexOf(least) : -1);
});

const KEYS = {
  " ": () => play(),
  ArrowRight: (event) => step(event.shiftKey ? 10 : 1),
  ArrowLeft: (event) => step(event.shiftKey ? -10 : -1),
  ArrowDown: () => nextImpact(1),
  ArrowUp: () => nextImpact(-1),
  Home: () => seek(motion.start),
  End: () => seek(motion.end),
  Escape: () => choose(-1),
  r: resetView,
  p: fold,
};
document.addEventListener("keydown", (event) => {
  const action = KEYS[event.key.length === 1 ? event.key.toLowerCase() : event.key];
  if (!action || event.ctrlKey || event.metaKey || event.altKey || event.target.tagName === "SELECT") return;
  event.preventDefault();
  action(event);
});

if (run.follow >= 0) follow(run.follow);
// run.html#t=0.25 begins at that time, run.html#impact=3 at that impact; run.html#loop plays again and again,
// without energy and impacts beside it.
const begin = new URLSearchParams(location.hash.slice(1));
if (begin.has("t")) seek(Number(begin.get("t")) || motion.start);
if (begin.has("impact")) choose(run.impacts.number.indexOf(Number(begin.get("impact")) - 1));
if (begin.has("loop")) {
  state.again = true;
  play(true);
}
if (window.innerWidth < 820 || begin.has("loop")) find("panel").hidden = true;
requestAnimationFrame(frameOfPage);

// For scripts and tests: poses in the world as they are shown.
window.carom = {
  run, state, seek, play, choose, follow, markOf,
  pose: (b) => {
    const { x, Q } = motion.at(state.time)[b];
    return { position: add(x, run.place.centre), orientation: Q };
  },
};
