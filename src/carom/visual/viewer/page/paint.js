// ---- From the run and a time to what is drawn ----

const PATHS = 20; // up to so many bodies have their paths drawn; with more, only the followed body has
const STILL = { x: [0, 0, 0], Q: [1, 0, 0, 0] }; // the pose of what never moves
const DOTS = 400; // at most so many impacts are marked

const rgba = (hex, alpha = 1) => [1, 3, 5].map((k) => parseInt(hex.slice(k, k + 2), 16) / 255).concat(alpha);

class Painter {
  constructor(run, motion, element) {
    Object.assign(this, { run, motion });
    this.canvas = new Canvas(element);
    this.parts = run.parts.map(({ vertices, triangles, bodies, look, colour }) => (
      { bodies, look, colour, mesh: this.canvas.mesh(shaded(vertices, triangles)) }));
    this.furniture = Object.fromEntries(
      Object.entries(furniture()).map(([name, numbers]) => [name, this.canvas.mesh(numbers)]));
    this.cell = this.round(run.place.radius / 9);
    this.planes = run.planes.map((plane) => this.plane(plane));
    this.paths = new Map();
    const lengths = (array) => Array.from({ length: array.length / 3 }, (_, k) => norm(row(array, k)));
    this.strongest = Math.max(...lengths(run.impacts.arrow), 0);
    const forces = lengths(run.persistent.force).sort((a, b) => a - b);
    this.largestForce = forces.length ? forces[Math.floor(0.99 * (forces.length - 1))] : 0;
    const { up, side } = run.place; // light comes from above, behind the eye to the right
    this.light = unit(add(times(0.85, up), add(times(0.45, side), times(0.35, cross(up, side)))));
  }

  /** 1, 2 or 5 times a power of ten, not above x. */
  round(x) {
    const power = 10 ** Math.floor(Math.log10(x)), m = x / power;
    return (m >= 5 ? 5 : m >= 2 ? 2 : 1) * power;
  }

  plane({ corners, normal, colour }) {
    const middle = times(1 / corners.length, corners.reduce(add));
    const ahead = sub(this.run.place.side, times(dot(this.run.place.side, normal), normal));
    const along = norm(ahead) > 0.3 ? unit(ahead) : across(normal)[0];
    const reach = Math.max(...corners.map((c) => norm(sub(c, middle)))) / Math.SQRT2 * 1.02;
    // where walls cut it off it ends sharply
    const cut = corners.length !== 4 || reach < 1.4 * this.run.place.radius;
    return {
      mesh: this.canvas.mesh(new Float32Array(corners.flat()), false), normal, along,
      beside: cross(normal, along), middle, cell: this.cell, reach: cut ? 1e9 : reach,
      tint: rgba(colour ?? "#ffffff").slice(0, 3),
    };
  }

  colourOf(b, look) {
    const { bodies, pips } = this.run.colours;
    return look === "joint" ? "#5b6873" : look === "pip" ? pips[b] : bodies[b];
  }

  solids(poses, t) {
    const out = [];
    for (const { mesh, bodies, look, colour: own } of this.parts)
      for (const b of bodies) {
        const { x, Q } = b < 0 ? STILL : poses[b];
        const colour = rgba(own ?? (look === "static" ? "#c3ccd4" : this.colourOf(b, look)));
        out.push({ mesh, colour, model: frame(...axesOf(Q), x), pattern: look === "round" });
      }
    const thick = 0.02 * this.run.place.radius;
    for (const { bodies, anchors, kind, length, radii, axis, there } of this.run.links) {
      if (there && !there.some(([begin, end]) => begin <= t && t < end)) continue;
      const ends = anchors.map((a, k) => (bodies[k] < 0 ? a : carried(poses[bodies[k]], a)));
      const [from, to] = radii[0] || radii[1] ? this.strand(ends, radii, axis) : ends;
      const wide = kind === "spring" ? thick : 0.35 * thick;
      const mesh = kind === "spring" ? this.furniture.coil : this.furniture.shaft;
      const line = kind === "cord" ? this.hanging(from, to, length) : [from, to];
      for (let k = 1; k < line.length; k++) {
        const along = sub(line[k], line[k - 1]), [a, b] = across(unit(along));
        const model = frame(times(wide, a), times(wide, b), along, line[k - 1]);
        out.push({ mesh, colour: rgba("#5b6873"), model });
      }
    }
    return out;
  }

  /** Ends of a strand of rope between two circles: where it leaves the one and meets the other. */
  strand(centres, radii, axis) {
    const whole = sub(centres[1], centres[0]), d = sub(whole, times(dot(whole, axis), axis));
    const square = dot(d, d), rho = radii[0] - radii[1], length = Math.sqrt(Math.max(square - rho * rho, 0));
    const along = times(1 / square, add(times(length, d), times(rho, cross(axis, d)))), beside = cross(along, axis);
    return centres.map((centre, k) => add(centre, times(radii[k], beside)));
  }

