// ---- Drawing: lists of {mesh, model, colour} to a canvas, with one light that throws shadows ----

const MAP = 2048; // pixels along a side of the map of shadows

class Canvas {
  constructor(element) {
    this.element = element;
    const gl = element.getContext("webgl2", { antialias: true, alpha: true });
    if (!gl) throw new Error("This browser has no WebGL 2, which is needed to draw the motion.");
    this.gl = gl;
    this.programs = {
      surface: compiled(gl, SURFACE), plane: compiled(gl, PLANE),
      line: compiled(gl, LINE), depth: compiled(gl, DEPTH),
    };
    this.shadows();
    gl.enable(gl.CULL_FACE);
    gl.blendFuncSeparate(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA, gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
  }

  shadows() {
    const { gl } = this;
    this.map = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, this.map);
    gl.texStorage2D(gl.TEXTURE_2D, 1, gl.DEPTH_COMPONENT24, MAP, MAP);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.LINEAR);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_COMPARE_MODE, gl.COMPARE_REF_TO_TEXTURE);
    this.buffer = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.buffer);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, this.map, 0);
  }

  /** Numbers on the card: places alone, or places and normals. */
  mesh(numbers, withNormals = true) {
    const { gl } = this, array = gl.createVertexArray(), each = withNormals ? 6 : 3;
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, numbers, gl.STATIC_DRAW);
    for (let k = 0; k < each / 3; k++) {
      gl.enableVertexAttribArray(k);
      gl.vertexAttribPointer(k, 3, gl.FLOAT, false, 4 * each, 12 * k);
    }
    return { array, count: numbers.length / each };
  }

  /** As many pixels as the screen has. */
  fit() {
    const ratio = Math.min(window.devicePixelRatio || 1, 2), { element } = this;
    const [width, height] = [element.clientWidth, element.clientHeight].map((n) => Math.round(n * ratio));
    if (element.width !== width || element.height !== height) Object.assign(element, { width, height });
    return width / Math.max(height, 1);
  }

  use(name, common) {
    const { program, at } = this.programs[name];
    this.gl.useProgram(program);
    for (const [key, value] of Object.entries(common)) this.set(at[key], value);
    return at;
  }

  set(place, value) {
    const { gl } = this;
    if (place === undefined) return;
    if (typeof value === "number") gl.uniform1f(place, value);
    else if (value.length === 16) gl.uniformMatrix4fv(place, false, value);
    else if (value.length === 4) gl.uniform4fv(place, value);
    else gl.uniform3fv(place, value);
  }

  show(mesh, mode = this.gl.TRIANGLES, first = 0, count = mesh.count) {
    this.gl.bindVertexArray(mesh.array);
    this.gl.drawArrays(mode, first, count);
  }

  /** One picture: solids with shadows, planes with a grid, marks and lines, and arrows in front of all. */
  draw({ eye, light, up, view, sun, solids, planes, marks, lines, arrows }) {
    const { gl } = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.buffer);
    gl.viewport(0, 0, MAP, MAP);
    gl.enable(gl.DEPTH_TEST);
    gl.disable(gl.BLEND);
    gl.depthMask(true);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.POLYGON_OFFSET_FILL);
    gl.polygonOffset(2, 4);
    let at = this.use("depth", { sun });
    for (const one of solids) {
      this.set(at.model, one.model);
      this.show(one.mesh);
    }
    gl.disable(gl.POLYGON_OFFSET_FILL);

    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, this.element.width, this.element.height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.bindTexture(gl.TEXTURE_2D, this.map);
    const common = { view, sun, light, eye, up, glow: 0 };
    this.surfaces(solids, common);

    gl.enable(gl.BLEND);
    for (const plane of planes) {
      this.use("plane", { ...common, ...plane });
      this.show(plane.mesh, gl.TRIANGLE_FAN);
    }
    this.surfaces(marks, { ...common, glow: 1 });
    gl.depthMask(false);
    at = this.use("line", { view });
    for (const line of lines) {
      this.set(at.colour, line.colour);
      this.show(line.mesh, gl.LINE_STRIP, line.first, line.count);
    }
    gl.depthMask(true);
    gl.clear(gl.DEPTH_BUFFER_BIT); // else most arrows would be hidden in the body they push
    this.surfaces(arrows, { ...common, glow: 1 });
    gl.disable(gl.BLEND);
  }

  surfaces(list, common) {
    const at = this.use("surface", common);
    for (const one of list) {
      this.set(at.model, one.model);
      this.set(at.colour, one.colour);
      this.set(at.pattern, one.pattern ? 1 : 0);
      this.show(one.mesh);
    }
  }
}
