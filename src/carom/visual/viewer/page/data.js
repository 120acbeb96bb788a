// ---- The run: a header in JSON, and one deflated block of numbers ----

const ARRAYS = { f4: Float32Array, f8: Float64Array, i4: Int32Array };

/** The header with each note {at, kind, shape} replaced by its array. */
async function unpacked() {
  const header = JSON.parse(document.getElementById("header").textContent);
  const packed = atob(document.getElementById("data").textContent);
  const bytes = Uint8Array.from(packed, (c) => c.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  const block = await new Response(stream).arrayBuffer();
  const visit = (value) => {
    if (value === null || typeof value !== "object") return value;
    if ("at" in value && "kind" in value) {
      const count = value.shape.reduce((a, b) => a * b, 1);
      return new ARRAYS[value.kind](block, value.at, count);
    }
    if (Array.isArray(value)) return typeof value[0] === "object" ? value.map(visit) : value;
    return Object.fromEntries(Object.entries(value).map(([name, one]) => [name, visit(one)]));
  };
  return visit(header);
}

/** Row k of an array of vectors of `n` numbers. */
const row = (array, k, n = 3) => Array.from(array.subarray(n * k, n * k + n));

/** The last k with times[k] <= t, at least 0. */
function lastBefore(times, t) {
  let low = 0, high = times.length;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle] <= t) low = middle;
    else high = middle;
  }
  return low;
}

const PREFIXES = [
  ["G", 1e9], ["M", 1e6], ["k", 1e3], ["", 1], ["m", 1e-3], ["µ", 1e-6], ["n", 1e-9], ["p", 1e-12],
];

/** A prefix [letter, factor] with which numbers of the size of `x` are short. */
const prefix = (x) => PREFIXES.find(([, factor]) => Math.abs(x) >= factor) ?? ["", 1];

/** A number with its unit, to three digits. */
function withUnit(x, name) {
  const [letter, factor] = prefix(x);
  return `${Number((x / factor).toPrecision(3))} ${letter}${name}`;
}

/** A number in few letters, for a table. */
function short(x, digits = 3) {
  if (x === 0) return "0";
  const size = Math.abs(x);
  if (size >= 1e4 || size < 1e-3) return x.toExponential(digits - 2).replace("e+", "e").replace("-", "−");
  return x.toPrecision(digits).replace("-", "−");
}
