// lines drawn on the plan by two taps, or with arrow keys and Enter; ends of walls and openings that are moved
const tools = (() => {
  const { plan, metres, say, follow, pixels } = planView;
  const group = document.getElementById("tape");
  const snap = 14; // pixels within which an end goes to what is there already: less than a thumb is wide
  const even = 4; // degrees within which a line is drawn along or across the walls
  const svg = (tag, attributes) => {
    const made = document.createElementNS("http://www.w3.org/2000/svg", tag);
    for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
    return made;
  };
  const beyond = 0.45; // metres that an opening may reach beyond its wall, a little less than when it is carried out
  const drawn = [...plan.querySelectorAll('.pick[data-element^="wall "]')].map(({ dataset: { element } }) => [element, edits.lineOf(element)]);
  let walls = []; // as they will be: what is said to be none holds no opening
  edits.onChange(() => {
    const isLeft = (entry) => !entry || !edits.isNew(entry) || !(entry.action === "remove" || entry.kind);
    const known = drawn.map(([element, line]) => [edits.entryOf(element), line]);
    const made = edits.fresh().filter(({ element, action }) => element === "wall" && action === "add");
    walls = [...known.filter(([entry]) => isLeft(entry)).map(([entry, line]) => entry?.line ?? line), ...made.map(({ line }) => line)];
  });
  const far = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1]);
  const onLine = (at, [a, b], over = 0) => {
    const [dx, dy] = [b[0] - a[0], b[1] - a[1]];
    const more = over / (Math.hypot(dx, dy) || 1);
    const t = Math.max(-more, Math.min(1 + more, ((at[0] - a[0]) * dx + (at[1] - a[1]) * dy) / (dx * dx + dy * dy || 1)));
    return [a[0] + t * dx, a[1] + t * dy];
  };
  const closest = (at, places) => places.reduce((best, place) => (far(at, place) < far(at, best) ? place : best), places[0]);

  // ends of walls first, then their lines, then the directions that walls have
  function snapped(at, from) {
    const reach = snap / pixels();
    const end = walls.length ? closest(at, walls.flat()) : at;
    if (far(at, end) < reach) return end;
    const beside = walls.length ? closest(at, walls.map((line) => onLine(at, line))) : at;
    if (from && far(from, at) > 0) {
      const angle = ([a, b]) => Math.atan2(b[1] - a[1], b[0] - a[0]);
      const drawn = angle([from, at]);
      const quarter = Math.PI / 2;
      for (const line of walls) {
        const off = drawn - angle(line) - quarter * Math.round((drawn - angle(line)) / quarter);
        if (Math.abs(off) > (even * Math.PI) / 180) continue;
        const [cos, sin] = [Math.cos(drawn - off), Math.sin(drawn - off)];
        const length = (at[0] - from[0]) * cos + (at[1] - from[1]) * sin;
        at = [from[0] + length * cos, from[1] + length * sin];
        const crossing = walls.map((each) => onLine(at, each)).find((place) => far(place, at) < reach);
        return crossing ?? at;
      }
    }
    return far(at, beside) < reach ? beside : at;
  }
  // of the walls that an opening may begin in that of both ends
  function hostOf(...places) {
    const off = (line) => places.reduce((sum, place) => sum + edits.distance(place, line), 0);
    const near = walls.filter((line) => edits.distance(places[0], line) <= 0.5);
    return near.reduce((best, each) => (off(each) < off(best) ? each : best), near[0]);
  }

  let tool = null; // what is drawn, what becomes of it
  let from = null;
  let cursor = null;
  function show(to) {
    const [x, y] = to;
    const made = [svg("path", { class: "cross", d: `M${x} ${-y - 8 / pixels()}v${16 / pixels()}M${x - 8 / pixels()} ${-y}h${16 / pixels()}` })];
    if (from) {
      const text = svg("text", { x: (from[0] + x) / 2, y: -(from[1] + y) / 2, dy: "-.5em" });
      text.textContent = `${far(from, to).toFixed(2)} m`;
      made.push(svg("path", { d: `M${from[0]} ${-from[1]}L${x} ${-y}` }), text);
    }
    group.replaceChildren(...made);
  }
  function stretch([start, end]) {
    from = start;
    show(end);
    from = null;
  }
  function begin(name, act, hint) {
    stop();
    tool = { name, act };
    cursor = null;
    plan.classList.add("measuring");
    say(`${hint}; Escape ends`, 0);
  }
  function stop() {
    if (tool) say("", 0);
    tool = from = null;
    group.replaceChildren();
    plan.classList.remove("measuring");
    dropHandles();
  }
  // an opening lies on its wall, everything else where it snaps to
  function settle(at) {
    const host = tool.name === "opening" && (from ? hostOf(from, at) : hostOf(at));
    return host ? onLine(at, host, beyond) : ["tape", "place"].includes(tool.name) ? at : snapped(at, from);
  }
  function put(at) {
    if (tool.name === "opening" && !from && !hostOf(at)) return say("An opening lies in a wall: tap on one", 3);
    const host = tool.name === "opening" && from && hostOf(from, at);
    const place = settle(at).map((m) => Number(m.toFixed(3)));
    // both ends lie on the wall that is nearest to both
    if (host) from = onLine(from, host, beyond).map((m) => Number(m.toFixed(3)));
    const { act, name } = tool;
    if (name === "place") {
      stop();
      return act(place);
    }
    if (!from) {
      from = place;
      return show(place);
    }
    if (far(from, place) < 0.05) return say(tool.name === "opening" ? "Too short: tap where it ends, on this wall" : "Too short: tap where it ends", 3);
    const line = [from, place];
    stop();
    act(line);
  }
  plan.addEventListener("pointermove", (event) => {
    if (!tool || !(from || tool.name !== "tape") || event.pointerType === "touch") return;
    show(settle(edits.place(metres(event))));
  });
  plan.addEventListener("click", (event) => {
    if (!tool) return;
    event.stopImmediatePropagation();
    put(edits.place(metres(event)));
  }, { capture: true });
  const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
  plan.addEventListener("keydown", (event) => {
    if (!tool || !(event.key in arrows || event.key === "Enter")) return;
    event.preventDefault();
    event.stopImmediatePropagation();
    const { x, y, width, height } = plan.viewBox.baseVal;
    cursor ??= [x + width / 2, -(y + height / 2)];
    if (event.key === "Enter") return put(cursor);
    const by = event.shiftKey ? 0.01 : 0.1; // metres
    cursor = cursor.map((m, i) => m + by * arrows[event.key][i]);
    show(settle(cursor));
  }, { capture: true });

  // --- ends that are dragged, or moved with arrow keys ---
  const handles = document.getElementById("handles");
  let moving = null;
  function dropHandles() {
    moving = null;
    handles.replaceChildren();
    plan.setAttribute("role", "img");
  }
  function place() {
    if (!moving) return;
    const { line, circles, path } = moving;
    const spots = [line[0], edits.middle(line), line[1]];
    circles.forEach((circle, i) => {
      circle.setAttribute("cx", spots[i][0]);
      circle.setAttribute("cy", -spots[i][1]);
    });
    path.setAttribute("d", `M${line.map(([x, y]) => `${x} ${-y}`).join("L")}`);
  }
  follow(place);
  function shift(i, to) {
    const { line, rail, isOpening } = moving;
    const middle = edits.middle(line);
    if (i === 1) {
      const by = isOpening ? onLine(to, rail).map((m, k) => m - onLine(middle, rail)[k]) : to.map((m, k) => m - middle[k]);
      moving.line = line.map((end) => end.map((m, k) => m + by[k]));
    } else {
      const other = line[2 - i] ?? line[0];
      moving.line = line.toSpliced(i / 2, 1, isOpening ? onLine(to, rail) : snapped(to, other));
    }
    place();
  }
  function move(element, act) {
    stop();
    const isOpening = element.startsWith("opening");
    const line = edits.entryOf(element)?.line ?? edits.lineOf(element);
    const host = isOpening && edits.partOf(`wall ${edits.partOf(element).dataset.wall}`);
    const names = ["one end", "the whole", "the other end"];
    const circles = names.map((name, i) => {
      const circle = svg("circle", { class: "handle", r: 0.1, tabindex: 0, role: "button", "aria-label": `move ${name} with the arrow keys` });
      circle.addEventListener("pointerdown", (event) => {
        event.stopPropagation();
        circle.setPointerCapture(event.pointerId);
      });
      circle.addEventListener("pointermove", (event) => {
        if (circle.hasPointerCapture(event.pointerId)) shift(i, edits.place(metres(event)));
      });
      circle.addEventListener("click", (event) => event.stopPropagation());
      circle.addEventListener("keydown", (event) => {
        if (!(event.key in arrows)) return;
        event.preventDefault();
        event.stopPropagation();
        const spot = [moving.line[0], edits.middle(moving.line), moving.line[1]][i];
        const by = event.shiftKey ? 0.01 : 0.1;
        const to = spot.map((m, k) => m + by * arrows[event.key][k]);
        if (i === 1 || moving.isOpening) return shift(i, to);
        moving.line = moving.line.toSpliced(i / 2, 1, to);
        place();
      });
      return circle;
    });
    const path = svg("path", { class: "moved" });
    handles.replaceChildren(path, ...circles);
    // a picture has no parts that are pressed
    plan.setAttribute("role", "group");
    moving = { line, circles, path, isOpening, rail: host ? edits.lineOf(host.dataset.element) : line };
    place();
    circles[1].focus({ preventScroll: true });
    return () => {
      const moved = moving?.line.map((end) => end.map((m) => Number(m.toFixed(3))));
      stop();
      if (moved) act(moved);
    };
  }
  return { begin, stop, move, stretch, walls: () => walls, isBusy: () => tool !== null || moving !== null };
})();
