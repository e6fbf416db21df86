// what was measured at a question: from above with rays of the place from where it was seen best, and as it looked from there
const seen = (() => {
  const { plan } = planView;
  const byId = (id) => document.getElementById(id);
  const [box, cutout, picture, said, stand, group] = ["seen", "cutout", "from-there", "seen-said", "stand", "sight"].map(byId);
  const data = JSON.parse(byId("sights-data").textContent);
  const around = 0.8; // metres beside what is looked at
  const near = 5; // metres within which the place that it was seen from is in the cut-out
  const beyond = 3; // metres behind what is looked at that are still painted
  const grain = 0.03; // metres that a point is painted as: the cubes that keep one each
  let shown = null;

  const svg = (tag, attributes) => {
    const made = document.createElementNS("http://www.w3.org/2000/svg", tag);
    for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
    return made;
  };

  // --- from above: drawn on the plan, and the same once more, near ---
  function drawRays({ ends_m: [a, b], at_m: [x, y], rays }) {
    let [ways, returns] = ["", ""];
    for (let i = 0; i < rays.length; i += 2) {
      const end = `${(x + rays[i] / 100).toFixed(2)} ${(-y - rays[i + 1] / 100).toFixed(2)}`;
      ways += `M${x} ${-y}L${end}`;
      returns += `M${end}h0`;
    }
    group.replaceChildren(svg("path", { class: "ray", d: ways }), svg("path", { class: "return", d: returns }),
      svg("path", { class: "asked", d: `M${a[0]} ${-a[1]}L${b[0]} ${-b[1]}` }), svg("circle", { class: "stood", cx: x, cy: -y, r: 0.1 }));
  }
  // what a style says of parts of the plan is not said of parts that are used again
  function copy(id) {
    const made = byId(id).cloneNode(true);
    made.removeAttribute("id");
    return made;
  }
  let still = null; // what is the same at all questions
  function cutOut({ ends_m: ends, at_m: at, far_m: far }) {
    const places = far <= near ? [...ends, at] : ends;
    const [low, high] = [Math.min, Math.max].map((of) => [0, 1].map((axis) => of(...places.map((place) => place[axis]))));
    const [width, depth] = [0, 1].map((axis) => Math.max(high[axis] - low[axis] + 2 * around, 3));
    const box_ = [(low[0] + high[0] - width) / 2, -(low[1] + high[1] + depth) / 2, width, depth];
    cutout.setAttribute("viewBox", box_.map((m) => m.toFixed(2)).join(" "));
    still ??= ["floors", "points", "finished", "way"].map(copy);
    cutout.replaceChildren(...still, copy("sight"));
    cutout.style.setProperty("--px", Math.max(width / cutout.clientWidth, depth / cutout.clientHeight) || 0.01);
  }

  // --- as it looked from there: points as far as what is before them does not hide them, upright as a photograph of a level camera ---
  function lookFrom({ ends_m: ends, low_m: low, high_m: high, at_m: at }, width, height) {
    const [dx, dy] = [0, 1].map((axis) => (ends[0][axis] + ends[1][axis]) / 2 - at[axis]);
    const far = Math.hypot(dx, dy) || 1;
    const [fx, fy] = [dx / far, dy / far];
    const lay = ([x, y]) => [(x - at[0]) * fy - (y - at[1]) * fx, Math.max((x - at[0]) * fx + (y - at[1]) * fy, 0.3)];
    const sides = ends.map(lay);
    const aside = Math.max(...sides.map(([right, ahead]) => Math.abs(right) / ahead), 0.2);
    const focal = Math.min((0.4 * width) / Math.min(aside, 1), (0.42 * height * 2 * far) / Math.max(high - low + around, 1));
    const middle = (low + high) / 2;
    const place = ([right, ahead], up) => [width / 2 + (focal * right) / ahead, height / 2 + focal * ((at[2] - up) / ahead + (middle - at[2]) / far)];
    return { lay, place, focal, sides, last: Math.max(...sides.map(([, ahead]) => ahead)) + beyond };
  }
  async function paint(sight) {
    picture.hidden = data.planar || !window.DecompressionStream;
    if (picture.hidden) return;
    const xyz = await solid.points();
    if (data.of[shown] !== sight) return;
    const sharp = Math.min(devicePixelRatio, 2);
    const [width, height] = [picture.clientWidth, picture.clientHeight].map((size) => Math.max(Math.round(size * sharp), 1));
    Object.assign(picture, { width, height });
    const view = lookFrom(sight, width, height);
    const context = picture.getContext("2d");
    const image = context.createImageData(width, height);
    const depths = new Float32Array(width * height).fill(Infinity);
    for (let i = 0; i < xyz.length; i += 3) {
      const [right, ahead] = view.lay([xyz[i], xyz[i + 1]]);
      if (ahead <= 0.3 || ahead > view.last) continue;
      const [column, row] = view.place([right, ahead], xyz[i + 2]);
      const size = Math.min(Math.max((grain * view.focal) / ahead, 1), 8) / 2;
      const [left, top, end, bottom] = [Math.max(Math.round(column - size), 0), Math.max(Math.round(row - size), 0), Math.min(Math.round(column + size), width), Math.min(Math.round(row + size), height)];
      const colour = solid.colourAt(xyz[i + 2]);
      const opacity = 255 - (130 * ahead) / view.last;
      for (let y = top; y < bottom; y++) {
        for (let x = left; x < end; x++) {
          const at = y * width + x;
          if (depths[at] <= ahead) continue;
          depths[at] = ahead;
          for (let k = 0; k < 3; k++) image.data[4 * at + k] = colour[k];
          image.data[4 * at + 3] = opacity;
        }
      }
    }
    context.putImageData(image, 0, 0);
    const corners = [[0, sight.low_m], [1, sight.low_m], [1, sight.high_m], [0, sight.high_m]].map(([side, up]) => view.place(view.sides[side], up));
    context.strokeStyle = getComputedStyle(plan).getPropertyValue("--red").trim();
    context.lineWidth = 2 * sharp;
    context.setLineDash([5 * sharp, 3 * sharp]);
    context.beginPath();
    for (const corner of corners) context.lineTo(...corner);
    context.closePath();
    context.stroke();
  }

  // --- the question's ---
  const clock = (seconds) => `${Math.floor(seconds / 60)}:${String(Math.floor(seconds % 60)).padStart(2, "0")} min`;
  const target = ({ ends_m: [a, b], low_m: low, high_m: high }) => [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (low + high) / 2];
  function show(element) {
    shown = element;
    const sight = data.of[element];
    box.hidden = false;
    for (const part of [cutout, picture, stand]) part.toggleAttribute("hidden", !sight);
    if (!sight) {
      group.replaceChildren();
      said.textContent = "No scan of the plan looks at it.";
      return;
    }
    drawRays(sight);
    cutOut(sight);
    const n = sight.rays.length / 2;
    cutout.setAttribute("aria-label", `From above: the plan, and where ${n} rays of one scan end`);
    said.textContent = `Seen best from ${sight.far_m.toFixed(1)} m away: ${Math.round(sight.along_m)} m of ${Math.round(data.way_m)} m along the sensor's way, ${clock(sight.t_s)} after its start.`;
    paint(sight);
    if (solid.isOn()) solid.standAt(sight.at_m, target(sight));
  }
  function hide() {
    shown = null;
    box.hidden = true;
    group.replaceChildren();
  }
  stand.addEventListener("click", () => {
    if (solid.isOn()) return solid.hide();
    const sight = data.of[shown];
    solid.show().then(() => solid.standAt(sight.at_m, target(sight)));
  });
  addEventListener("space", () => { stand.textContent = solid.isOn() ? "Back to the plan" : "Stand there in 3-D"; });
  addEventListener("resize", () => { if (data.of[shown]) { cutOut(data.of[shown]); paint(data.of[shown]); } });
  if (solid.isMissing()) stand.remove();
  // an end that is not sure lies elsewhere than the middle of its wall
  const placeOf = (element) => data.of[element] && target(data.of[element]).slice(0, 2);
  return { show, hide, placeOf, isPlanar: data.planar };
})();
