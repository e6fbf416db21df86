// the plan in space: bodies and points, cut at a height or along a line; three.js is read when it is first shown
const solid = (() => {
  const { plan, view, metres, say } = planView;
  const byId = (id) => document.getElementById(id);
  const [canvas, bar, pressed, height, said, note, allPoints] = ["space", "space-bar", "in-space", "section", "section-said", "space-note", "all-points"].map(byId);
  const stored = (id) => JSON.parse(byId(id).textContent);
  let scene = null; // what is drawn, once it was shown
  let isOn = false;
  let isOwn = false; // whether what was chosen was chosen here
  const isMissing = () => !window.DecompressionStream || !document.createElement("canvas").getContext("webgl2");

  async function unpack(text) {
    const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
    return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip")));
  }
  async function readLibrary() {
    const script = choices.make("script", await (await unpack(byId("three").textContent)).text());
    document.head.append(script);
  }

  // --- what is drawn ---
  const data = stored("solid-data");
  const places = (steps, stepM, lowM = data.low_m, middle = scene.middle) => {
    const xyz = new Float32Array(steps.length);
    for (let i = 0; i < steps.length; i++) xyz[i] = lowM[i % 3] + steps[i] * stepM - middle[i % 3];
    return xyz;
  };
  async function makeBodies() {
    const { parts, step_m: stepM, data: packed } = data.bodies;
    const xyz = places(new Uint16Array(await (await unpack(packed)).arrayBuffer()), stepM);
    const byColour = new Map();
    let first = 0;
    for (const [element, colour, n] of parts) {
      const corners = xyz.subarray(9 * first, 9 * (first += n));
      scene.corners.set(element, corners);
      if (!byColour.has(colour)) byColour.set(colour, []);
      byColour.get(colour).push([element, corners]);
    }
    for (const [colour, elements] of byColour) addBodies(colour, elements);
  }
  const surface = (corners) => {
    const made = new THREE.BufferGeometry();
    made.setAttribute("position", new THREE.BufferAttribute(corners, 3));
    made.computeVertexNormals();
    return made;
  };
  // what is cut shows its inner sides: of one colour, they look as full as it is
  const materials = (colour, opacity) => {
    const more = { transparent: opacity < 1, opacity, depthWrite: opacity === 1 };
    return [new THREE.MeshLambertMaterial({ color: colour, ...more }), new THREE.MeshBasicMaterial({ color: opacity < 1 ? colour : "#4a4845", side: THREE.BackSide, ...more })];
  };
  function addBodies(colour, elements) {
    const corners = new Float32Array(elements.reduce((sum, [, each]) => sum + each.length, 0));
    const names = [];
    let at = 0;
    for (const [element, each] of elements) {
      corners.set(each, at);
      at += each.length;
      for (let i = 0; i < each.length; i += 9) names.push(element);
    }
    const shape = surface(corners);
    for (const material of materials(colour.slice(0, 7), parseInt(colour.slice(7), 16) / 255)) {
      const mesh = new THREE.Mesh(shape, material);
      mesh.userData.names = names;
      scene.bodies.add(mesh);
    }
  }
  // from blue at the floor to yellow at the ceiling: their lightness tells them apart, too
  const ramp = [[47, 75, 124], [31, 150, 139], [253, 190, 60]];
  const steps = 256; // of height that have a colour each
  const shades = Array.from({ length: steps }, (_, i) => {
    const share = (2 * i) / steps;
    const [low, high] = [ramp[Math.floor(share)], ramp[Math.floor(share) + 1]];
    return low.map((from, k) => from + (share % 1) * (high[k] - from));
  });
  const colourAt = (up) => shades[Math.max(0, Math.min(steps - 1, Math.floor((steps * up) / data.height_m)))];
  function showPoints(xyz, n, nAll) {
    const colours = new Uint8Array(xyz.length);
    for (let i = 0; i < xyz.length; i += 3) colours.set(colourAt(xyz[i + 2]), i);
    const cloud = new THREE.BufferGeometry();
    cloud.setAttribute("position", new THREE.BufferAttribute(xyz, 3));
    cloud.setAttribute("color", new THREE.BufferAttribute(colours, 3, true));
    scene.points.geometry.dispose();
    scene.points.geometry = cloud;
    const number = (m) => m.toLocaleString("en");
    note.textContent = `${data.heights} ${number(n)} of ${number(nAll)} points. Orange is to be verified. Changes: blue with + or ✎, and red wire with ✗ is to go; walls are cut and joined once the plan is made anew.`;
    draw();
  }
  async function unpackPoints() {
    const { n, data: packed } = data.points;
    const bytes = new Uint8Array(await (await unpack(packed)).arrayBuffer());
    const steps = new Uint16Array(3 * n);
    for (let axis = 0; axis < 3; axis++) {
      const low = 2 * n * axis;
      let step = 0;
      for (let i = 0; i < n; i++) {
        step = (step + bytes[low + i] + 256 * bytes[low + n + i]) & 65535;
        steps[3 * i + axis] = step;
      }
    }
    return steps;
  }
  let unpacked = null;
  const readSteps = () => (unpacked ??= unpackPoints());
  // x and y of the map and height above the floor, of each point after the other
  const points = async () => places(await readSteps(), data.points.step_m, data.low_m, [0, 0, 0]);
  async function readPoints() {
    const { n, n_all: nAll, step_m: stepM } = data.points;
    showPoints(places(await readSteps(), stepM), n, nAll);
  }
  async function fetchPoints() {
    allPoints.disabled = true;
    try {
      const answer = await fetch("api/points");
      if (!answer.ok) return say((await answer.json()).error, 5);
      const content = await answer.arrayBuffer();
      const begin = 4 + new DataView(content).getUint32(0, true);
      const { low_m: lowM, step_m: stepM, n, n_all: nAll } = JSON.parse(new TextDecoder().decode(content.slice(4, begin)));
      showPoints(places(new Uint16Array(content.slice(begin)), stepM, lowM), n, nAll);
      allPoints.hidden = true;
    } catch {
      say("The server does not answer: the points of the page are shown.", 5);
    }
    allPoints.disabled = false;
  }

  async function make() {
    await readLibrary();
    const [width, depth] = [0, 1].map((axis) => data.high_m[axis] - data.low_m[axis]);
    const middle = [data.low_m[0] + width / 2, data.low_m[1] + depth / 2, 0];
    scene = { middle, extent: [width, depth], size: Math.hypot(width, depth), corners: new Map(), cut: null };
    scene.renderer = new THREE.WebGLRenderer({ canvas, antialias: true });
    scene.camera = new THREE.PerspectiveCamera(45, 1, scene.size / 500, scene.size * 10);
    scene.camera.up.set(0, 0, 1);
    scene.controls = new THREE.OrbitControls(scene.camera, canvas);
    scene.controls.addEventListener("change", draw);
    scene.whole = new THREE.Scene();
    scene.bodies = new THREE.Group();
    scene.points = new THREE.Points(new THREE.BufferGeometry(), new THREE.PointsMaterial({ size: 1.6, sizeAttenuation: false, vertexColors: true }));
    scene.picked = new THREE.Mesh(new THREE.BufferGeometry(), new THREE.MeshBasicMaterial({ transparent: true, opacity: 0.75, polygonOffset: true, polygonOffsetFactor: -2, polygonOffsetUnits: -2 }));
    scene.level = new THREE.Plane(new THREE.Vector3(0, 0, -1), 0);
    const light = new THREE.DirectionalLight("#ffffff", 1.6);
    light.position.set(-0.5, -1, 1.6);
    scene.whole.add(new THREE.AmbientLight("#ffffff", 1.5), light, scene.bodies, scene.points, scene.picked);
    await makeBodies();
    solidEdits.begin(scene, data.height_m);
    lookAtAll();
    canvas.addEventListener("webglcontextlost", () => refuse("The 3-D view has stopped: the plan alone is here."));
  }

  // --- how it is looked at ---
  let isDue = false;
  function draw() {
    if (!isOn || isDue) return;
    isDue = true;
    requestAnimationFrame(() => {
      isDue = false;
      if (!isOn) return;
      scene.renderer.render(scene.whole, scene.camera);
      solidEdits.place();
    });
  }
  function fit() {
    if (!isOn) return;
    const { clientWidth: width, clientHeight: depth } = view;
    scene.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    scene.renderer.setSize(width, depth, false);
    scene.camera.aspect = width / depth;
    scene.camera.updateProjectionMatrix();
    draw();
  }
  new ResizeObserver(fit).observe(view);
  function look(from, to) {
    scene.controls.target.set(...to);
    scene.camera.position.set(...from);
    scene.controls.update();
    draw();
  }
  // from a place of the map towards another: a little before it, as what turns goes round what is looked at
  function standAt(from, to) {
    if (!isOn) return;
    const [eye, aim] = [from, to].map((place) => place.map((m, i) => m - scene.middle[i]));
    look(eye, eye.map((m, i) => m + (aim[i] - m) / 2));
  }
  // as near as all of it is seen, in a wide view and in a narrow one
  function lookAtAll() {
    const [width, depth] = scene.extent;
    const far = Math.max((1.2 * width * view.clientHeight) / view.clientWidth, 0.9 * depth) + depth / 2;
    look([0, -0.67 * far, 0.74 * far], [0, 0, 0]);
  }
  function turn(aside, up) {
    const { camera, controls } = scene;
    const from = camera.position.clone().sub(controls.target);
    const flat = Math.hypot(from.x, from.y);
    const [around, rise] = [Math.atan2(from.y, from.x) + aside, Math.max(-0.2, Math.min(1.55, Math.atan2(from.z, flat) + up))];
    const far = from.length();
    look([Math.cos(around) * Math.cos(rise), Math.sin(around) * Math.cos(rise), Math.sin(rise)].map((m, i) => controls.target.getComponent(i) + far * m), controls.target.toArray());
  }
  function shift(right, ahead) {
    const { camera, controls } = scene;
    const to = controls.target.clone().sub(camera.position);
    const step = to.length() / 12 / (Math.hypot(to.x, to.y) || 1);
    const by = [step * (right * to.y + ahead * to.x), step * (ahead * to.y - right * to.x), 0];
    look(camera.position.toArray().map((m, i) => m + by[i]), controls.target.toArray().map((m, i) => m + by[i]));
  }
  function zoom(factor) {
    const { camera, controls } = scene;
    const [to, from] = [controls.target.toArray(), camera.position.toArray()];
    look(from.map((m, i) => to[i] + (m - to[i]) * factor), to);
  }
  const keys = {
    "+": () => zoom(0.8), "=": () => zoom(0.8), "-": () => zoom(1.25), 0: lookAtAll,
    ArrowLeft: (isShift) => (isShift ? shift(-1, 0) : turn(-0.15, 0)), ArrowRight: (isShift) => (isShift ? shift(1, 0) : turn(0.15, 0)),
    ArrowUp: (isShift) => (isShift ? shift(0, 1) : turn(0, 0.12)), ArrowDown: (isShift) => (isShift ? shift(0, -1) : turn(0, -0.12)),
  };
  canvas.addEventListener("keydown", (event) => {
    if (!(event.key in keys) || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    keys[event.key](event.shiftKey);
  });
  // the page scrolls over it as over the plan
  view.addEventListener("wheel", (event) => {
    const isScroll = !event.ctrlKey && !event.metaKey && byId("enlarge").getAttribute("aria-pressed") === "false";
    if (!isOn || event.target !== canvas || !isScroll) return;
    event.stopImmediatePropagation();
    say("Ctrl with the wheel zooms");
  }, { capture: true });

  // --- sections ---
  function cutAt() {
    const metresUp = Number(height.value);
    const text = metresUp >= Number(height.max) ? "whole" : `${metresUp.toFixed(2)} m above the floor`;
    said.textContent = text;
    height.setAttribute("aria-valuetext", text);
    scene.level.constant = metresUp;
    scene.renderer.clippingPlanes = [...(metresUp < Number(height.max) ? [scene.level] : []), ...(scene.cut ? [scene.cut.plane] : [])];
    for (const id of ["other-side", "uncut"]) byId(id).hidden = !scene.cut;
    draw();
  }
  function cutAlong([start, end], side = 1) {
    const [a, b] = [start, end].map(([x, y]) => [x - scene.middle[0], y - scene.middle[1]]);
    const along = [b[0] - a[0], b[1] - a[1]].map((m) => (side * m) / Math.hypot(b[0] - a[0], b[1] - a[1]));
    const normal = new THREE.Vector3(-along[1], along[0], 0);
    const plane = new THREE.Plane().setFromNormalAndCoplanarPoint(normal, new THREE.Vector3(...a, 0));
    scene.cut = { line: [start, end], side, plane };
    cutAt();
    const far = Math.max(Math.hypot(b[0] - a[0], b[1] - a[1]), 2 * data.height_m) * 1.2;
    const to = [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, data.height_m / 2];
    look([to[0] - far * normal.x, to[1] - far * normal.y, to[2] + far / 4], to);
  }
  height.addEventListener("input", cutAt);
  byId("cut").addEventListener("click", () => {
    plan.focus({ preventScroll: true });
    tools.begin("tape", (line) => show().then(() => cutAlong(line)), "Tap where the section begins, then where it ends");
    plan.focus({ preventScroll: true });
  });
  byId("other-side").addEventListener("click", () => cutAlong(scene.cut.line, -scene.cut.side));
  byId("uncut").addEventListener("click", () => { scene.cut = null; cutAt(); });

  // --- the same element is chosen here and in the plan ---
  const isLeft = (place) => scene.renderer.clippingPlanes.every((plane) => plane.distanceToPoint(place) >= 0);
  function elementAt(event) {
    const frame = canvas.getBoundingClientRect();
    const at = new THREE.Vector2((2 * (event.clientX - frame.x)) / frame.width - 1, 1 - (2 * (event.clientY - frame.y)) / frame.height);
    const ray = new THREE.Raycaster();
    ray.setFromCamera(at, scene.camera);
    const hit = ray.intersectObjects([...scene.edits.children, ...scene.bodies.children]).find(({ point }) => isLeft(point));
    return hit?.object.userData.names[hit.faceIndex];
  }
  let down = null;
  canvas.addEventListener("pointerdown", (event) => { down = [event.clientX, event.clientY]; });
  canvas.addEventListener("click", (event) => {
    // what turns the view chooses nothing
    if (down && Math.hypot(event.clientX - down[0], event.clientY - down[1]) > 4) return;
    const element = elementAt(event);
    isOwn = true;
    const [kind, number] = (element ?? "").split(" ");
    if (kind === "entry") elements.showEntry(Number(number), metres(event));
    else if (element) elements.showElement(element, metres(event));
    else elements.closeCard();
    isOwn = false;
  });
  function pick(element) {
    if (!scene) return;
    // a face is one side of a wall, and no body of its own
    const corners = scene.changed.get(element) ?? scene.corners.get(element);
    scene.picked.visible = corners !== undefined;
    if (!corners) return draw();
    scene.picked.geometry.dispose();
    scene.picked.geometry = surface(corners);
    scene.picked.material.color.set(getComputedStyle(plan).getPropertyValue("--red").trim());
    if (isOwn) return draw();
    scene.picked.geometry.computeBoundingSphere();
    const { controls, camera } = scene;
    const by = scene.picked.geometry.boundingSphere.center.clone().sub(controls.target);
    look(camera.position.clone().add(by).toArray(), controls.target.clone().add(by).toArray());
  }
  edits.onChange(() => {
    solidEdits.redraw();
    if (isOn) draw();
  });
  let chosen = null;
  addEventListener("picked", (event) => {
    chosen = event.detail;
    if (isOn) pick(chosen);
  });

  // --- in the place of the plan, and back ---
  function refuse(text) {
    hide();
    pressed.disabled = true;
    note.textContent = text;
    note.hidden = false;
  }
  let making = null;
  async function show() {
    if (isMissing()) return refuse("This browser shows no 3-D, as WebGL 2 is switched off or missing: the plan alone is here.");
    elements.closeCard();
    try {
      making ??= make();
      await making;
    } catch (error) {
      return refuse(`This browser shows no 3-D (${error.message}): the plan alone is here.`);
    }
    isOn = true;
    toggle();
    scene.renderer.setClearColor(getComputedStyle(plan).getPropertyValue("--paper").trim());
    scene.points.visible = document.querySelector("[data-layer=points]").checked;
    allPoints.hidden = byId("save").hidden || !note.textContent.includes(" of ") && note.textContent !== "";
    fit();
    cutAt();
    pick(chosen);
    if (!scene.points.geometry.getAttribute("position")) await readPoints();
  }
  function toggle() {
    view.classList.toggle("space", isOn);
    for (const part of [canvas, bar, note, byId("space-marks")]) part.hidden = !isOn;
    byId("growing").hidden = isOn;
    pressed.setAttribute("aria-pressed", String(isOn));
    dispatchEvent(new Event("space"));
  }
  function hide() {
    if (!isOn) return;
    isOn = false;
    elements.closeCard();
    toggle();
  }
  pressed.addEventListener("click", () => (isOn ? hide() : show()));
  allPoints.addEventListener("click", fetchPoints);
  document.querySelector("[data-layer=points]").addEventListener("change", (event) => {
    if (!scene) return;
    scene.points.visible = event.target.checked;
    draw();
  });
  byId("zoom").addEventListener("click", (event) => {
    const act = { in: () => zoom(0.7), out: () => zoom(1 / 0.7), fit: lookAtAll }[event.target.dataset.zoom];
    if (!isOn || !act) return;
    event.stopPropagation();
    act();
  }, { capture: true });
  // what is drawn or moved is drawn on the plan
  for (const name of ["begin", "move"]) {
    const act = tools[name];
    tools[name] = (...given) => { hide(); return act(...given); };
  }
  return { show, hide, isOn: () => isOn, isMissing, standAt, points, height_m: data.height_m, colourAt, elementAt, scene: () => scene };
})();