  /** Points of a cord: a slack one hangs as a parabola of its length, nearly. */
  hanging(from, to, length) {
    const along = sub(to, from), slack = length ** 2 - norm(along) ** 2;
    if (!(slack > 1e-3 * length ** 2)) return [from, to];
    const bend = 0.5 - (0.067 * norm(along)) / length, depth = bend * Math.sqrt(slack), { up } = this.run.place;
    return Array.from({ length: 13 }, (_, k) => {
      const s = k / 12;
      return add(add(from, times(s, along)), times(-4 * s * (1 - s) * depth, up));
    });
  }

  /** An arrow as shaft and head. */
  arrow(from, vector, colour) {
    const length = norm(vector);
    if (!(length > 1e-3 * this.run.place.radius)) return [];
    const thick = Math.min(0.025 * this.run.longest, 0.07 * length), head = Math.min(7 * thick, 0.6 * length);
    const along = unit(vector), [a, b] = across(along), neck = add(from, times(length - head, along));
    const stretched = (wide, long, at) => frame(times(wide, a), times(wide, b), times(long, along), at);
    return [
      { mesh: this.furniture.shaft, colour, model: stretched(thick, length - head, from) },
      { mesh: this.furniture.head, colour, model: stretched(2.6 * thick, head, neck) },
    ];
  }

  ball(at, size, colour, mesh = this.furniture.ball) {
    return { mesh, colour, model: frame([size, 0, 0], [0, size, 0], [0, 0, size], at) };
  }

  /** Marks at past and future impacts; if there are many, at some of them. */
  marks(t) {
    const { time, point } = this.run.impacts, every = Math.max(1, Math.ceil(time.length / DOTS)), out = [];
    const size = 0.008 * this.run.place.radius;
    for (let k = 0; k < time.length; k += every) {
      const colour = rgba(time[k] <= t ? "#5b6873" : "#b8c2ca");
      out.push(this.ball(row(point, k), size, colour, this.furniture.mark));
    }
    return out;
  }

  /** Impulses, which fade during `fading` [s], and forces of persistent contacts. */
  arrows(t, fading, length) {
    const { impacts, persistent, colours } = this.run, out = [], longest = this.run.longest * length;
    const impact = (k, alpha) => {
      const point = row(impacts.point, k), colour = rgba(colours.impulse, alpha);
      const vector = times(longest / (this.strongest || 1), row(impacts.arrow, k));
      out.push(this.ball(point, 0.03 * this.run.longest, colour), ...this.arrow(point, vector, colour));
    };
    for (let k = 0; k < impacts.time.length; k++) {
      const age = t - impacts.time[k];
      if (age >= -1e-12 && age < fading) impact(k, 1 - age / fading);
    }
    const s = lastBefore(persistent.time, t);
    for (let k = persistent.first[s]; k < persistent.first[s + 1]; k++) {
      const force = row(persistent.force, k), least = Math.min(1, this.largestForce / (norm(force) || 1));
      const vector = times((0.7 * longest * least) / (this.largestForce || 1), force);
      out.push(...this.arrow(row(persistent.point, k), vector, rgba(colours.force)));
    }
    return out;
  }

  lines(t, followed) {
    const all = Array.from({ length: this.motion.count }, (_, b) => b), out = [];
    for (const b of this.motion.count <= PATHS ? all : followed >= 0 ? [followed] : []) {
      if (!this.paths.has(b)) this.paths.set(b, this.canvas.mesh(this.motion.path(b), false));
      const mesh = this.paths.get(b), now = lastBefore(this.motion.time, t);
      out.push({ mesh, first: 0, count: now + 1, colour: [0.25, 0.31, 0.36, 0.8] });
      out.push({ mesh, first: now, count: mesh.count - now, colour: [0.25, 0.31, 0.36, 0.22] });
    }
    return out;
  }

  /** Draw the moment; `state` says what is wanted. Returns the matrix to the screen. */
  paint(camera, poses, state) {
    const aspect = this.canvas.fit(), view = camera.matrix(aspect), { radius, up } = this.run.place;
    const size = Math.min(1.4 * radius, 1.1 * camera.distance), far = 4 * radius + size;
    const from = add(camera.target, times(far / 2, this.light));
    const along = looking(from, camera.target, across(this.light)[0]);
    const sun = product(parallel(size, -far / 2, 1.5 * far), along);
    this.canvas.draw({
      view, sun, eye: camera.eye, light: this.light, up,
      solids: this.solids(poses, state.time), planes: this.planes,
      lines: state.paths ? this.lines(state.time, state.follow) : [],
      marks: state.arrows ? this.marks(state.time) : [],
      arrows: state.arrows ? this.arrows(state.time, state.fading, state.length) : [],
    });
    return view;
  }
}
