// what else may be said: how a door opens, what stands about, what was taped, where on Earth the plan lies, what is settled
const saying = (() => {
  const { plan, say } = planView;
  const { make, button } = choices;
  const menu = document.getElementById("draw");
  const round = (place) => place.map((m) => Number(m.toFixed(3)));
  const draw = (act, hint) => {
    plan.focus({ preventScroll: true });
    tools.begin("wall", act, hint);
  };

  // in the card of an element
  function more(element, then) {
    const [kind, number] = element.split(" ");
    if (kind === "opening" && (edits.entryOf(element)?.kind ?? edits.partOf(element).dataset.kind) === "door") {
      return [button("Opens so …", () => {
        then();
        draw((line) => edits.change(element, { swing: line[1] }), "Tap on the hinge, then where the open leaf ends");
      })];
    }
    if (kind !== "room") return [];
    const at = edits.placeOf(element);
    const settled = edits.entries().find((entry) => entry.action === "settle" && edits.nearest("room", entry.at) === `room ${number}`);
    if (settled) return [];
    return [button("Nothing more to check here", () => { edits.add({ element: "room", action: "settle", at }); then(); })];
  }

  // two taps are opposite corners, along the nearest wall
  function rectangle([a, b]) {
    const wall = edits.nearest("wall", edits.middle([a, b]), Infinity);
    const [from, to] = wall ? edits.lineOf(wall) : [[0, 0], [1, 0]];
    const length = Math.hypot(to[0] - from[0], to[1] - from[1]);
    const u = [(to[0] - from[0]) / length, (to[1] - from[1]) / length];
    const by = (b[0] - a[0]) * u[0] + (b[1] - a[1]) * u[1];
    const other = [a[0] + by * u[0], a[1] + by * u[1]];
    return [a, other, b, [a[0] + b[0] - other[0], a[1] + b[1] - other[1]]].map(round);
  }
  const area = (corners) => Math.abs(corners.reduce((sum, [x, y], i) => {
    const [nx, ny] = corners[(i + 1) % corners.length];
    return sum + x * ny - y * nx;
  }, 0)) / 2;
  function thing(kind) {
    draw((line) => {
      const outline = rectangle(line);
      if (area(outline) < 0.001) return say("That has no area: tap two opposite corners", 3);
      edits.add({ element: "furniture", action: "add", outline, kind });
    }, "Tap one corner, then the opposite one");
  }

  // a field over the plan that takes one value, in place of a dialog
  const bar = document.getElementById("moving");
  function ask(words, attributes, act) {
    const form = make("form");
    const label = make("label", words);
    const input = make("input", "", attributes);
    const close = () => { bar.hidden = true; bar.replaceChildren(); };
    label.append(input);
    form.append(label, make("button", "Done", { type: "submit" }), button("Cancel", close));
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      if (!input.value) return;
      close();
      act(input.value);
    });
    bar.replaceChildren(form);
    bar.hidden = false;
    input.focus({ preventScroll: true });
  }
  function tape() {
    draw((line) => ask("Taped length (cm)", { type: "number", min: 5, max: 100000, step: "any", inputmode: "decimal", required: "" },
      (cm) => edits.add({ element: "length", action: "add", line, length_m: Number((cm / 100).toFixed(4)) })), "Tap on one surface, then on the other");
  }

  // control points, a line each: x y east north, and "check" behind one that is only held against
  function readPoints(text, crs) {
    return text.split(/\r?\n/).filter((line) => line.trim()).map((line, i) => {
      const [, values, word] = /^([-+\d.,;\s]+?)\s*(check)?\s*$/i.exec(line) ?? [];
      const numbers = (values ?? "").split(/[\s;]+|,\s*/).filter(Boolean).map(Number);
      if (numbers.length !== 4 || numbers.some((n) => !Number.isFinite(n))) throw new Error(`line ${i + 1} has no four numbers`);
      const [x, y, east, north] = numbers;
      return { element: word ? "check_point" : "reference_point", at: [x, y], world: [east, north], crs };
    });
  }
  function points() {
    const form = make("form", "", { class: "fields" });
    const field = make("label", "Points, a line each: x y east north (metres); “check” behind one that is only compared");
    const area_ = make("textarea", "", { rows: 4, required: "", spellcheck: "false" });
    const system = make("label", "System");
    const crs = make("input", "", { type: "text", pattern: "EPSG:\\d+", placeholder: "EPSG:25832", required: "" });
    const close = () => { bar.hidden = true; bar.replaceChildren(); };
    field.append(area_);
    system.append(crs);
    form.append(field, system, make("button", "Done", { type: "submit" }), button("Cancel", close));
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      try {
        readPoints(area_.value, crs.value).forEach(edits.bring);
        close();
      } catch (error) {
        say(`Points: ${error.message}`, 4);
      }
    });
    bar.replaceChildren(form);
    bar.hidden = false;
    area_.focus({ preventScroll: true });
  }
  const kinds = { Furniture: () => thing("furniture"), Column: () => thing("column"), "Taped length": tape, "Control points": points };
  for (const [words, act] of Object.entries(kinds)) {
    menu.querySelector("[role=group]").append(button(words, () => { elements.closeCard(); menu.open = false; act(); }));
  }
  return { more, readPoints, rectangle };
})();
