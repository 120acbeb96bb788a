// ---- Vectors [x, y, z], quaternions [w, x, y, z], matrices of 16 numbers, column by column ----

const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const sub = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const times = (s, a) => [s * a[0], s * a[1], s * a[2]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const norm = (a) => Math.hypot(a[0], a[1], a[2]);
const unit = (a) => times(1 / (norm(a) || 1), a);
const cross = (a, b) => [
  a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0],
];
const mix = (a, b, s) => a.map((_, k) => a[k] + s * (b[k] - a[k]));
const clamp = (x, least, most) => Math.min(Math.max(x, least), most);

/** Two unit vectors across `n` and each other. */
function across(n) {
  const e = Math.abs(n[0]) < 0.8 ? [1, 0, 0] : [0, 1, 0];
  const a = unit(sub(e, times(dot(e, n), n)));
  return [a, cross(n, a)];
}

/** The rotation between `p` (s = 0) and `q` (s = 1), with constant angular velocity. */
function slerp(p, q, s) {
  let c = p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3];
  const sign = c < 0 ? -1 : 1; // q and -q are the same attitude: the smaller rotation
  c *= sign;
  let a = 1 - s, b = s;
  if (c < 0.9999999) {
    const angle = Math.acos(c);
    a = Math.sin((1 - s) * angle) / Math.sin(angle);
    b = Math.sin(s * angle) / Math.sin(angle);
  }
  const r = p.map((_, k) => a * p[k] + sign * b * q[k]);
  const length = Math.hypot(...r);
  return r.map((x) => x / length);
}

/** The columns of the rotation matrix of a unit quaternion. */
function axesOf([w, x, y, z]) {
  return [
    [1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)],
    [2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)],
    [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)],
  ];
}

/** The matrix with columns a, b, c and the origin p. */
const frame = (a, b, c, p) => [...a, 0, ...b, 0, ...c, 0, ...p, 1];

/** Where the frame of a body with the pose (x, Q) takes a point of it. */
function carried(pose, point) {
  const [a, b, c] = axesOf(pose.Q);
  return add(pose.x, add(times(point[0], a), add(times(point[1], b), times(point[2], c))));
}

function product(A, B) {
  const C = new Array(16).fill(0);
  for (let i = 0; i < 4; i++)
    for (let j = 0; j < 4; j++)
      for (let k = 0; k < 4; k++) C[4 * j + i] += A[4 * k + i] * B[4 * j + k];
  return C;
}

/** World to camera, for an eye that looks at `target`. */
function looking(eye, target, up) {
  const back = unit(sub(eye, target)), right = unit(cross(up, back)), top = cross(back, right);
  return [
    right[0], top[0], back[0], 0, right[1], top[1], back[1], 0, right[2], top[2], back[2], 0,
    -dot(right, eye), -dot(top, eye), -dot(back, eye), 1,
  ];
}

function perspective(angle, aspect, near, far) {
  const f = 1 / Math.tan(angle / 2), d = near - far;
  return [f / aspect, 0, 0, 0, 0, f, 0, 0, 0, 0, (near + far) / d, -1, 0, 0, (2 * near * far) / d, 0];
}

/** Parallel light: a cube of half edge `size` about the eye's target, `deep` to both sides. */
const parallel = (size, near, far) => [
  1 / size, 0, 0, 0, 0, 1 / size, 0, 0, 0, 0, -2 / (far - near), 0, 0, 0, -(far + near) / (far - near), 1,
];

/** Where a point of the world is on the screen, [-1, 1]; null behind the eye. */
function projected(matrix, p) {
  const at = (i) => matrix[i] * p[0] + matrix[4 + i] * p[1] + matrix[8 + i] * p[2] + matrix[12 + i];
  const w = at(3);
  return w > 0 ? [at(0) / w, at(1) / w] : null;
}
