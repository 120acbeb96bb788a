// ---- The list of impacts, and the course of the chosen one in its layer ----

const INK = "#1d252c", BLUE = "#0072B2", ORANGE = "#E69F00", GREEN = "#009E73";

/** Decimals that distinguish the times of impacts, at most three more than the run needs. */
function decimals(run) {
  const { time } = run.impacts, least = Math.max(3, 3 - Math.floor(Math.log10(run.span)));
  let gap = run.span;
  for (let k = 1; k < time.length; k++) if (time[k] > time[k - 1]) gap = Math.min(gap, time[k] - time[k - 1]);
  return clamp(1 - Math.floor(Math.log10(gap)), least, least + 3);
}

/** Fill the table; a click on row k calls `choose(k)`. */
function listImpacts(run, choose) {
  const { impacts } = run, body = document.querySelector("#list tbody"), digits = decimals(run);
  const cells = (k) => [
    impacts.number[k] + 1, impacts.time[k].toFixed(digits),
    impacts.contact[k],
    `${short(impacts.before[3 * k])} → ${short(impacts.after[3 * k])}`,
    short(norm(row(impacts.impulse, k))), short(impacts.energy[k]),
  ];
  const rows = [];
  for (let k = 0; k < impacts.time.length; k++) {
    const line = document.createElement("tr");
    cells(k).forEach((text, i) => {
      const cell = document.createElement("td");
      cell.textContent = text;
      if (i === 2) Object.assign(cell, { className: "name", title: text });
      line.append(cell);
    });
    line.addEventListener("click", () => choose(k));
    rows.push(line);
  }
  body.replaceChildren(...rows);
  if (!rows.length) document.getElementById("list").hidden = true;
  return rows;
}

/** Show the course of impact k in its layer, or say why there is none. */
function showInside(run, k) {
  const place = document.getElementById("inside"), { impacts } = run;
  place.replaceChildren();
  if (k < 0) return;
  const title = document.createElement("h2"), words = document.createElement("p");
  title.textContent = `Inside impact ${impacts.number[k] + 1} `;
  place.append(title, words);
  const { inside } = impacts, i = inside.number.indexOf(impacts.number[k]);
  if (i < 0) {
    words.textContent = impacts.together[k] > 1
      ? `Part of a multiple impact with ${impacts.together[k]} points, resolved together: it has no course of its own.`
      : "One of the weaker impacts: its course is not in this file.";
    if (!impacts.located[k]) {
      words.textContent += " This impact was resolved in a time-stepping step: its time is the end of that step.";
    }
    return;
  }
  const first = inside.first[i], count = inside.first[i + 1] - first;
  const column = (array, axis) => Array.from({ length: count }, (_, j) => array[3 * (first + j) + axis]);
  const turns = impacts.turning[k], across = ["time", "s"], x = inside.time.subarray(first, first + count);
  const slip = [1, 2].map((axis) => column(inside.velocity, axis));
  const force = [0, 1, 2].map((axis) => column(inside.force, axis));
  const friction = force[1].map((f, j) => Math.hypot(f, force[2][j]));
  const slips = slip.some((one) => one.some((u) => u !== 0));
  const small = document.createElement("small");
  small.textContent = `${[...inside.phases[i], withUnit(x[count - 1], "s")].join(", ")} in its layer`;
  title.append(small);
  words.remove();
  const pair = document.createElement("div");
  pair.className = "pair";
  const half = { width: 184, height: 140 };
  place.append(chart({
    across, up: ["velocity", turns ? "rad/s" : "m/s"], height: 140,
    curves: [
      { x, y: column(inside.velocity, 0), colour: INK, name: "normal" },
      ...(slips ? [
        { x, y: slip[0], colour: BLUE, name: "slip 1" },
        { x, y: slip[1], colour: ORANGE, name: "slip 2", dash: "5 3" },
      ] : []),
    ],
  }).element, pair);
  pair.append(
    chart({
      ...half, across, up: turns ? ["torque", "N m"] : ["force", "N"],
      curves: [
        { x, y: force[0], colour: INK },
        ...(slips ? [{ x, y: friction, colour: GREEN, name: "friction", dash: "5 3" }] : []),
      ],
    }).element,
  );
  if (slips)
    pair.append(chart({
      ...half, across: ["slip 1", "m/s"], up: ["slip 2", "m/s"], equal: true,
      curves: [{ x: slip[0], y: slip[1], colour: BLUE }, { x: [slip[0][0]], y: [slip[1][0]], colour: INK }],
    }).element);
}
