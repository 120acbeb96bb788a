// ---- The eye: it turns about a target, comes nearer and moves along ----

const ANGLE = 0.62; // of view, up and down

class Camera {
  constructor(element, place, changed) {
    Object.assign(this, { element, place, changed });
    this.up = place.up;
    this.front = unit(sub(place.side, times(dot(place.side, this.up), this.up)));
    this.right = cross(this.up, this.front);
    this.reset();
    this.listen();
  }

  reset() {
    this.turn = 0;
    this.lift = this.place.lift;
    const narrow = Math.min(1, this.element.clientWidth / Math.max(this.element.clientHeight, 1));
    this.distance = (1.04 * this.place.radius) / Math.sin(ANGLE / 2) / narrow;
    this.target = [0, 0, 0];
  }

  get eye() {
    const level = add(times(Math.cos(this.turn), this.front), times(Math.sin(this.turn), this.right));
    const out = add(times(Math.cos(this.lift), level), times(Math.sin(this.lift), this.up));
    return add(this.target, times(this.distance, out));
  }

  matrix(aspect) {
    const far = this.distance + 8 * this.place.radius;
    const lens = perspective(ANGLE, aspect, Math.max(0.02 * this.distance, 1e-4 * far), far);
    return product(lens, looking(this.eye, this.target, this.up));
  }

  orbit(dx, dy) {
    this.turn -= 0.006 * dx;
    this.lift = clamp(this.lift + 0.006 * dy, -1.5, 1.55);
  }

  pan(dx, dy) {
    const back = unit(sub(this.eye, this.target)), right = unit(cross(this.up, back));
    const perPixel = (2 * this.distance * Math.tan(ANGLE / 2)) / this.element.clientHeight;
    const shift = add(times(-dx * perPixel, right), times(dy * perPixel, cross(back, right)));
    this.target = add(this.target, shift);
  }

  zoom(factor) {
    this.distance = clamp(this.distance * factor, 1e-3 * this.place.radius, 20 * this.place.radius);
  }

  /** Left button or a finger: turn. Right button, Shift or two fingers: move. Wheel or two fingers: zoom. */
  listen() {
    const { element } = this, fingers = new Map();
    const spread = () => {
      const [a, b] = [...fingers.values()];
      return Math.hypot(a.x - b.x, a.y - b.y);
    };
    element.addEventListener("pointerdown", (event) => {
      element.setPointerCapture(event.pointerId);
      element.focus();
      fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    });
    element.addEventListener("pointermove", (event) => {
      const before = fingers.get(event.pointerId);
      if (!before) return;
      const dx = event.clientX - before.x, dy = event.clientY - before.y;
      const apart = fingers.size === 2 ? spread() : 0;
      fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
      if (fingers.size === 2) {
        this.zoom(apart / Math.max(spread(), 1));
        this.pan(dx / 2, dy / 2);
      } else if (event.shiftKey || event.buttons & 6) this.pan(dx, dy);
      else this.orbit(dx, dy);
      this.changed();
    });
    for (const end of ["pointerup", "pointercancel"])
      element.addEventListener(end, (event) => fingers.delete(event.pointerId));
    element.addEventListener("contextmenu", (event) => event.preventDefault());
    const framed = window.self !== window.top; // there the wheel belongs to the page around, until a click
    element.addEventListener("wheel", (event) => {
      if (framed && document.activeElement !== element) return;
      event.preventDefault();
      this.zoom(Math.exp(0.0015 * clamp(event.deltaY, -200, 200)));
      this.changed();
    }, { passive: false });
  }
}
