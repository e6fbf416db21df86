"use strict";
// the plan: how it grows, zooms and moves; elements.js says what its parts are
const planView = (() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const plan = document.getElementById("plan");
  const view = document.getElementById("view");
  const slider = document.getElementById("k");
  const percent = (share) => `${(100 * share).toFixed(1)} %`;

  // --- the plan grows with the number of scans ---
  const all = (selector) => [...plan.querySelectorAll(selector)];
  const scans = all(".scan");
  const shown = all("#shown path");
  const stretches = all(".stretch").map((path) => ({
    path, first: Number(path.dataset.first), enough: Number(path.dataset.enough),
  }));

  function grow(k) {
    plan.classList.toggle("growing", k < data.chosen);
    for (const { path, first, enough } of stretches) {
      path.classList.toggle("later", first > k);
      path.classList.toggle("sure", enough > 0 && enough <= k);
    }
    for (const scan of scans) {
      scan.classList.toggle("later", Number(scan.dataset.rank) > k);
      scan.classList.toggle("newest", Number(scan.dataset.rank) === k && k < data.chosen);
    }
    for (const path of shown) path.classList.toggle("later", Number(path.dataset.rank) !== k);
    const covered = percent(data.covered[k - 1]);
    const said = `${k} of ${data.chosen} (scan ${data.scan_ids[k - 1]}): ${covered} of the ${data.objective}`;
    document.getElementById("said").textContent = said;
    slider.setAttribute("aria-valuetext", said);
    mark(k);
  }

  const chart = document.getElementById("chart");
  function mark(k) {
    const { width, scans: n, logarithmic } = chart.dataset;
    const share = Number(logarithmic) ? Math.log(k) / Math.log(n) : (k - 1) / Math.max(n - 1, 1);
    document.getElementById("chart-k").setAttribute("transform", `translate(${share * width} 0)`);
  }

  slider.addEventListener("input", () => grow(Number(slider.value)));

  const play = document.getElementById("play");
  let playing = null;
  function stop() {
    clearInterval(playing);
    playing = null;
    play.textContent = "Play";
    play.setAttribute("aria-pressed", "false");
  }
  play.addEventListener("click", () => {
    if (playing !== null) return stop();
    if (Number(slider.value) >= data.chosen) slider.value = 0;
    play.textContent = "Stop";
    play.setAttribute("aria-pressed", "true");
    playing = setInterval(() => {
      slider.value = Number(slider.value) + 1;
      grow(Number(slider.value));
      if (Number(slider.value) >= data.chosen) stop();
    }, Math.max(80, Math.min(600, 12000 / data.chosen)));
  });
  slider.addEventListener("pointerdown", stop);

  for (const box of document.querySelectorAll("[data-layer]")) {
    box.addEventListener("change", () =>
      document.getElementById(box.dataset.layer).classList.toggle("off", !box.checked));
  }

  // --- zoom and drag: the view box, in metres ---
  const whole = plan.viewBox.baseVal;
  const fit = { x: whole.x, y: whole.y, width: whole.width, height: whole.height };
  let box = { ...fit };

  let pixels = 1;

  function show() {
    plan.setAttribute("viewBox", `${box.x} ${box.y} ${box.width} ${box.height}`);
    pixels = plan.getScreenCTM().a;
    plan.style.setProperty("--px", 1 / pixels);
    fitLabels();
    const power = 10 ** Math.floor(Math.log10(160 / pixels));
    const length = [5, 2, 1].map((m) => m * power).find((m) => m * pixels <= 160);
    const bar = document.querySelector("#scale span");
    bar.style.width = `${length * pixels}px`;
    bar.textContent = `${Number(length.toPrecision(1))} m`;
    for (const follow of followers) follow();
  }
  const followers = [];

  // a letter is about 7 pixels wide; what has no room is not written until the plan is nearer
  const labels = all(".label").map((label) => ({
    label, width: Number(label.dataset.width), texts: [...label.children].map((text) => text.textContent.length),
  }));
  function fitLabels() {
    for (const { label, width, texts } of labels) {
      const letters = (width * pixels) / 7;
      label.classList.toggle("tight", texts[0] > letters);
      label.classList.toggle("narrow", texts[1] > letters || width * pixels < 34);
    }
  }

  function metres(event) {
    const place = new DOMPoint(event.clientX, event.clientY).matrixTransform(plan.getScreenCTM().inverse());
    return { x: place.x, y: place.y };
  }

  function zoom(factor, at) {
    const width = Math.min(Math.max(box.width * factor, fit.width / 400), fit.width * 4);
    const by = width / box.width;
    at ??= { x: box.x + box.width / 2, y: box.y + box.height / 2 };
    box = { x: at.x + (box.x - at.x) * by, y: at.y + (box.y - at.y) * by, width, height: box.height * by };
    show();
  }

  function move(right, down) {
    box.x += right;
    box.y += down;
    show();
  }

  // the page scrolls over the plan as elsewhere; enlarged there is nothing to scroll
  const drawing = document.getElementById("drawing");
  const isEnlarged = () => drawing.classList.contains("enlarged");
  plan.addEventListener("wheel", (event) => {
    if (!event.ctrlKey && !event.metaKey && !isEnlarged()) return say("Ctrl with the wheel zooms");
    event.preventDefault();
    zoom(Math.exp(Math.max(-1, Math.min(1, event.deltaY / 300))), metres(event));
  }, { passive: false });

  const fingers = new Map();
  plan.addEventListener("pointerdown", (event) => {
    fingers.set(event.pointerId, event);
  });
  plan.addEventListener("pointermove", (event) => {
    const before = fingers.get(event.pointerId);
    if (!before) return;
    // not before it moves: a click on a wall is to stay one
    if (!plan.hasPointerCapture(event.pointerId)) {
      if (Math.hypot(event.clientX - before.clientX, event.clientY - before.clientY) < 4) return;
      plan.setPointerCapture(event.pointerId);
    }
    plan.classList.add("dragged");
    const [from, to] = [metres(before), metres(event)];
    const other = [...fingers.values()].find((finger) => finger.pointerId !== event.pointerId);
    fingers.set(event.pointerId, event);
    if (other === undefined) return move(from.x - to.x, from.y - to.y);
    const still = metres(other);
    const far = (place) => Math.hypot(place.x - still.x, place.y - still.y);
    zoom(far(from) / Math.max(far(to), 1e-6), still);
  });
  for (const end of ["pointerup", "pointercancel"]) {
    plan.addEventListener(end, (event) => {
      fingers.delete(event.pointerId);
      plan.classList.toggle("dragged", fingers.size > 0);
    });
  }

  const keys = {
    "+": () => zoom(0.8), "=": () => zoom(0.8), "-": () => zoom(1.25), 0: () => reset(),
    ArrowLeft: () => move(-box.width / 10, 0), ArrowRight: () => move(box.width / 10, 0),
    ArrowUp: () => move(0, -box.height / 10), ArrowDown: () => move(0, box.height / 10),
  };
  plan.addEventListener("keydown", (event) => {
    if (!(event.key in keys) || event.ctrlKey || event.metaKey) return;
    event.preventDefault();
    keys[event.key]();
  });
  function reset() {
    box = { ...fit };
    show();
  }
  const buttons = { in: () => zoom(0.7), out: () => zoom(1 / 0.7), fit: reset };
  for (const button of document.querySelectorAll("[data-zoom]")) {
    button.addEventListener("click", buttons[button.dataset.zoom]);
  }
  addEventListener("resize", show);
  addEventListener("beforeprint", reset);

  const hint = document.getElementById("hint");
  let hiding = null;
  function say(text, seconds = 2) {
    clearTimeout(hiding);
    hint.textContent = text;
    hint.hidden = text === "";
    if (seconds) hiding = setTimeout(() => { hint.hidden = true; }, 1000 * seconds);
  }

  const enlarge = document.getElementById("enlarge");
  enlarge.addEventListener("click", () => {
    drawing.classList.toggle("enlarged");
    enlarge.setAttribute("aria-pressed", String(isEnlarged()));
    reset();
  });

  function lookAt(place) {
    const width = Math.min(box.width, Math.max(fit.width / 3, 6));
    const height = (box.height * width) / box.width;
    box = { x: place.x - width / 2, y: place.y - height / 2, width, height };
    show();
  }

  // --- the tables: sorted by any column; a wall's row shows the wall ---
  for (const button of document.querySelectorAll("th button")) {
    button.addEventListener("click", () => {
      const head = button.parentElement;
      const column = head.cellIndex;
      const down = head.getAttribute("aria-sort") === "ascending";
      for (const other of head.parentElement.cells) other.removeAttribute("aria-sort");
      head.setAttribute("aria-sort", down ? "descending" : "ascending");
      const body = head.closest("table").tBodies[0];
      const key = (row) => {
        const cell = row.cells[column];
        if (!cell.classList.contains("number")) return cell.textContent;
        return cell.dataset.sort === undefined ? Infinity : Number(cell.dataset.sort);
      };
      const order = (a, b) => (typeof a === "number" ? a - b || 0 : a.localeCompare(b));
      const rows = [...body.rows].sort((a, b) => (down ? -1 : 1) * order(key(a), key(b)));
      body.append(...rows);
    });
  }

  for (const box of document.querySelectorAll("[data-layer]")) {
    document.getElementById(box.dataset.layer).classList.toggle("off", !box.checked);
  }
  view.style.setProperty("--aspect", fit.width / fit.height);
  show();
  grow(data.chosen);
  return { data, plan, view, metres, lookAt, say, pixels: () => pixels, follow: (each) => followers.push(each) };
})();
