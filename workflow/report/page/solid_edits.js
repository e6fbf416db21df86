// changes in space: what is new or elsewhere as blue bodies, what is to go as red wire, each with a sign; as on the plan until it is made anew
const solidEdits = (() => {
  const { plan, view } = planView;
  const layer = document.getElementById("space-marks");
  const signs = { keep: "✓", settle: "✓", remove: "✗", add: "+" };
  const thin = 0.1; // metres that a wall of unknown thickness is drawn with, as on the plan
  const beyond = 0.02; // metres that an opening stands out of its wall, so that both are seen
  const heights = { window: [0.9, 2.1], glass: [0, 2.1], door: [0, 2.1], passage: [0, 2.1] }; // metres, where nobody said them
  const atHeight = 1.0; // metres at which a tape is held
  let scene = null;
  let marks = [];

  // --- bodies: corners of triangles that face outwards, about the middle of the scene ---
  function prism(outline, low, high) {
    const area = outline.reduce((sum, [x, y], i) => sum + x * outline[(i + 1) % outline.length][1] - y * outline[(i + 1) % outline.length][0], 0);
    const ring = (area < 0 ? outline.toReversed() : outline).map(([x, y]) => [x - scene.middle[0], y - scene.middle[1]]);
    const corners = [];
    ring.forEach(([ax, ay], i) => {
      const [bx, by] = ring[(i + 1) % ring.length];
      corners.push(ax, ay, low, bx, by, low, bx, by, high, ax, ay, low, bx, by, high, ax, ay, high);
    });
    const [[ox, oy]] = ring;
    for (let i = 1; i + 1 < ring.length; i++) {
      const [[ax, ay], [bx, by]] = [ring[i], ring[i + 1]];
      corners.push(ox, oy, high, ax, ay, high, bx, by, high, ox, oy, low, bx, by, low, ax, ay, low);
    }
    return Float32Array.from(corners);
  }
  function strip([[ax, ay], [bx, by]], width, low, high) {
    const length = Math.hypot(bx - ax, by - ay) || 1;
    const [nx, ny] = [(-(by - ay) / length) * (width / 2), ((bx - ax) / length) * (width / 2)];
    return prism([[ax - nx, ay - ny], [bx - nx, by - ny], [bx + nx, by + ny], [ax + nx, ay + ny]], low, high);
  }
  const span = (corners) => {
    let [low, high] = [Infinity, -Infinity];
    for (let i = 2; i < corners.length; i += 3) [low, high] = [Math.min(low, corners[i]), Math.max(high, corners[i])];
    return [low, high];
  };
  function add(corners, name, css) {
    const colour = getComputedStyle(plan).getPropertyValue(css === "gone" ? "--red" : "--blue").trim();
    const shape = new THREE.BufferGeometry();
    shape.setAttribute("position", new THREE.BufferAttribute(corners, 3));
    shape.computeVertexNormals();
    const looks = { gone: { wireframe: true }, tape: { wireframe: true }, made: { transparent: true, opacity: 0.8, polygonOffset: true, polygonOffsetFactor: -1, polygonOffsetUnits: -1 } }[css];
    const material = css === "made" ? new THREE.MeshLambertMaterial({ color: colour, ...looks }) : new THREE.MeshBasicMaterial({ color: colour, ...looks });
    const mesh = new THREE.Mesh(shape, material);
    mesh.userData.names = Array(corners.length / 9).fill(name);
    scene.edits.add(mesh);
    if (css === "made") scene.changed.set(name, corners);
  }
  // its triangles fall together: what stands there is drawn by its wire alone
  function hideBody(name) {
    for (const mesh of scene.bodies.children) {
      if (mesh.material.side !== THREE.FrontSide) continue; // both sides share their corners
      const places = mesh.geometry.getAttribute("position");
      mesh.userData.names.forEach((each, i) => { if (each === name) places.array.fill(0, 9 * i, 9 * i + 9); });
      places.needsUpdate = true;
    }
    scene.hidden.add(name);
  }
  function showBodies() {
    for (const mesh of scene.bodies.children) {
      if (mesh.material.side !== THREE.FrontSide) continue;
      const places = mesh.geometry.getAttribute("position");
      const at = new Map();
      mesh.userData.names.forEach((each, i) => {
        const row = at.get(each) ?? 0;
        at.set(each, row + 1);
        if (scene.hidden.has(each)) places.array.set(scene.corners.get(each).subarray(9 * row, 9 * row + 9), 9 * i);
      });
      places.needsUpdate = true;
    }
    scene.hidden.clear();
  }

  // --- what is said, by element ---
  const thickness = (element) => Number(edits.partOf(element)?.dataset.thickness) || thin;
  function goes(element) {
    hideBody(element);
    add(scene.corners.get(element), element, "gone");
  }
  function wall(entry, element, name) {
    const old = element && scene.corners.get(element);
    if (entry.action === "remove" || entry.kind) return old && goes(element);
    if (element && !(entry.line || entry.thickness_m || entry.height_m)) return;
    if (old) goes(element);
    const [low, high] = old ? span(old) : [0, scene.height];
    const line = entry.line ?? edits.lineOf(element);
    add(strip(line, entry.thickness_m || (element ? thickness(element) : thin), low, entry.height_m || high), name, "made");
  }
  function opening(entry, element, name) {
    const old = element && scene.corners.get(element);
    if (entry.action === "remove") return old && goes(element);
    if (entry.action === "keep") return;
    const part = element && edits.partOf(element);
    const host = part ? `wall ${part.dataset.wall}` : edits.nearest("wall", edits.middle(entry.line));
    const drawn = element && edits.lineOf(element);
    const line = entry.line ?? (entry.width_m ? edits.widen(drawn, entry.width_m) : drawn);
    const [low, high] = old ? span(old) : heights[entry.kind ?? part?.dataset.kind] ?? heights.door;
    if (old) goes(element);
    add(strip(line, (host ? thickness(host) : thin) + 2 * beyond, entry.sill_m ?? low, entry.lintel_m ?? high), name, "made");
  }
  function room(entry, element, name) {
    if (entry.action === "split") add(strip(entry.line, beyond, 0, scene.height), name, "tape");
    if (entry.action === "remove" && element && scene.corners.has(element)) goes(element);
  }
  const thing = (entry, element, name) => entry.outline && add(prism(entry.outline, 0, entry.kind === "column" ? scene.height : 0.8), name, "made");
  const tape = (entry, element, name) => add(strip(entry.line, beyond, atHeight, atHeight + beyond), name, "tape");
  const bodies = { wall, opening, room, furniture: thing, length: tape };

  function put(text, css, [x, y], up) {
    const made = choices.make("span", text, { class: css });
    layer.append(made);
    marks.push([made, new THREE.Vector3(x - scene.middle[0], y - scene.middle[1], up)]);
  }
  function redraw() {
    if (!scene) return;
    for (const mesh of scene.edits.children) { mesh.geometry.dispose(); mesh.material.dispose(); }
    scene.edits.clear();
    scene.changed.clear();
    showBodies();
    layer.replaceChildren();
    marks = [];
    edits.entries().forEach((entry, number) => {
      if (!edits.isNew(entry)) return void (faults.of(entry) && put("!", "gone", edits.spotOf(entry), scene.height));
      const element = edits.elementOf(entry);
      const name = element ?? `entry ${number}`;
      bodies[entry.element]?.(entry, element, name);
      const corners = scene.changed.get(name) ?? scene.corners.get(name);
      const up = corners ? span(corners)[1] : entry.element === "length" ? atHeight : 0;
      const isGone = entry.action === "remove" || (entry.element === "wall" && entry.kind);
      const sign = faults.of(entry) ? "!" : isGone ? signs.remove : entry.element === "length" ? choices.describe(entry) : signs[entry.action] ?? "✎";
      put(sign, isGone || sign === "!" ? "gone" : "", edits.spotOf(entry), up);
    });
    for (const entry of edits.gone()) put("taken back", "", edits.spotOf(entry), 0);
  }
  // signs keep their size, and lie where the view has their places
  function place() {
    const { clientWidth: width, clientHeight: depth } = view;
    for (const [mark, at] of marks) {
      const { x, y, z } = at.clone().project(scene.camera);
      mark.hidden = z > 1 || scene.renderer.clippingPlanes.some((plane) => plane.distanceToPoint(at) < -beyond);
      mark.style.transform = `translate(${(((x + 1) * width) / 2).toFixed(1)}px, ${(((1 - y) * depth) / 2).toFixed(1)}px) translate(-50%, -100%)`;
    }
  }
  function begin(made, heightM) {
    scene = Object.assign(made, { edits: new THREE.Group(), changed: new Map(), hidden: new Set(), height: heightM });
    scene.whole.add(scene.edits);
    redraw();
  }
  return { begin, redraw, place };
})();
