// the parts of the plan: a card beside the click, rows of the tables, measuring tape, corrections
(() => {
  const { data, plan, view, metres, lookAt, say, follow } = planView;
  const card = document.getElementById("card");
  const make = (tag, text = "", attributes = {}) => {
    const element = document.createElement(tag);
    element.textContent = text;
    for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
    return element;
  };
  const button = (text, act, attributes = {}) => {
    const made = make("button", text, { type: "button", ...attributes });
    made.addEventListener("click", act);
    return made;
  };
  const partOf = (element) => plan.querySelector(`.pick[data-element="${element}"], .room[data-element="${element}"]`);
  const rowOf = (element) => document.querySelector(`tr[data-element="${element}"]`);

  // where an element is: the middle of its line, or the place of a room's label
  function placeOf(element) {
    const part = partOf(element);
    if (part.dataset.x !== undefined) return { x: Number(part.dataset.x), y: Number(part.dataset.y) };
    const { x, y } = part.getPointAtLength(part.getTotalLength() / 2);
    return { x, y };
  }

  // --- the card beside the click ---
  let cardPlace = null;
  function placeCard() {
    if (card.hidden) return;
    const matrix = plan.getScreenCTM();
    const at = new DOMPoint(cardPlace.x, cardPlace.y).matrixTransform(matrix);
    const frame = view.getBoundingClientRect();
    const left = at.x - frame.x + 14;
    const top = at.y - frame.y - card.offsetHeight / 2;
    const isRoomRight = left + card.offsetWidth < frame.width - 8;
    card.style.left = `${Math.max(8, isRoomRight ? left : left - card.offsetWidth - 28)}px`;
    card.style.top = `${Math.max(8, Math.min(top, frame.height - card.offsetHeight - 8))}px`;
  }
  follow(placeCard);

  function openCard(place, ...content) {
    card.replaceChildren(button("×", closeCard, { class: "close", "aria-label": "close" }), ...content);
    card.hidden = false;
    cardPlace = place;
    placeCard();
  }
  function closeCard() {
    card.hidden = true;
    pick(null);
  }
  addEventListener("keydown", (event) => {
    if (event.key !== "Escape") return;
    closeCard();
    stopMeasuring();
  });

  function pick(element) {
    for (const part of document.querySelectorAll("[data-element]")) {
      part.classList.toggle("picked", part.dataset.element === element);
    }
  }

  function showElement(element, place = placeOf(element)) {
    pick(element);
    const row = rowOf(element);
    const heads = [...row.closest("table").tHead.rows[0].cells].map((head) => head.textContent);
    const facts = make("dl");
    const flags = [];
    [...row.cells].forEach((cell, i) => {
      if (i === 0 || cell.textContent === "") return;
      if (cell.classList.contains("flag")) flags.push(make("p", `To verify: ${cell.textContent}`, { class: "flag" }));
      else facts.append(make("dt", heads[i]), make("dd", cell.textContent));
    });
    const [kind, number] = element.split(" ");
    const title = make("h3", `${kind[0].toUpperCase()}${kind.slice(1)} ${number}`);
    const toTable = button("show in the table", () => row.scrollIntoView({ block: "center" }));
    const acts = make("div", "", { class: "acts" });
    acts.append(...choices(element), toTable);
    openCard(place, title, ...flags, facts, ...(kind === "room" ? [nameField(element)] : []), acts);
  }

  plan.addEventListener("click", (event) => {
    if (measuring) return;
    const part = event.target.closest("[data-element]");
    if (part) showElement(part.dataset.element, metres(event));
    else closeCard();
  });
  for (const shown of document.querySelectorAll("[data-show]")) {
    shown.addEventListener("click", () => {
      lookAt(placeOf(shown.dataset.show));
      showElement(shown.dataset.show);
      view.scrollIntoView({ block: "nearest" });
    });
  }
  for (const row of document.querySelectorAll("tr[data-element]")) {
    const chosen = () => {
      showElement(row.dataset.element);
      view.scrollIntoView({ block: "nearest" });
    };
    const next = { ArrowDown: "nextElementSibling", ArrowUp: "previousElementSibling" };
    row.addEventListener("click", chosen);
    row.addEventListener("keydown", (event) => {
      if (event.key === "Enter") chosen();
      const other = row[next[event.key]];
      if (!other) return;
      event.preventDefault();
      row.tabIndex = -1;
      other.tabIndex = 0;
      other.focus();
    });
  }

  // --- measuring tape ---
  const tape = document.getElementById("tape");
  const measure = document.getElementById("measure");
  const draw = (tag, attributes) => {
    const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
    for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
    return element;
  };
  let measuring = false;
  let from = null;
  function stopMeasuring() {
    measuring = false;
    from = null;
    tape.replaceChildren();
    plan.classList.remove("measuring");
    measure.setAttribute("aria-pressed", "false");
    say("", 0);
  }
  function stretch(to) {
    const length = Math.hypot(to.x - from.x, to.y - from.y);
    const text = draw("text", { x: (from.x + to.x) / 2, y: (from.y + to.y) / 2, dy: "-.5em" });
    text.textContent = `${length.toFixed(2)} m`;
    tape.replaceChildren(draw("path", { d: `M${from.x} ${from.y}L${to.x} ${to.y}` }), text);
  }
  measure.addEventListener("click", () => {
    if (measuring) return stopMeasuring();
    closeCard();
    measuring = true;
    plan.classList.add("measuring");
    measure.setAttribute("aria-pressed", "true");
    say("Click where to measure from, then where to; Escape ends", 0);
  });
  plan.addEventListener("pointermove", (event) => measuring && from && stretch(metres(event)));
  plan.addEventListener("click", (event) => {
    if (!measuring) return;
    const here = metres(event);
    if (from === null) {
      from = here;
      stretch(here);
      return;
    }
    stretch(here);
    const line = [from, here];
    from = null;
    const acts = make("div", "", { class: "acts" });
    const kinds = ["wall", "door", "window", "passage"];
    acts.append(...kinds.map((kind) => button(`add ${kind} here`, () => addLine(kind, line))));
    openCard(here, make("h3", tape.textContent), acts);
  });

  // --- corrections: what corrections.yaml will say ---
  const section = document.getElementById("corrections");
  const entries = [...data.corrections];
  const rounded = ({ x, y }) => [Number(x.toFixed(3)), Number((-y).toFixed(3))];
  const samePlace = (one, other) => String(one.at ?? one.line) === String(other.at ?? other.line);

  function choices(element) {
    const [kind] = element.split(" ");
    const act = (text, change) =>
      button(text, () => correct({ element: kind, at: rounded(placeOf(element)), ...change }));
    if (kind === "room" || kind === "face") return [];
    const kinds = kind === "opening" ? ["door", "window", "passage"] : [];
    return [
      ...kinds.map((each) => act(`is a ${each}`, { kind: each })),
      act("keep", { action: "keep" }),
      act("remove", { action: "remove" }),
    ];
  }
  function nameField(element) {
    const form = make("form");
    const name = make("input", "", { placeholder: "Name of the room", "aria-label": "name of the room", maxlength: 80 });
    form.append(name);
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      if (name.value.trim()) correct({ element: "room", at: rounded(placeOf(element)), name: name.value.trim() });
    });
    return form;
  }
  function addLine(kind, line) {
    const made = { action: "add", line: line.map(rounded) };
    correct(kind === "wall" ? { element: "wall", ...made } : { element: "opening", ...made, kind });
    stopMeasuring();
  }
  function correct(entry) {
    const old = entries.findIndex((other) => other.element === entry.element && samePlace(other, entry));
    if (old >= 0) entries.splice(old, 1);
    entries.push(entry);
    closeCard();
    listEntries();
  }
  function listEntries() {
    section.hidden = entries.length === 0;
    const said = ({ element, action, kind, name, at, line }) =>
      [element, name ? `is ${name}` : kind && !action ? `is a ${kind}` : `${action} ${kind ?? ""}`, `at ${at ?? line[0]}`].join(" ");
    section.querySelector("ol").replaceChildren(...entries.map((entry, i) => {
      const item = make("li", said(entry));
      item.append(button("×", () => { entries.splice(i, 1); listEntries(); }, { "aria-label": "take back" }));
      return item;
    }));
  }
  document.getElementById("download").addEventListener("click", () => {
    const lines = entries.map((entry) => `- ${JSON.stringify(entry)}\n`);
    const file = new Blob([`corrections:\n${lines.join("")}`], { type: "application/yaml" });
    const link = make("a", "", { href: URL.createObjectURL(file), download: "corrections.yaml" });
    link.click();
    URL.revokeObjectURL(link.href);
  });
  listEntries();
})();
