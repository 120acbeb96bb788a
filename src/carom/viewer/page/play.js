// ---- The page: what is shown now, and all that can be pressed, drawn or typed ----

const find = (id) => document.getElementById(id);
const FADE = 0.35; // an impact is seen that long [s of the clock on the wall]

const run = await unpacked();
const motion = new Motion(run);
run.span = motion.end - motion.start || 1;
const state = {
  time: motion.start, playing: false, speed: run.speed, follow: -1, chosen: -1,
  arrows: true, ways: true, labels: false, length: 1,
  get fading() { return Math.max(FADE * this.speed, 1e-9); },
};
let stale = true; // something has changed since the last picture

const camera = new Camera(find("space"), run.place, () => (stale = true));
let painter = null;
try {
  painter = new Painter(run, motion, find("space"));
} catch (error) {
  Object.assign(find("notice"), { hidden: false, textContent: error.message });
}

const seconds = (t) => t.toFixed(clamp(3 - Math.floor(Math.log10(run.span)), 2, 9));
const total = run.energy.kinetic.map((T, k) => T + run.energy.potential[k]);
const energy = chart({
  across: ["time", "s"], up: ["energy", "J"], seek,
  curves: [
    { x: run.energy.time, y: run.energy.potential, colour: "#56B4E9", name: "potential" },
    { x: run.energy.time, y: run.energy.kinetic, colour: ORANGE, name: "kinetic" },
    { x: run.energy.time, y: total, colour: INK, name: "total" },
  ],
});
find("energy").append(energy.element);
if (run.impacts.turning.some(Boolean)) find("units").textContent = "[m/s, rad/s]";
const rows = listImpacts(run, (k) => choose(k));

function seek(t) {
  state.time = clamp(t, motion.start, motion.end);
  find("slider").value = (state.time - motion.start) / run.span;
  stale = true;
}

function play(on = !state.playing) {
  if (on && state.time >= motion.end) seek(motion.start);
  state.playing = on;
  find("play").textContent = on ? "❚❚" : "▶";
  stale = true;
}

/** Stop at impact k and show its inside; -1 for none. */
function choose(k) {
  rows[state.chosen]?.classList.remove("chosen");
  state.chosen = k;
  showInside(run, k);
  if (k >= 0) {
    rows[k].classList.add("chosen");
    rows[k].scrollIntoView({ block: "nearest" });
    play(false);
    seek(run.impacts.time[k]);
  }
  stale = true;
}

/** The eye goes with body b; -1: it stays. */
function follow(b) {
  state.follow = b;
  find("follow").value = b;
  if (b >= 0) {
    camera.target = motion.at(state.time)[b].x;
    camera.distance = Math.min(camera.distance, 16 * run.sizes[b]);
  }
  stale = true;
}

function step(frames) {
  play(false);
  seek(motion.time[clamp(lastBefore(motion.time, state.time) + frames, 0, motion.time.length - 1)]);
}

function nextImpact(sign) {
  const now = state.time, { time } = run.impacts;
  const near = state.chosen >= 0 && time[state.chosen] === now ? state.chosen + sign : sign > 0
    ? time.findIndex((t) => t > now) : time.findLastIndex((t) => t < now);
  if (near >= 0 && near < time.length) choose(near);
}

/** Names beside the bodies. */
function nameBodies(view, poses) {
  const box = find("names"), wanted = state.labels ? run.bodies.map((_, b) => b) : [];
  while (box.children.length < wanted.length) box.append(document.createElement("span"));
  while (box.children.length > wanted.length) box.lastChild.remove();
  wanted.forEach((b, k) => {
    const at = projected(view, poses[b].x), label = box.children[k];
    label.hidden = at === null;
    if (at === null) return;
    label.textContent = run.bodies[b];
    const x = (0.5 + 0.5 * at[0]) * box.parentElement.clientWidth + 10;
    const y = (0.5 - 0.5 * at[1]) * box.parentElement.clientHeight - 22;
    label.style.transform = `translate(${x}px, ${y}px)`;
  });
}

let before = null, followed = null, view = null;
function frameOfPage(now) {
  if (state.playing && before !== null) {
    const t = state.time + (state.speed * Math.min(now - before, 100)) / 1000;
    seek(t);
    if (t >= motion.end) play(false);
  }
  before = now;
  if (stale) {
    stale = false;
    const poses = motion.at(state.time);
    if (state.follow >= 0) {
      if (followed?.body === state.follow)
        camera.target = add(camera.target, sub(poses[state.follow].x, followed.x));
      followed = { body: state.follow, x: poses[state.follow].x };
    } else followed = null;
    if (painter) {
      view = painter.paint(camera, poses, state);
      nameBodies(view, poses);
    }
    energy.now(state.time);
    find("clock").textContent = `${seconds(state.time)} / ${seconds(motion.end)} s`;
    rows.forEach((line, k) => line.classList.toggle("coming", run.impacts.time[k] > state.time));
  }
  requestAnimationFrame(frameOfPage);
}

