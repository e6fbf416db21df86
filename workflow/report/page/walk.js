// the doubts one by one: a question, yes or no by key or thumb, and how far one is
(() => {
  const { lookAt } = planView;
  const { make, button } = choices;
  const section = document.getElementById("walk");
  if (!section) return;
  const all = [...document.querySelectorAll("#verify [data-show]")].map((item) => ({
    item, element: item.dataset.show, about: item.dataset.about,
    question: item.querySelector(".question").textContent, note: item.querySelector(".note").textContent,
    room: item.closest("ol").previousElementSibling?.textContent ?? "",
  }));
  // those of which an error costs most come first; the others where a person goes on
  const main = all.filter(({ item }) => !item.closest("details details"));
  let ask = main;
  const [question, note, answers, progress, said] = ["question", "why", "answers", "progress", "how-far"].map((id) => document.getElementById(id));
  const phone = matchMedia("(max-width: 900px)");
  let at = 0;
  let isOn = false;

  const answer = ({ element }) => edits.entryOf(element);
  const open = (from = 0) => ask.findIndex((each, i) => i >= from && !answer(each));

  // not every doubt is one of yes or no: where something ends is looked at, and moved
  const words = { end: ["✓ As it is drawn", "Elsewhere"], width: ["✓ As it is drawn", "Another width"], outline: ["✓ As it is drawn", "Not so"] };
  const isKind = ({ about, element }) => about === "kind" && edits.partOf(element).dataset.kind === "gap";

  function go(to, isLooked = true) {
    at = (to + ask.length) % ask.length;
    show();
    if (isLooked) look();
  }
  function look() {
    const [x, y] = seen.placeOf(ask[at].element) ?? edits.placeOf(ask[at].element);
    lookAt({ x, y: -y });
    elements.pick(ask[at].element);
    seen.show(ask[at].element);
  }
  function next() {
    const to = open(at + 1) >= 0 ? open(at + 1) : open();
    if (to >= 0) return go(to);
    show();
  }
  function yes() {
    edits.change(ask[at].element, { action: "keep" });
    next();
  }
  function no() {
    const { element } = ask[at];
    const list = [...choices.instead(element, next), ...choices.shape(element, () => {})];
    const box = make("div", "", { class: "acts instead", role: "group", "aria-label": "What is it instead?" });
    box.append(...list, button("Back", show, { class: "plain" }));
    answers.replaceChildren(make("p", "What is it instead?"), box, ...choices.fields(element));
    box.querySelector("button").focus({ preventScroll: true });
  }

  function show() {
    const left = ask.filter((each) => !answer(each)).length;
    const n = ask.length - left;
    progress.value = n;
    said.textContent = `${n} of ${ask.length} answered`;
    progress.max = ask.length;
    for (const { item, element } of all) item.classList.toggle("answered", edits.entryOf(element) !== undefined);
    section.classList.toggle("done", left === 0);
    if (left === 0 || !isOn) seen.hide();
    const rest = all.filter((each) => !answer(each)).length - left;
    if (left === 0 && rest && ask === main) {
      question.textContent = `All that matter most are answered. ${edits.count(rest, "more thing")} may be looked at.`;
      note.textContent = "";
      answers.replaceChildren(button("Go on with these", () => { ask = all; start(); }, { class: "main" }),
        ...(isOn ? [button("Stop", end, { class: "plain" })] : []));
      return;
    }
    if (!isOn) {
      question.textContent = left ? `${edits.count(left, "thing")} to look at, room by room.` : "All of them are answered.";
      note.textContent = "";
      answers.replaceChildren(button(n && left ? "Go on" : left ? "Start" : "Look again", start, { class: "main" }));
      return;
    }
    const each = ask[at];
    const entry = answer(each);
    question.textContent = each.question;
    note.textContent = entry ? `You said: ${choices.describe(entry)}` : each.note;
    const [yesWords, noWords] = words[each.about] ?? ["✓ Yes", "✗ No"];
    const first = isKind(each)
      ? [...choices.instead(each.element, next), button("Look later", next)]
      : [button(yesWords, yes, { class: "right", "aria-keyshortcuts": "y" }), button(noWords, no, { class: "wrong", "aria-keyshortcuts": "n" })];
    const where = make("span", `${at + 1} of ${ask.length}`, { class: "where" });
    const ways = make("div", "", { class: "ways" });
    ways.append(button("‹", () => go(at - 1), { "aria-label": "question before" }), where,
      button("›", () => go(at + 1), { "aria-label": "next question" }), button("Undo", edits.undo, { class: "plain" }), button("Stop", end, { class: "plain" }));
    const box = make("div", "", { class: "acts" });
    box.append(...first);
    answers.replaceChildren(box, ways);
  }
  function start() {
    isOn = true;
    document.body.classList.add("walking");
    dispatchEvent(new Event("resize"));
    elements.closeCard();
    go(Math.max(open(), 0));
    if (!phone.matches) document.getElementById("view").scrollIntoView({ block: "nearest" });
  }
  function end() {
    isOn = false;
    document.body.classList.remove("walking");
    dispatchEvent(new Event("resize"));
    elements.pick(null);
    show();
  }

  const keys = { y: yes, n: no, ArrowRight: () => go(at + 1), ArrowLeft: () => go(at - 1) };
  addEventListener("keydown", (event) => {
    const isTyping = event.target.closest?.("input, select, textarea, tr, #plan, #growing");
    if (!isOn || isTyping || event.ctrlKey || event.metaKey || event.altKey || tools.isBusy()) return;
    if (event.key === "Escape") return end();
    if (!(event.key in keys)) return;
    event.preventDefault();
    keys[event.key]();
  });
  edits.onChange(show);
})();
