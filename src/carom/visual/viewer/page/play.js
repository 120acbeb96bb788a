// ---- The page: what is shown now, and how it changes ----

const find = (id) => document.getElementById(id);
const FADE = 0.35; // time for which an impact is shown [s of real time]

const run = await unpacked();
const motion = new Motion(run);
run.span = motion.end - motion.start || 1;
const state = {
  time: motion.start, playing: false, again: false, speed: run.speed, follow: -1, chosen: -1,
  arrows: true, paths: true, labels: false, length: 1,
  get fading() { return Math.max(FADE * this.speed, 1e-9); },
};
let stale = true; // whether something has changed since the last picture

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

/** Show something more, less or larger. */
function change(name, value) {
  state[name] = value;
  stale = true;
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
    if (t >= motion.end) play(state.again); // from the start, or no longer
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
