// ---- Charts: a few curves in SVG, with few and round numbers at the axes ----

const SVG = "http://www.w3.org/2000/svg";

function svg(name, attributes = {}, text = "") {
  const element = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  element.textContent = text;
  return element;
}

/** About `n` round numbers from `low` to `high`. */
function rounds(low, high, n = 4) {
  const rough = (high - low) / n || 1, power = 10 ** Math.floor(Math.log10(rough)), m = rough / power;
  const step = (m > 7.07 ? 10 : m > 3.16 ? 5 : m > 1.41 ? 2 : 1) * power, out = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k++) out.push(k * step);
  return out;
}

/**
 * A chart of `curves` [{x, y, colour, name, dash}]; units are chosen by the sizes of the numbers.
 * `across` and `up` are [quantity, unit]. Returns {element, now(x)}, which moves a mark.
 */
function chart({ curves, across, up, width = 372, height = 150, equal = false, seek = null }) {
  const range = (key) => {
    let low = Infinity, high = -Infinity;
    for (const curve of curves)
      for (const v of curve[key]) [low, high] = [Math.min(low, v), Math.max(high, v)];
    if (!(high > low)) [low, high] = [low - 0.5 * (Math.abs(low) || 1), high + 0.5 * (Math.abs(high) || 1)];
    return [low, high];
  };
  let [x0, x1] = range("x"), [y0, y1] = range("y");
  const room = 0.06 * (y1 - y0);
  [y0, y1] = [y0 - room, y1 + room];
  const left = 42, right = width - 8, top = 22, bottom = height - 30;
  if (equal) {
    const scale = Math.max((x1 - x0) / (right - left), (y1 - y0) / (bottom - top)) * 1.05;
    const middle = [(x0 + x1) / 2, (y0 + y1) / 2];
    [x0, x1] = [-1, 1].map((s) => middle[0] + (s * scale * (right - left)) / 2);
    [y0, y1] = [-1, 1].map((s) => middle[1] + (s * scale * (bottom - top)) / 2);
  }
  const px = (x) => left + ((x - x0) / (x1 - x0)) * (right - left);
  const py = (y) => bottom - ((y - y0) / (y1 - y0)) * (bottom - top);
  const [xLetter, xFactor] = prefix(Math.max(Math.abs(x0), Math.abs(x1)));
  const [yLetter, yFactor] = prefix(Math.max(Math.abs(y0), Math.abs(y1)));
  const label = (v) => String(Number(v.toPrecision(6))).replace("-", "−");

  const element = svg("svg", { class: "chart", viewBox: `0 0 ${width} ${height}`, role: "img" });
  for (const y of rounds(y0 / yFactor, y1 / yFactor, 4)) {
    element.append(svg("path", { class: "axis", d: `M${left} ${py(y * yFactor)}H${right}` }));
    element.append(svg("text", { x: left - 5, y: py(y * yFactor) + 4, "text-anchor": "end" }, label(y)));
  }
  for (const x of rounds(x0 / xFactor, x1 / xFactor, Math.round(width / 90))) {
    element.append(svg("path", { class: "axis", d: `M${px(x * xFactor)} ${bottom}v4` }));
    element.append(svg("text", { x: px(x * xFactor), y: bottom + 15, "text-anchor": "middle" }, label(x)));
  }
  element.append(svg("text", { class: "title", x: 0, y: 11 }, `${up[0]} [${yLetter}${up[1]}]`));
  const below = { class: "title", x: right, y: height - 3, "text-anchor": "end" };
  element.append(svg("text", below, `${across[0]} [${xLetter}${across[1]}]`));
  let at = right;
  for (const { name, colour } of [...curves].reverse()) {
    if (!name) continue;
    element.append(svg("text", { x: at, y: 11, "text-anchor": "end", style: "fill: var(--ink)" }, name));
    at -= 6.1 * name.length + 5;
    element.append(svg("path", { d: `M${at} 7h-12`, stroke: colour, "stroke-width": 2.5 }));
    at -= 21;
  }
  for (const { x, y, colour, dash } of curves) {
    if (x.length === 1) element.append(svg("circle", { cx: px(x[0]), cy: py(y[0]), r: 3, fill: colour }));
    const d = Array.from(x, (v, k) => `${k ? "L" : "M"}${px(v).toFixed(1)} ${py(y[k]).toFixed(1)}`).join("");
    element.append(svg("path", { d, stroke: colour, "stroke-dasharray": dash ?? "none" }));
  }
  const mark = svg("path", { class: "now", d: `M0 ${top}V${bottom}`, visibility: "hidden" });
  element.append(mark);
  if (seek) {
    element.classList.add("seek");
    element.addEventListener("pointerdown", (event) => {
      const box = element.getBoundingClientRect();
      const x = ((event.clientX - box.left) / box.width) * width;
      seek(clamp(x0 + ((x - left) / (right - left)) * (x1 - x0), x0, x1));
    });
  }
  const now = (x) => {
    mark.setAttribute("visibility", "visible");
    mark.setAttribute("transform", `translate(${px(x)} 0)`);
  };
  return { element, now };
}