// What is said about the run.
find("about").textContent = [
  `${run.bodies.length} ${run.bodies.length === 1 ? "body" : "bodies"}, ${withUnit(run.span, "s")}`, run.status, run.note && `shown: ${run.note}`,
].filter(Boolean).join(" · ");
find("struck").textContent = run.impacts.time.length
  ? "click one, or its mark, to see inside" : "none";
const legend = (colour, text) => {
  const item = document.createElement("li"), line = document.createElement("i");
  line.style.background = colour;
  item.append(line, text);
  find("legend").append(item);
};
if (painter?.strongest > 0) legend(run.colours.impulse, `impulse, greatest ${withUnit(painter.strongest, "N s")}`);
if (painter?.pressed > 0) legend(run.colours.force, `force of held contact, greatest ${withUnit(painter.pressed, "N")}`);
if (painter && run.planes.length) legend("#b9c3cb", `grid ${withUnit(painter.cell, "m")}`);

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
for (const name of ["arrows", "ways", "labels"])
  find(name).addEventListener("change", (event) => ((state[name] = event.target.checked), (stale = true)));
find("length").addEventListener("input", (event) => ((state.length = 10 ** Number(event.target.value)), (stale = true)));
const resetView = () => (follow(-1), camera.reset(), (stale = true));
find("reset").addEventListener("click", resetView);
const fold = () => (find("panel").hidden = !find("panel").hidden);
find("fold").addEventListener("click", fold);
new ResizeObserver(() => (stale = true)).observe(find("stage"));

find("ticks").setAttribute("viewBox", "0 0 1000 7");
find("ticks").setAttribute("preserveAspectRatio", "none");
run.impacts.time.forEach((t) => {
  const x = (1000 * (t - motion.start)) / run.span;
  find("ticks").append(svg("rect", { x: x - 1.2, y: 0, width: 2.4, height: 7, fill: run.colours.impulse, opacity: 0.75 }));
});

// A click, not a turn, on the mark of an impact chooses it; on nothing, none.
let pressed = null;
find("space").addEventListener("pointerdown", (event) => (pressed = [event.clientX, event.clientY]));
find("space").addEventListener("pointerup", (event) => {
  if (!pressed || !view || Math.hypot(event.clientX - pressed[0], event.clientY - pressed[1]) > 4) return;
  const box = find("space").getBoundingClientRect();
  let nearest = -1, least = 14;
  run.impacts.time.forEach((_, k) => {
    const at = projected(view, row(run.impacts.point, k));
    if (!at) return;
    const x = box.left + (0.5 + 0.5 * at[0]) * box.width, y = box.top + (0.5 - 0.5 * at[1]) * box.height;
    const away = Math.hypot(event.clientX - x, event.clientY - y);
    if (away < least) (least = away), (nearest = k);
  });
  choose(nearest);
});

const KEYS = {
  " ": () => play(), ArrowRight: (e) => step(e.shiftKey ? 10 : 1), ArrowLeft: (e) => step(e.shiftKey ? -10 : -1),
  ArrowDown: () => nextImpact(1), ArrowUp: () => nextImpact(-1), Home: () => seek(motion.start),
  End: () => seek(motion.end), r: resetView, p: fold, Escape: () => choose(-1),
};
document.addEventListener("keydown", (event) => {
  const action = KEYS[event.key.length === 1 ? event.key.toLowerCase() : event.key];
  if (!action || event.ctrlKey || event.metaKey || event.altKey || event.target.tagName === "SELECT") return;
  event.preventDefault();
  action(event);
});

if (run.follow >= 0) follow(run.follow);
// run.html#t=0.25 begins at that time, run.html#impact=3 at that impact.
const begin = new URLSearchParams(location.hash.slice(1));
if (begin.has("t")) seek(Number(begin.get("t")) || motion.start);
if (begin.has("impact")) choose(run.impacts.number.indexOf(Number(begin.get("impact")) - 1));
if (window.innerWidth < 820) find("panel").hidden = true;
requestAnimationFrame(frameOfPage);

// For scripts and tests: poses in the world as they are shown.
window.carom = {
  run, state, seek, play, choose, follow,
  pose: (b) => {
    const { x, Q } = motion.at(state.time)[b];
    return { position: add(x, run.place.centre), orientation: Q };
  },
};
