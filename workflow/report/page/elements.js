// the parts of the plan: a card beside the click, rows of the tables, measuring tape, what is drawn
const elements = (() => {
  const { plan, view, metres, lookAt, follow } = planView;
  const card = document.getElementById("card");
  const { make, button } = choices;
  const rowOf = (element) => document.querySelector(`tr[data-element="${element}"]`);
  const spot = ([x, y]) => ({ x, y: -y });
  const placeOf = (element) => spot(edits.placeOf(element));

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
    tools.stop();
    measure.setAttribute("aria-pressed", "false");
    document.getElementById("moving").hidden = true;
  });

  function pick(element) {
    for (const part of document.querySelectorAll("[data-element], [data-entry]")) {
      part.classList.toggle("picked", (part.dataset.element ?? `entry ${part.dataset.entry}`) === element);
    }
    dispatchEvent(new CustomEvent("picked", { detail: element }));
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
    const title = make("h2", `${kind[0].toUpperCase()}${kind.slice(1)} ${number}`);
    const entry = edits.entryOf(element);
    const state = entry && edits.isNew(entry) ? [make("p", `You said: ${choices.describe(entry)}`, { class: "said" })] : [];
    state.push(...areas.describe(element).map((line) => make("p", line, { class: "said" })));
    const acts = make("div", "", { class: "acts" });
    acts.append(choices.right(element, closeCard), ...choices.instead(element, closeCard), ...choices.shape(element, closeCard, edits.place(place)), ...saying.more(element, closeCard));
    const toTable = button("show in the table", () => row.scrollIntoView({ block: "center" }), { class: "plain" });
    openCard(place, title, ...flags, ...state, acts, ...choices.fields(element), facts, toTable);
  }
  function showEntry(number, place) {
    const entry = edits.entries()[number];
    pick(`entry ${number}`);
    const acts = make("div", "", { class: "acts" });
    acts.append(button("Take it back", () => { edits.takeBack(entry); closeCard(); }));
    openCard(place, make("h2", choices.describe(entry)), acts);
  }

  plan.addEventListener("click", (event) => {
    const added = event.target.closest("[data-entry]");
    if (added) return showEntry(Number(added.dataset.entry), metres(event));
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

  // --- measuring tape, and what is drawn ---
  const measure = document.getElementById("measure");
  async function added(kind, line) {
    if (kind !== "wall") return edits.add({ element: "opening", action: "add", line, kind });
    const entry = { element: "wall", action: "add", line };
    const settled = returns.settle(line); // among the walls without it
    edits.add(entry);
    const found = await settled;
    if (found && edits.refine(entry, { line: found.line })) planView.say(found.said, 5);
  }
  measure.addEventListener("click", () => {
    closeCard();
    const isOn = measure.getAttribute("aria-pressed") === "true";
    measure.setAttribute("aria-pressed", String(!isOn));
    if (isOn) return tools.stop();
    tools.begin("tape", (line) => {
      measure.setAttribute("aria-pressed", "false");
      tools.stretch(line);
    }, "Tap where to measure from, then where to");
  });
  const menu = document.getElementById("draw");
  for (const drawn of menu.querySelectorAll("button")) {
    drawn.addEventListener("click", () => {
      const { kind } = drawn.dataset;
      closeCard();
      menu.open = false;
      if (kind === "wall") returns.read();
      plan.focus({ preventScroll: true });
      tools.begin(kind === "wall" ? "wall" : "opening", (line) => added(kind, line), "Tap where it begins, then where it ends");
    });
  }
  addEventListener("click", (event) => {
    for (const open of document.querySelectorAll("#bar details[open]")) open.open = open.contains(event.target);
  });
  return { showElement, showEntry, closeCard, pick };
})();
