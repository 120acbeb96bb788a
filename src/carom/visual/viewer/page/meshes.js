// ---- Surfaces: corners of triangles with their normals, 6 numbers each ----

const CREASE = Math.cos(0.6); // edges of more than 34 degrees stay sharp

/** Triangles with normals: those of faces around a vertex are averaged where they nearly agree. */
function shaded(vertices, triangles) {
  const corners = triangles.length, normals = [], around = new Map();
  for (let f = 0; f < corners / 3; f++) {
    const [a, b, c] = [0, 1, 2].map((k) => row(vertices, triangles[3 * f + k]));
    normals.push(cross(sub(b, a), sub(c, a))); // its length is twice the area: the weight
    for (let k = 0; k < 3; k++) {
      const v = triangles[3 * f + k];
      if (!around.has(v)) around.set(v, []);
      around.get(v).push(f);
    }
  }
  const units = normals.map(unit), out = new Float32Array(6 * corners);
  for (let i = 0; i < corners; i++) {
    const f = Math.floor(i / 3);
    let sum = [0, 0, 0];
    for (const g of around.get(triangles[i])) if (dot(units[f], units[g]) > CREASE) sum = add(sum, normals[g]);
    out.set(row(vertices, triangles[i]), 6 * i);
    out.set(norm(sum) > 0 ? unit(sum) : units[f], 6 * i + 3);
  }
  return out;
}

/** A profile of points (r, z), from below to above outside, turned about z. */
function turned(profile, n = 20) {
  const vertices = [], triangles = [];
  for (const [r, z] of profile)
    for (let k = 0; k < n; k++)
      vertices.push(r * Math.cos((2 * Math.PI * k) / n), r * Math.sin((2 * Math.PI * k) / n), z);
  for (let p = 0; p + 1 < profile.length; p++)
    for (let k = 0; k < n; k++) {
      const a = p * n + k, b = p * n + ((k + 1) % n);
      if (profile[p][0] > 0) triangles.push(a, b, b + n);
      if (profile[p + 1][0] > 0) triangles.push(a, b + n, a + n);
    }
  return shaded(new Float32Array(vertices), triangles);
}

/** A wire of radius `thick` around a coil of radius 1 and height 1. */
function coil(turns = 9, thick = 0.16, n = 8) {
  const steps = 18 * turns, vertices = [], triangles = [];
  for (let i = 0; i <= steps; i++) {
    const angle = (2 * Math.PI * turns * i) / steps, out = [Math.cos(angle), Math.sin(angle), 0];
    for (let k = 0; k < n; k++) {
      const u = thick * Math.cos((2 * Math.PI * k) / n), v = thick * Math.sin((2 * Math.PI * k) / n);
      vertices.push(out[0] * (1 + u), out[1] * (1 + u), i / steps + 0.06 * v);
    }
  }
  for (let i = 0; i < steps; i++)
    for (let k = 0; k < n; k++) {
      const a = i * n + k, b = i * n + ((k + 1) % n);
      triangles.push(a, a + n, b + n, a, b + n, b);
    }
  return shaded(new Float32Array(vertices), triangles);
}

/** A ball of radius 1 with `rings` from pole to pole. */
const ball = (rings, n) => turned(Array.from({ length: rings + 1 }, (_, k) => {
  const angle = Math.PI * (k / rings - 0.5);
  return [k % rings ? Math.cos(angle) : 0, Math.sin(angle)];
}), n);

/** What is drawn beside bodies: all with height or radius 1. */
const furniture = () => ({
  shaft: turned([[0, 0], [1, 0], [1, 1], [0, 1]]),
  head: turned([[0, 0], [1, 0], [0, 1]]),
  ball: ball(12, 20),
  mark: ball(4, 8),
  coil: coil(),
});
