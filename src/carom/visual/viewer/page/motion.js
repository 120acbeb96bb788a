// ---- Where bodies are at a time ----

class Motion {
  constructor(run) {
    Object.assign(this, { time: run.time, position: run.position, orientation: run.orientation });
    this.count = run.bodies.length;
    this.start = run.time[0];
    this.end = run.time[run.time.length - 1];
  }

  /** Poses {x, Q} of all bodies: straight lines and steady turns between frames. */
  at(t) {
    const k = lastBefore(this.time, t), next = Math.min(k + 1, this.time.length - 1);
    const length = this.time[next] - this.time[k];
    const s = length > 0 ? clamp((t - this.time[k]) / length, 0, 1) : 0;
    const poses = [];
    for (let b = 0; b < this.count; b++) {
      const here = this.count * k + b, there = this.count * next + b;
      poses.push({
        x: mix(row(this.position, here), row(this.position, there), s),
        Q: slerp(row(this.orientation, here, 4), row(this.orientation, there, 4), s),
      });
    }
    return poses;
  }

  /** The path of a body: its positions (3 numbers each) in all frames. */
  path(b) {
    const places = new Float32Array(3 * this.time.length);
    for (let k = 0; k < this.time.length; k++)
      places.set(this.position.subarray(3 * (this.count * k + b), 3 * (this.count * k + b) + 3), 3 * k);
    return places;
  }
}
