// what may be said of an element: buttons and sizes, the same in its card and in the walk through the doubts
const choices = (() => {
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
  const kinds = { door: "a door", window: "a window", passage: "an open passage", glass: "a glass pane" };

  const roomName = (room) => document.querySelector(`#plan [data-label="${room}"] text`)?.textContent || room;

  // everything that an element may be instead of right; each is said at once
  function instead(element, then) {
    const [kind] = element.split(" ");
    const say = (text, change) => button(text, () => { edits.change(element, change); then(); });
    const remove = (text) => say(text, { action: "remove" });
    if (kind === "wall") return [remove("Nothing is there"), say("Furniture", { kind: "furniture" }), say("A column", { kind: "column" })];
    if (kind === "face") return [remove("Nothing is there")];
    if (kind === "room") return [remove("It is outside")];
    const { kind: drawn } = edits.partOf(element).dataset;
    const others = Object.entries(kinds).filter(([each]) => each !== (edits.entryOf(element)?.kind ?? drawn));
    return [...others.map(([each, words]) => say(`It is ${words}`, { kind: each })), remove("It is wall")];
  }

  // of a room also where it was tapped: a line may part it from the rest that its label lies in
  function shape(element, then, tapped) {
    const [kind] = element.split(" ");
    if (kind === "face") return [];
    if (kind !== "room") return [button("Move or resize", () => startMove(element, then))];
    const at = tapped && edits.nearest("room", tapped) === element ? tapped : edits.placeOf(element);
    const joined = (other) => edits.add({ element: "room", action: "merge", at, with: other });
    const others = [...document.querySelectorAll("#plan .room")].map((room) => room.dataset.element).filter((each) => each !== element);
    const split = button("Two rooms: draw the line", () => {
      then();
      document.getElementById("plan").focus({ preventScroll: true });
      tools.begin("split", (line) => edits.add({ element: "room", action: "split", line }), "Tap on one wall, then on the other");
    });
    const join = button("One with: tap the other", () => {
      then();
      document.getElementById("plan").focus({ preventScroll: true });
      tools.begin("place", joined, "Tap in the room, or the part of one, that it is one with");
    });
    if (!others.length) return [split, join];
    const select = make("select", "", { "aria-label": "one room with" });
    select.append(make("option", "One room with …", { value: "" }), ...others.map((room) => make("option", roomName(room), { value: room })));
    select.addEventListener("change", () => {
      if (!select.value) return;
      joined(edits.placeOf(select.value));
      then();
    });
    return [split, join, select];
  }
  function startMove(element, then) {
    then();
    const bar = document.getElementById("moving");
    const end = tools.move(element, (line) => edits.change(element, { line }));
    const close = (act) => () => { act(); bar.hidden = true; bar.replaceChildren(); };
    bar.replaceChildren(make("span", "Drag the ends or the middle"), button("Done", close(end)), button("Cancel", close(tools.stop)));
    bar.hidden = false;
  }

  // sizes in centimetres, as on a tape; a name is taken when its field is left, too
  const sizes = { wall: { thickness_m: "Thickness", height_m: "Height" }, opening: { width_m: "Width", sill_m: "Sill", lintel_m: "Top" }, room: {}, face: {} };
  const limits = { thickness_m: [1, 300], width_m: [5, 100000], sill_m: [0, 10000], lintel_m: [10, 10000], height_m: [10, 10000] };
  function fields(element) {
    const [kind] = element.split(" ");
    const entry = edits.entryOf(element) ?? {};
    const form = make("form", "", { class: "fields" });
    const take = (name, value) => value !== "" && value !== entry[name] && edits.change(element, { [name]: value });
    for (const [name, words] of Object.entries(sizes[kind])) {
      const [min, max] = limits[name];
      const label = make("label", `${words} (cm)`);
      const input = make("input", "", { type: "number", min, max, step: "any", inputmode: "decimal", name });
      input.value = entry[name] === undefined ? "" : Number((100 * entry[name]).toFixed(1));
      input.addEventListener("change", () => input.reportValidity() && input.value !== "" && take(name, Number((input.value / 100).toFixed(4))));
      label.append(input);
      form.append(label);
    }
    for (const [name, words] of kind === "room" ? [["name", "Name"], ["number", "Number"], ["use", "Used as"]] : []) {
      const label = make("label", words);
      const input = make("input", "", { type: "text", maxlength: 80, name, autocomplete: "off" });
      input.value = entry[name] ?? "";
      input.addEventListener("change", () => take(name, input.value.trim()));
      label.append(input);
      form.append(label);
    }
    // a form of several fields is not sent by Enter
    form.addEventListener("keydown", (event) => event.key === "Enter" && event.target.blur());
    form.addEventListener("submit", (event) => event.preventDefault());
    return form.children.length ? [form] : [];
  }
  const right = (element, then, words = "✓ Right as it is") =>
    button(words, () => { edits.change(element, { action: "keep" }); then(); }, { class: "right" });

  const nouns = { keep: "is right", remove: "is not there", settle: "needs no more checks" };
  const gone = { opening: "is wall", room: "is outside" };
  function describe(entry) {
    const { element, action, kind, line, thickness_m, width_m, sill_m, lintel_m, height_m, name, number, use } = entry;
    if (element.endsWith("_point")) return element.replace("_", " ");
    const where = edits.elementOf(entry) ?? element;
    const words = where.startsWith("room ") ? roomName(where) : where;
    if (element === "length") return `Taped ${entry.length_m.toFixed(3)} m`;
    if (action === "settle") return `${edits.nearest("room", entry.at) ? roomName(edits.nearest("room", entry.at)) : "A room"} ${nouns.settle}`;
    const room = (place) => edits.nearest("room", place);
    const named = (place) => (room(place) ? roomName(room(place)) : "a room");
    if (action === "add") {
      const size = line && ` of ${Math.hypot(line[1][0] - line[0][0], line[1][1] - line[0][1]).toFixed(2)} m`;
      const at = room(edits.spotOf(entry));
      return [`New ${kind ?? element}`, size, at && ` in ${roomName(at)}`].filter(Boolean).join("");
    }
    if (action === "merge" && room(entry.at) && room(entry.at) === room(entry.with)) return `Parts of ${named(entry.at)} are one`;
    if (action === "merge") return `${named(entry.at)} and ${named(entry.with)} are one`;
    if (action === "split") return `${named(edits.middle(line))} is two rooms`;
    const cm = (text, m) => m !== undefined && `${text} ${Number((100 * m).toFixed(1))} cm`;
    const parts = [(action === "remove" && gone[element]) || nouns[action], kind && `is ${kinds[kind] ?? (kind === "column" ? "a column" : kind)}`, line && !action && "moved", cm("thickness", thickness_m),
      cm("width", width_m), cm("sill", sill_m), cm("top", lintel_m), cm("height", height_m), entry.swing && "opens as shown", use && `is used as ${use}`, name && `is ${name}`, number && `has number ${number}`];
    const said = parts.filter(Boolean).join(", ");
    const subject = name || number ? where : words;
    return `${subject[0].toUpperCase()}${subject.slice(1)} ${said}`;
  }
  return { make, button, instead, shape, fields, right, roomName, describe };
})();
