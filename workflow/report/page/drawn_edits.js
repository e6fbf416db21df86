// changes drawn over the plan: at once, and as what they are until the plan is made anew
(() => {
  const { plan, data } = planView;
  const group = document.getElementById("edits");
  const ticks = document.getElementById("ticks");
  const thin = 0.1; // metres that a wall of unknown thickness is drawn with
  const svg = (tag, attributes, text) => {
    const made = document.createElementNS("http://www.w3.org/2000/svg", tag);
    for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
    if (text) made.textContent = text;
    return made;
  };
  const trace = (line) => `M${line.map(([x, y]) => `${x} ${-y}`).join("L")}`;
  const draw = (css, d, width, more = {}) => {
    const path = svg("path", { class: css, d, ...more });
    if (width) path.style.strokeWidth = width;
    group.append(path);
    return path;
  };
  const thickness = (element) => Number(edits.partOf(element)?.dataset.thickness) || thin;
  const shape = (element) => edits.partOf(element).getAttribute("d");
  // symbols of openings, or of those of a wall, give way to what is drawn anew
  const symbols = (attribute, element) => plan.querySelectorAll(`#finished [data-${attribute}="${element}"]`);
  const hide = (attribute, element) => { for (const symbol of symbols(attribute, element)) symbol.classList.add("off"); };

  // the symbol of sheets: along its line from 0 to 1, across it in widths of the wall
  function drawSymbol(kind, [[x0, y0], [x1, y1]], width) {
    const [dx, dy] = [x1 - x0, y1 - y0];
    const w = width / Math.hypot(dx, dy);
    return data.symbols[kind].map((path) => trace(path.map(([u, v]) => [x0 + u * dx - v * w * dy, y0 + u * dy + v * w * dx]))).join("");
  }
  function drawWall(entry, element, number) {
    const old = element && thickness(element);
    if (element && entry.action === "keep") return;
    if (element) {
      draw("cover body", edits.partOf(element).dataset.body, 0.04);
      hide("host", element);
    }
    if (entry.action === "remove" || entry.kind) return void draw(`gone ${entry.kind ?? ""}`, shape(element));
    const width = entry.thickness_m || old || thin;
    draw("solid", entry.line ? trace(entry.line) : shape(element), width, entry.action === "add" ? { "data-entry": number } : {});
  }
  function drawOpening(entry, element, number) {
    if (entry.action === "keep") return;
    const part = element && edits.partOf(element);
    const wall = part ? `wall ${part.dataset.wall}` : edits.nearest("wall", edits.middle(entry.line));
    const width = wall && edits.partOf(wall) ? thickness(wall) : thin;
    if (part) {
      draw("solid", shape(element), width);
      hide("opening", element);
    }
    if (entry.action === "remove") return;
    if (entry.swing) {
      const jambs = entry.line ?? edits.lineOf(element);
      const far = ([x, y]) => Math.hypot(x - entry.swing[0], y - entry.swing[1]);
      draw("leaf", trace([jambs[far(jambs[0]) < far(jambs[1]) ? 0 : 1], entry.swing]));
    }
    const line = entry.line ?? (entry.width_m ? edits.widen(edits.lineOf(element), entry.width_m) : null);
    const d = line ? trace(line) : shape(element);
    draw("cover", d, width + 0.04);
    const kind = entry.kind ?? part.dataset.kind;
    draw(`opening ${kind}`, drawSymbol(kind, line ?? edits.lineOf(element), width), 0, entry.action === "add" ? { "data-entry": number } : {});
  }
  function relabel(element, words, isArea) {
    const label = plan.querySelector(`[data-label="${element}"]`);
    if (!label) return;
    label.children[isArea ? 1 : 0].textContent = words;
  }
  const labels = [...plan.querySelectorAll("[data-label]")].map((label) => [label, [...label.children].map((text) => [text.textContent, text.getAttribute("x"), text.getAttribute("y")])]);
  const put = (text, [x, y]) => { text.setAttribute("x", x.toFixed(3)); text.setAttribute("y", (-y).toFixed(3)); };
  function labelAreas() {
    for (const { element, of, isChanged, isKnown, isMoved, area_m2: area, pieces, place } of areas.list()) {
      if (!isChanged) continue;
      if (isMoved) draw("floor", pieces.flat().map((ring) => `${trace(ring)}Z`).join(""), 0);
      const words = isKnown ? `${area.toFixed(1)} m²` : "area to be recomputed";
      if (of) {
        const text = svg("text", { "data-part-of": of }, `part: ${words}`);
        put(text, place);
        group.append(text);
        continue;
      }
      const label = plan.querySelector(`[data-label="${element}"]`);
      const [name, area_] = label.children;
      relabel(element, isKnown && area_.textContent.startsWith("about ") ? `about ${words}` : words, true);
      // the larger part keeps the label, which may have stood in the other
      if (pieces.some((piece) => shapes.has(piece, [Number(name.getAttribute("x")), -Number(name.getAttribute("y"))]))) continue;
      for (const text of label.children) put(text, place);
    }
    // what lies on floors is drawn over them
    group.append(...group.querySelectorAll(".cut, .opening, .thing, .leaf, .taped, text"));
    for (const element of areas.gone()) plan.querySelector(`[data-label="${element}"]`)?.classList.add("off");
  }
  function drawRoom(entry, element) {
    if (entry.action === "split") {
      draw("cut", trace(entry.line));
    } else if (entry.action === "merge") {
      const [room, other] = [entry.at, entry.with].map((place) => edits.nearest("room", place));
      for (const each of [room, other]) if (each) draw("joined", shape(each));
    } else if (entry.action === "remove") {
      draw("outside", shape(element));
      relabel(element, "outside", true);
    } else if (entry.name || entry.number) {
      relabel(element, entry.name ? [entry.number, entry.name].filter(Boolean).join(" ") : `Room ${entry.number}`);
    }
  }
  // what stands about, what was taped, and how leaves stand open
  function drawThing(entry, element, number) {
    if (entry.outline) draw("thing", `${trace(entry.outline)}Z`, 0, { "data-entry": number });
  }
  const drawTape = (entry, element, number) => draw("taped", trace(entry.line), 0, { "data-entry": number });
  const drawers = { furniture: drawThing, length: drawTape, wall: drawWall, opening: drawOpening, room: drawRoom };

  function redraw() {
    group.replaceChildren();
    ticks.replaceChildren();
    for (const symbol of plan.querySelectorAll("#finished .off")) symbol.classList.remove("off");
    for (const [label, texts] of labels) {
      label.classList.remove("off");
      [...label.children].forEach((text, i) => {
        text.textContent = texts[i][0];
        text.setAttribute("x", texts[i][1]);
        text.setAttribute("y", texts[i][2]);
      });
    }
    const entries = edits.entries();
    const answered = new Map();
    entries.forEach((entry, number) => {
      const element = edits.elementOf(entry);
      if (element) answered.set(element, entry);
      if (!edits.isNew(entry)) return;
      const isOfPlan = entry.action === "add" || entry.action === "split" || entry.action === "merge";
      if (element || isOfPlan) drawers[entry.element]?.(entry, element, number);
    });
    labelAreas();
    for (const mark of plan.querySelectorAll(".doubt")) {
      const entry = answered.get(mark.dataset.element);
      mark.classList.toggle("answered", entry !== undefined);
      if (!entry) continue;
      const text = mark.querySelector("text").cloneNode();
      text.textContent = entry.action === "keep" ? "✓" : entry.action === "remove" ? "✗" : "✎";
      const tick = svg("g", { class: "tick" });
      tick.append(mark.querySelector("circle").cloneNode(), text);
      ticks.append(tick);
    }
    entries.forEach((entry, number) => {
      if (!faults.of(entry)) return;
      const [x, y] = edits.spotOf(entry);
      const mark = svg("g", { class: "fault", transform: `translate(${x} ${-y})`, "data-entry": number });
      mark.append(svg("circle", {}), svg("text", { dy: ".35em" }, "!"));
      ticks.append(mark);
    });
    for (const entry of edits.gone()) {
      const [x, y] = edits.spotOf(entry);
      group.append(svg("text", { x, y: -y }, "taken back"));
    }
  }
  edits.onChange(redraw);
})();
